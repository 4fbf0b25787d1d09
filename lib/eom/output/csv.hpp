// SPDX-License-Identifier: MIT
// A table of numbers in a file. In: column names, rows of (t, values). Out: F.csv, whole or not at all.
// Rows go to F.csv.partial; finish(outcome) adds the line "# outcome: NAME" and renames it to F.csv in one go, after an
// interruption or a failure too. Without finish the .partial file stays, with whole lines (a kill that falls into the
// middle of a write may cut the last one). Numbers have 17 significant
// digits, as printf's %.17g gives in the C locale, whatever the locale is; -0 is 0.
#pragma once

#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "eom/outcome.hpp"

namespace eom {

class CsvWriter {
 public:
  /// Opens path + ".partial" and writes the header line: t, then columns. Throws std::runtime_error with the path.
  CsvWriter(std::filesystem::path path, std::span<const std::string> columns)
      : path_(std::move(path)), partial_(path_), columns_(columns.size()) {
    partial_ += ".partial";
    file_.reset(std::fopen(partial_.string().c_str(), "wb"));
    if (file_ == nullptr) fail("open", partial_, std::strerror(errno));
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // lines are gathered here, so that only whole ones reach the file
    lines_.reserve(2 * flush_size);
    lines_ += 't';
    for (const std::string& column : columns) append_name(column);
    lines_ += '\n';
    flush();
  }

  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  ~CsvWriter() {
    if (file_ == nullptr) return;
    std::fwrite(lines_.data(), 1, lines_.size(), file_.get());  // a failure cannot be told any more
  }

  /// One line: t and as many values as there are columns. Throws std::invalid_argument for another number of values.
  void row(double t, std::span<const double> values) {
    if (values.size() != columns_)
      throw std::invalid_argument(path_.string() + ": a row of " + std::to_string(values.size()) + " values for " +
                                  std::to_string(columns_) + " columns");
    append_number(t);
    for (const double value : values) {
      lines_ += ',';
      append_number(value);
    }
    lines_ += '\n';
    if (lines_.size() >= flush_size) flush();
  }

  /// Hands the lines written so far to the operating system.
  void flush() {
    if (file_ == nullptr) throw std::logic_error(path_.string() + ": written to after finish");
    const std::size_t written = std::fwrite(lines_.data(), 1, lines_.size(), file_.get());
    if (written != lines_.size()) fail("write", partial_, std::strerror(errno));
    lines_.clear();
  }

  /// The trailing line, then the rename. Throws std::runtime_error with the path; the .partial file then stays.
  void finish(Outcome outcome) {
    lines_ += "# outcome: ";
    lines_ += name(outcome);
    lines_ += '\n';
    flush();
    if (std::fclose(file_.release()) != 0) fail("close", partial_, std::strerror(errno));
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (error) fail("rename to its final name", partial_, error.message());
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  static constexpr std::size_t flush_size = 1 << 16;

  [[noreturn]] static void fail(const char* action, const std::filesystem::path& path, const std::string& why) {
    throw std::runtime_error(std::string("cannot ") + action + " " + path.string() + ": " + why);
  }

  void append_number(double value) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value == 0 ? 0.0 : value, std::chars_format::general, 17);
    lines_.append(text, end.ptr);
  }

  /// A comma and the name, in quotes where RFC 4180 asks for them.
  void append_name(std::string_view column) {
    lines_ += ',';
    if (column.find_first_of(",\"\r\n") == std::string_view::npos) {
      lines_ += column;
      return;
    }
    lines_ += '"';
    for (const char c : column) lines_.append(c == '"' ? 2 : 1, c);
    lines_ += '"';
  }

  std::filesystem::path path_;
  std::filesystem::path partial_;
  std::size_t columns_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string lines_;
};

}  // namespace eom
