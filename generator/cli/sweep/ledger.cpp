// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/ledger.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <string_view>
#include <system_error>

#include "cli/output.hpp"
#include "emit/write_files.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* mark = "# sweep: ";

[[noreturn]] void lost(const std::system_error& error) {
  throw Error("sweep", {}, error.what(), "see to space on that disk and to your rights there; the same command goes on from what is there",
              emit::fault_of_writing(error.code()));
}

/// A file that may be read and taken over: regular, one's own, no link, and nobody is writing to it. -1 else.
int open_own(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return -1;
  struct stat found {};
  if (::fstat(file, &found) == 0 && S_ISREG(found.st_mode) && found.st_uid == ::geteuid() && ::flock(file, LOCK_SH | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

/// Whole lines only, as long as `take` wants them: the last may have been cut off. False where the file is not to be read.
bool each_line(const std::string& path, const std::function<bool(const std::string& line)>& take) {
  const int file = open_own(path);
  if (file < 0) return false;
  std::string text;
  std::vector<char> buffer(1 << 18);
  bool more = true;
  for (ssize_t n; more && (n = ::read(file, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(n));
    std::size_t begin = 0;
    for (std::size_t end; more && (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) more = take(text.substr(begin, end - begin));
    text.erase(0, begin);
  }
  ::close(file);
  return true;
}

}  // namespace

Ledger::Ledger(std::string file, std::string key) : file_(std::move(file)), place_(file_), key_(std::move(key)) {
  std::error_code none;
  kept_ = !is_standard_output(file_) && (!fs::exists(file_, none) || fs::is_regular_file(file_, none));
  if (!kept_) return;
  for (const Unfinished& table : unfinished()) {
    if (!table.same) {
      throw Error("sweep", {}, fmt::format("{} is the unfinished table of another sweep", model::quote(table.path)),
                  "finish that sweep with its own options, remove the file, or write to another one with --out");
    }
    read(table.path);
    taken_over_.push_back(table.path);
    place_ = table.path;
  }
  if (taken_over_.empty()) read(eom::WholeFile::followed(file_).string());
}

std::vector<Ledger::Unfinished> Ledger::unfinished() const {
  const fs::path target = eom::WholeFile::followed(file_);
  const std::string name = eom::WholeFile::shortened(target.filename().string()) + ".partial";
  std::vector<Unfinished> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(target.has_parent_path() ? target.parent_path() : fs::path("."), none)) {
    const std::string other = entry.path().filename().string();
    if (other != name && !(other.starts_with(name + "-") && other.size() == name.size() + 7)) continue;
    const std::string path = target.has_parent_path() ? entry.path().string() : other;
    std::string first;
    const bool own = each_line(path, [&](const std::string& line) { return first = line, false; });
    if (!own || !first.starts_with(mark)) continue;  // a run's, or somebody's who is writing to it
    found.push_back({path, first == mark + key_});
  }
  std::sort(found.begin(), found.end(), [](const Unfinished& a, const Unfinished& b) { return a.path < b.path; });
  return found;
}

void Ledger::read(const std::string& path) {
  std::size_t number = 0;
  each_line(path, [&](const std::string& line) {
    if (number == 0 && line != mark + key_) return false;
    if (number == 1) header_ = line;
    if (number++ < 2) return true;
    std::size_t run = 0;
    const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), run);
    if (error == std::errc() && stop != line.data() + line.size() && *stop == ',') rows_[run] = line;
    return true;
  });
}

void Ledger::write(const std::function<void(std::string_view)>& to) const {
  constexpr std::size_t enough = 1 << 20;  // a table of a million rows is not there twice
  std::string text = mark + key_ + "\n" + header_ + "\n";
  for (const auto& [run, line] : rows_) {
    text += line + "\n";
    if (text.size() < enough) continue;
    to(text);
    text.clear();
  }
  to(text);
}

void Ledger::set_header(const std::string& header) try {
  if (header_ != header) rows_.clear();  // a table of other columns cannot be gone on with
  header_ = header;
  if (!kept_) return;
  out_.emplace(file_);
  ::flock(out_->descriptor(), LOCK_EX | LOCK_NB);  // as long as this process is there; where locks are unknown nothing is lost
  place_ = out_->partial();
  write([this](std::string_view text) { out_->write(text); });
  for (const std::string& old : taken_over_) ::unlink(old.c_str());
  taken_over_.clear();
} catch (const std::system_error& error) {
  lost(error);
}

void Ledger::add(std::size_t run, const std::string& line) try {
  rows_[run] = line;
  if (out_) out_->write(line + "\n");
} catch (const std::system_error& error) {
  lost(error);
}

void Ledger::whole() const {
  if (!kept_) {
    std::string text;
    write([&text](std::string_view piece) { text += piece; });
    write_text(file_, text);
    return;
  }
  try {
    eom::WholeFile file(file_);
    try {
      write([&file](std::string_view piece) { file.write(piece); });
      file.finish();
    } catch (const std::system_error&) {
      file.discard();  // the rows are kept in the other one
      throw;
    }
  } catch (const std::system_error& error) {
    lost(error);
  }
}

void Ledger::finish() {
  if (kept_ && !out_ && taken_over_.empty()) return;  // all was there
  whole();
  place_ = file_;
  if (out_) out_->discard();
  for (const std::string& old : taken_over_) ::unlink(old.c_str());
}

void Ledger::interrupt() {
  if (!kept_ && !header_.empty()) whole();
}

}  // namespace eomgen::cli
