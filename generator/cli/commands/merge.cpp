// SPDX-License-Identifier: GPL-3.0-or-later
// Command merge: joins the tables of the shards of a sweep. The result is identical to the table of a single call.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <eom/output/atomic_file.hpp>
#include <map>
#include <optional>
#include <system_error>

#include "cli/commands/commands.hpp"
#include "cli/output.hpp"
#include "cli/sweep/npz.hpp"
#include "cli/sweep/points.hpp"
#include "cli/sweep/rows.hpp"
#include "cli/sweep/statistics.hpp"
#include "emit/write_files.hpp"
#include "model/names.hpp"

namespace eomgen::cli::merge_command {
namespace {

struct Options {
  std::vector<std::string> tables;
  std::string out;
  bool statistics = false;
};

[[noreturn]] void fail(const std::string& what, const std::string& remedy) { throw Error("merge", {}, what, remedy); }

/// Copies a pipe to a temporary file, because rows are read again in another order.
OpenFile readable(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  struct stat found {};
  if (descriptor < 0 || ::fstat(descriptor, &found) != 0 || S_ISDIR(found.st_mode)) {
    if (descriptor >= 0) ::close(descriptor);
    fail(fmt::format("cannot read {}", model::quote(path)), "name the tables that sweep --shard wrote");
  }
  OpenFile file(descriptor);
  if (S_ISREG(found.st_mode)) return file;
  OpenFile copy = OpenFile::temporary();
  std::string text(1 << 18, '\0');
  for (ssize_t n; (n = ::read(file.descriptor(), text.data(), text.size())) != 0;) {
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      fail(fmt::format("cannot read {}: {}", model::quote(path), std::strerror(errno)),
           "name the tables that sweep --shard wrote");
    copy.write(std::string_view(text).substr(0, static_cast<std::size_t>(n)));
  }
  return copy;
}

class Tables {
 public:
  void add(const std::string& path) {
    const OpenFile file = readable(path);
    const std::uint32_t number = rows_.add(file);
    std::optional<ShardHeader> note;
    std::size_t lines = 0;
    const std::size_t tail = for_each_line(file, [&](std::string_view line, std::uint64_t offset) {
      if (++lines == 1) {
        note = begun(path, std::string(line));
      } else if (lines == 2) {
        if (header_.empty()) header_ = line;
        checksum_ = RowChecksum(header_);
        if (line != header_) fail(fmt::format("{} has other columns", model::quote(path)), "make that shard again");
      } else {
        take(path, line, note->shard, number, offset);
      }
      return true;
    });
    if (!note) begun(path, "");
    if (tail > 0) cut_ = path;
  }

  void write(const std::string& out) {
    if (is_npz(out)) return write_npz(out, note_.key, header_, rows_);
    eom::AtomicFile file = is_standard_output(out) ? eom::AtomicFile::standard_output() : eom::AtomicFile(out);
    try {
      constexpr std::size_t enough = 1 << 20;
      std::string text = note_.key + "\n" + header_ + "\n";
      rows_.for_each(0, rows_.size(), [&](std::size_t, std::string_view line) {
        text.append(line);
        text += '\n';
        if (text.size() < enough) return;
        file.write(text);
        text.clear();
      });
      file.write(text);
      file.finish();
    } catch (const std::system_error&) {
      file.discard();  // the file can be generated again, so no part is kept
      throw;
    }
  }
  /// Requires every run of every shard exactly once.
  void require_all() {
    for (std::size_t shard = 1; shard <= note_.shard.count; ++shard) {
      if (!tables_.contains(shard))
        fail(fmt::format("shard {}/{} is missing", shard, note_.shard.count), "name the tables of all shards");
    }
    const std::size_t lines = rows_.size();
    rows_.sort();
    if (rows_.size() < lines)
      fail(fmt::format("{} lines are of runs that another line has", lines - rows_.size()),
           "make the shards again in which a run comes twice");
    if (rows_.size() == note_.runs && !cut_.empty())
      fail(fmt::format("{} ends within a line", model::quote(cut_)), "make that shard again");
    if (rows_.size() == note_.runs) return;
    std::size_t run = 0;
    while (run < rows_.size() && rows_.run(run) == run) ++run;
    fail(fmt::format("run {} is missing, and {} of {} in all", run, note_.runs - rows_.size(), note_.runs),
         fmt::format("sweep --shard {}/{} goes on where it was interrupted", run % note_.shard.count + 1,
                     note_.shard.count));
  }

  std::size_t runs() const { return rows_.size(); }
  std::size_t shards() const { return tables_.size(); }
  std::vector<analysis::ColumnStatistics> statistics() const {
    return statistics_of_table(header_, rows_.size(), [this](const auto& take) {
      rows_.for_each(0, rows_.size(), [&take](std::size_t, std::string_view line) { take(line); });
    });
  }

 private:
  ShardHeader begun(const std::string& path, const std::string& line) {
    const std::optional<ShardHeader> note = parse_shard_header(line);
    if (!note)
      fail(fmt::format("{} is not the table of a shard", model::quote(path)),
           "name the tables that sweep --shard wrote");
    if (tables_.empty()) note_ = *note;
    if (note->key != note_.key || note->shard.count != note_.shard.count || note->runs != note_.runs) {
      fail(fmt::format("{} and {} are of different sweeps", model::quote(tables_.begin()->second), model::quote(path)),
           "merge the shards of one sweep: the same model, options and number of shards");
    }
    const auto [place, fresh] = tables_.emplace(note->shard.number, path);
    if (!fresh)
      fail(fmt::format("{} and {} are the same shard", model::quote(place->second), model::quote(path)),
           "name each shard once");
    return *note;
  }
  void take(const std::string& path, std::string_view line, const analysis::Shard& shard, std::uint32_t file,
            std::uint64_t offset) {
    std::size_t run = 0;
    if (!is_row_of_table(line, checksum_, run) || run >= note_.runs || !shard.contains(run)) {
      fail(fmt::format("{} has a line that is no run of that shard, or was changed: {}", model::quote(path),
                       model::quote(std::string(line.substr(0, 60)))),
           "make that shard again");
    }
    rows_.add(run, file, offset, line.size());
  }

  ShardHeader note_;
  std::string header_, cut_;  // cut_: a table that ends within a line
  RowChecksum checksum_;
  std::map<std::size_t, std::string> tables_;
  Rows rows_;
};

int execute(const Options& options, const CommonOptions& common) {
  require_writable_targets({{"--out", options.out, is_npz(options.out) ? ".npz" : ".csv"}}, "", common.json);
  Tables tables;
  try {
    for (const std::string& path : options.tables) tables.add(path);
    tables.require_all();
    tables.write(options.out);
  } catch (const std::system_error& error) {
    throw Error("merge", {}, error.what(), "see to space on that disk and to your rights there",
                emit::write_fault(error.code()));
  }
  if (common.json) {
    Json found{{"format", 1}, {"shards", tables.shards()}, {"runs", tables.runs()}, {"file", options.out}};
    if (options.statistics) found["statistics"] = to_json(tables.statistics());
    print_document(found);
  } else {
    std::string text = fmt::format("shards {}\nruns   {}\nwrote  {}\n", tables.shards(), tables.runs(), options.out);
    if (options.statistics) text += "\n" + to_text(tables.statistics());
    print_readable(text, is_standard_output(options.out));
  }
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("TABLES", options->tables, "what sweep --shard wrote, every shard of one sweep").required();
  app.add_output_path("-o,--out", options->out, "the whole table: F.csv, or F.npz for arrays of columns").required();
  app.add_flag("--statistics", options->statistics, "mean, deviation, extremes and quantiles of every column");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::merge_command
