// The CSV file appears complete, with its outcome, or not at all. Its numbers are read back to the same bits.
#include "eom/output/csv.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "eom/output/atomic_file.hpp"

namespace {

namespace fs = std::filesystem;

/// A temporary folder of one test case.
struct Folder {
  fs::path path;
  explicit Folder(const char* name) : path(fs::temp_directory_path() / ("eomgen_csv_test_" + std::string(name))) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const std::vector<std::string> columns{"theta", "theta_dot"};

}  // namespace

TEST_CASE("csv: t first, 17 significant digits, a trailing line with the outcome, no .partial file left") {
  const Folder folder("whole");
  const fs::path path = folder.path / "run.csv";
  eom::CsvWriter csv(path, columns);
  csv.row(0, std::vector<double>{0.1, -2});
  csv.row(0.5, std::vector<double>{1e-300, std::numeric_limits<double>::infinity()});
  CHECK(!fs::exists(path));
  csv.finish(eom::Outcome::done);
  CHECK(text_of(path) == "t,theta,theta_dot\n0,0.10000000000000001,-2\n0.5,1e-300,inf\n# outcome: done\n");
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("csv: every number is read back to the same bits, except the sign of 0") {
  const Folder folder("bits");
  const std::vector<double> values{1.0 / 3, std::numeric_limits<double>::denorm_min(), -1.7976931348623157e308,
                                   123456789.123456789, -0.0};
  eom::CsvWriter csv(folder.path / "run.csv", std::vector<std::string>{"a", "b", "c", "d", "e"});
  csv.row(0.1, values);
  csv.finish(eom::Outcome::done);
  CHECK(text_of(folder.path / "run.csv").find(",-0") == std::string::npos);  // a result of 0 has no sign
  std::istringstream lines(text_of(folder.path / "run.csv"));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  const char* at = line.c_str();
  char* end = nullptr;
  CHECK(std::strtod(at, &end) == 0.1);
  for (const double value : values) {
    at = end + 1;
    CHECK(std::strtod(at, &end) == value);
  }
}

TEST_CASE("csv: an interrupted run keeps its lines and records the interruption") {
  const Folder folder("interrupted");
  const fs::path path = folder.path / "run.csv";
  eom::CsvWriter csv(path, columns);
  csv.row(0, std::vector<double>{1, 2});
  csv.finish(eom::Outcome::interrupted);
  CHECK(text_of(path) == "t,theta,theta_dot\n0,1,2\n# outcome: interrupted\n");
}

TEST_CASE("csv: without finish the .partial file remains with whole lines, and an older file is unchanged") {
  const Folder folder("partial");
  const fs::path path = folder.path / "run.csv";
  std::ofstream(path) << "older\n";
  std::string partial_path;
  {
    eom::CsvWriter csv(path, columns);
    for (int k = 0; k < 10000; ++k) csv.row(k, std::vector<double>{0.1 * k, 0.2});
    partial_path = csv.partial();
    CHECK(partial_path.starts_with(path.string() + ".partial-"));
    const std::string so_far = text_of(partial_path);
    CHECK(so_far.size() > 100000);  // written during the run, not kept until the end
    CHECK(so_far.back() == '\n');
  }
  CHECK(text_of(path) == "older\n");
  const std::string partial = text_of(partial_path);
  CHECK(partial.ends_with(",0.20000000000000001\n"));
  CHECK(std::count(partial.begin(), partial.end(), '\n') == 10001);
}

TEST_CASE("csv: names with commas and quotes are quoted as in RFC 4180") {
  const Folder folder("names");
  eom::CsvWriter csv(folder.path / "run.csv", std::vector<std::string>{"a,b", "say \"q\"", "plain"});
  csv.finish(eom::Outcome::done);
  CHECK(text_of(folder.path / "run.csv") == "t,\"a,b\",\"say \"\"q\"\"\",plain\n# outcome: done\n");
}

TEST_CASE("csv: errors of the file system are thrown with the path") {
  const Folder folder("errors");
  const auto message = [](auto action) {
    try {
      action();
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const fs::path nowhere = folder.path / "no_such_folder" / "run.csv";
  CHECK(message([&] { eom::CsvWriter(nowhere, columns); }).find("no_such_folder") != std::string::npos);

  const fs::path folder_there = folder.path / "folder.csv";
  fs::create_directories(folder_there);
  CHECK(message([&] { eom::CsvWriter(folder_there, columns); }).find("folder.csv") != std::string::npos);
  const fs::path blocked = folder.path / "blocked.csv";  // a folder of that name prevents the rename
  eom::CsvWriter csv(blocked, columns);
  fs::create_directories(blocked / "inside");
  CHECK(message([&] { csv.finish(eom::Outcome::done); }).find("blocked.csv") != std::string::npos);
  CHECK(fs::exists(csv.partial()));

  if (fs::exists("/dev/full")) {  // a device that is always full, through a link
    fs::create_symlink("/dev/full", folder.path / "full.csv");
    CHECK(message([&] { eom::CsvWriter(folder.path / "full.csv", columns); }).find("full.csv") != std::string::npos);
    CHECK(fs::is_symlink(folder.path / "full.csv"));
  }
}

TEST_CASE("csv: two writers to one file do not share a partial file, and do not follow planted links") {
  const Folder folder("two");
  const fs::path path = folder.path / "run.csv";
  std::ofstream(folder.path / "victim") << "mine\n";
  fs::create_symlink("victim", folder.path / "run.csv.partial");
  eom::CsvWriter first(path, columns), second(path, columns);
  CHECK(first.partial() != second.partial());
  first.row(0, std::vector<double>{1, 1});
  second.row(0, std::vector<double>{2, 2});
  first.finish(eom::Outcome::done);
  CHECK(text_of(path) == "t,theta,theta_dot\n0,1,1\n# outcome: done\n");
  second.finish(eom::Outcome::done);
  CHECK(text_of(path) == "t,theta,theta_dot\n0,2,2\n# outcome: done\n");
  CHECK(text_of(folder.path / "victim") == "mine\n");
}

TEST_CASE("atomic file: links are followed, pipes and devices are written to directly, and file modes are kept") {
  const Folder folder("kinds");
  fs::create_directories(folder.path / "elsewhere");
  const fs::path target = folder.path / "elsewhere" / "run.csv", link = folder.path / "run.csv";
  std::ofstream(target) << "older\n";
  fs::permissions(target, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(fs::path("elsewhere") / "run.csv", link);
  eom::AtomicFile file(link);
  CHECK(file.partial().starts_with(target.string() + ".partial-"));
  file.write("new\n");
  CHECK(text_of(target) == "older\n");
  file.finish();
  CHECK(text_of(target) == "new\n");
  CHECK(fs::is_symlink(link));
  CHECK(fs::status(target).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  // A link to a file that does not exist yet.
  fs::create_symlink(fs::path("elsewhere") / "later.csv", folder.path / "later");
  eom::AtomicFile later(folder.path / "later");
  later.write("x");
  later.finish();
  CHECK(text_of(folder.path / "elsewhere" / "later.csv") == "x");
  fs::create_symlink("circle", folder.path / "circle");
  CHECK_THROWS_AS(eom::AtomicFile(folder.path / "circle"), std::system_error);
  // A device is not replaced.
  eom::AtomicFile null("/dev/null");
  CHECK(null.partial().empty());
  null.write("away");
  null.finish();
  CHECK(fs::is_character_file("/dev/null"));
  // The longest possible file name leaves room for the partial name.
  eom::AtomicFile longest(folder.path / std::string(255, 'n'));
  longest.write("x");
  longest.finish();
  CHECK(text_of(folder.path / std::string(255, 'n')) == "x");
  eom::AtomicFile gone(folder.path / "gone");
  gone.discard();
  CHECK_FALSE(fs::exists(folder.path / "gone"));
}

TEST_CASE("csv: a row of the wrong length, and one after finish, are refused") {
  const Folder folder("refused");
  eom::CsvWriter csv(folder.path / "run.csv", columns);
  CHECK_THROWS_AS(csv.row(0, std::vector<double>{1}), std::invalid_argument);
  csv.finish(eom::Outcome::done);
  CHECK_THROWS_AS(csv.flush(), std::logic_error);
}
