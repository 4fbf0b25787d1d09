// SPDX-License-Identifier: MIT
// A table of numbers in a file. In: column names, rows of (t, values). Out: F.csv, whole or not at all.
// Rows go to F.csv.partial-XXXXXX (whole_file.hpp); finish(outcome) adds the line "# outcome: NAME" and renames it to
// F.csv in one go, after an interruption or a failure too. Without finish the partial file stays, with whole lines (a
// kill that falls into the middle of a write may cut the last one). Numbers have 17 significant digits, as printf's
// %.17g gives in the C locale, whatever the locale is; -0 is 0.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "eom/outcome.hpp"
#include "eom/output/whole_file.hpp"

namespace eom {

class CsvWriter {
 public:
  /// Opens the file and writes the header line: t, then columns. Throws std::system_error with the path.
  CsvWriter(const std::filesystem::path& path, std::span<const std::string> columns)
      : CsvWriter(WholeFile(path), columns) {}
  CsvWriter(WholeFile file, std::span<const std::string> columns)
      : path_(file.path()), partial_(file.partial()), columns_(columns.size()), file_(std::move(file)) {
    lines_.reserve(2 * flush_size);
    lines_ += 't';
    for (const std::string& column : columns) append_name(column);
    lines_ += '\n';
    flush();
  }

  CsvWriter(const CsvWriter&) = delete;
  CsvWriter& operator=(const CsvWriter&) = delete;

  ~CsvWriter() {
    if (finished_) return;
    try {
      file_.write(lines_);
    } catch (const std::exception&) {  // cannot be told any more
    }
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
    ++rows_;
    if (lines_.size() >= flush_size) flush();
  }

  /// Hands the lines written so far to the operating system.
  void flush() {
    if (finished_) throw std::logic_error(path_.string() + ": written to after finish");
    const std::string lines = std::exchange(lines_, {});  // what fails is not tried again
    file_.write(lines);
    lines_.reserve(2 * flush_size);
  }

  /// The trailing line, then the rename. Throws std::system_error with the path; the partial file then stays.
  void finish(Outcome outcome) {
    lines_ += "# outcome: ";
    lines_ += name(outcome);
    lines_ += '\n';
    flush();
    finished_ = true;
    file_.finish();
  }

  /// Where the rows are until finish; empty where they are written through.
  const std::string& partial() const { return partial_; }
  std::uint64_t rows() const { return rows_; }
  std::uint64_t bytes() const { return file_.bytes(); }

 private:
  static constexpr std::size_t flush_size = 1 << 16;

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
  std::string partial_;
  std::size_t columns_;
  WholeFile file_;
  std::string lines_;
  std::uint64_t rows_ = 0;
  bool finished_ = false;
};

}  // namespace eom
