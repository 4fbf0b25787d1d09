// SPDX-License-Identifier: GPL-3.0-or-later
// Sweeps as .npz archives: read by Python's zipfile, and by numpy if installed. Skipped without Python.
#include <doctest/doctest.h>

#include <filesystem>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Script: compares every array of argv[1] with the table argv[2]; prints "same" and the names of the arrays.
const char* const comparison = R"(
import ast, csv, io, math, struct, sys, zipfile
archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None
arrays = {}
for member in archive.infolist():
    assert member.compress_type == zipfile.ZIP_STORED and member.filename.endswith('.npy')
    data = archive.read(member)
    assert data[:8] == b'\x93NUMPY\x01\x00'
    length = struct.unpack('<H', data[8:10])[0]
    assert (10 + length) % 64 == 0 and data[9 + length:10 + length] == b'\n'
    header = ast.literal_eval(data[10:10 + length].decode())
    assert header['fortran_order'] is False
    count = math.prod(header['shape'])
    body, kind = data[10 + length:], header['descr']
    if kind in ('<f8', '<i8'):
        values = list(struct.unpack('<%d%s' % (count, 'd' if kind == '<f8' else 'q'), body))
    else:
        assert kind[:2] == '|S'
        width = int(kind[2:])
        assert len(body) == width * count
        values = [body[width * i:width * (i + 1)].rstrip(b'\0').decode() for i in range(count)]
    arrays[member.filename[:-4]] = values
lines = open(sys.argv[2], newline='').read().split('\n')
rows = list(csv.reader(lines[1:-1]))
names, rows = rows[0][:-1], [row[:-1] for row in rows[1:]]
assert arrays['sweep'] == [lines[0]]
def same(a, text):
    return math.isnan(a) if text in ('', 'nan') else a == float(text)
for k, name in enumerate(names[:-1]):
    if name == 'outcome': assert arrays[name] == [row[k] for row in rows]
    elif name == 'run': assert arrays[name] == [int(row[k]) for row in rows]
    else: assert all(same(a, row[k]) for a, row in zip(arrays[name], rows)) and len(arrays[name]) == len(rows), name
assert dict(zip(arrays['detail_run'], arrays['detail'])) == {int(row[0]): row[-1] for row in rows if row[-1]}
assert sorted(arrays) == sorted(names[:-1] + ['sweep', 'detail', 'detail_run'])
try:
    import numpy
    loaded = numpy.load(sys.argv[1])
    for name in arrays: assert [str(v) for v in arrays[name]] == [v.decode() if isinstance(v, bytes) else str(v) for v in loaded[name].ravel().tolist()], name
except ImportError:
    pass
print('same', len(rows))
)";

std::string compared(const Folder& folder, const std::string& archive, const std::string& table) {
  const ChildResult result = run_child({{"python3", "-c", comparison, archive, table}, folder.path()});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  return result.out;
}

}  // namespace

TEST_CASE("sweep: an archive has the numbers, outcomes and details of the table") {
  const Folder folder;
  if (run_child({{"python3", "-c", "import zipfile"}, folder.path()}).status != 0) {
    MESSAGE("there is no python3: archives of columns are not read");
    return;
  }
  folder.write("oscillator.toml", oscillator_text());
  // More rows than are written at a time. Some runs are refused, with quotation marks or commas in the detail.
  const Words words{"sweep", "oscillator.toml", "--grid",  "m=1,-1", "--sample", "k=1:9", "--samples",
                    "2500",  "--ensemble",      "--t-end", "0.1",    "--output", "all",   "--out"};
  for (const char* name : {"all.csv", "all.npz"}) expect(3, folder, with(words, {name}));
  CHECK(compared(folder, "all.npz", "all.csv") == "same 5000\n");
  const std::string bytes = folder.read("all.npz");
  expect(3, folder, with(words, {"all.npz"}));
  CHECK(folder.read("all.npz") == bytes);
  // From shards, with one row, and without any successful row.
  const Words sweep{"sweep", "oscillator.toml", "--grid", "k=1:9:5"};
  expect(0, folder, with(sweep, {"--out", "whole.csv"}));
  for (const char* i : {"1", "2"})
    expect(0, folder, with(sweep, {"--out", std::string(i) + ".csv", "--shard", std::string(i) + "/2"}));
  expect(0, folder, {"merge", "1.csv", "2.csv", "--out", "merged.npz"});
  CHECK(compared(folder, "merged.npz", "whole.csv") == "same 5\n");
  const Words one{"sweep", "oscillator.toml", "--grid", "k=1"};
  for (const char* name : {"one.csv", "one.npz"}) expect(0, folder, with(one, {"--out", name}));
  CHECK(compared(folder, "one.npz", "one.csv") == "same 1\n");
  // Rows of a killed call are taken over.
  std::string part = folder.read("all.csv");
  part.resize(part.size() / 2);
  std::filesystem::remove(folder / "all.npz");
  folder.write("all.npz.partial", part);
  CHECK(document(folder, with(words, {"all.npz"}), 3)["resumed"].get<int>() > 1000);
  CHECK(folder.read("all.npz") == bytes);
  CHECK_FALSE(folder.has("all.npz.partial"));
}

TEST_CASE("sweep: an archive that cannot be written is reported") {
  const Folder folder;
  folder.write("oscillator.toml", oscillator_text());
  const Words words{"sweep", "oscillator.toml", "--grid", "k=1,2", "--out", "a.npz"};
  CHECK(contains(expect(2, folder, with(words, {"--shard", "1/2"})).err, "eomgen merge TABLES -o a.npz"));
  CHECK(contains(expect(2, folder, {"run", "oscillator.toml", "--out", "a.npz"}).err, "this option writes csv"));
  CHECK(folder.names() == Words{"oscillator.toml"});
}
