// SPDX-License-Identifier: MIT
// A table of numbers in a file, complete or not at all. In: column names, rows of (t, values). Out: F.csv. Rows are
// written to F.csv.partial-XXXXXX (atomic_file.hpp). finish(outcome) adds the line "# outcome: NAME" and renames the
// file to F.csv atomically, also after an interruption or a failure. Without finish the partial file remains, with
// whole lines (a kill during a write may truncate the last one). Numbers have 17 significant digits, like printf's
// %.17g in the C locale, in any locale; -0 is written as 0.
#pragma once

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
#include "eom/output/atomic_file.hpp"
#include "eom/output/decimal.hpp"

namespace eom {

/// Writes rows of numbers with 17 digits, and the outcome of the run as the last line.
class CsvWriter {
 public:
  /// Opens the file and writes the header line: t, then columns. Throws std::system_error with the path.
  CsvWriter(const std::filesystem::path& path, std::span<const std::string> columns)
      : CsvWriter(AtomicFile(path), columns) {}
  /// The same for an open file.
  CsvWriter(AtomicFile file, std::span<const std::string> columns)
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
    } catch (const std::exception&) {  // a destructor cannot report errors
    }
  }

  /// Writes one line: t and one value per column. Throws std::invalid_argument for another number of values.
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

  /// Passes the lines written so far to the operating system.
  void flush() {
    if (finished_) throw std::logic_error(path_.string() + ": written to after finish");
    const std::string lines = std::exchange(lines_, {});  // failed writes are not repeated
    file_.write(lines);
    lines_.reserve(2 * flush_size);
  }

  /// Writes the trailing line and renames the file. Throws std::system_error with the path; the partial file then
  /// remains.
  void finish(Outcome outcome) {
    lines_ += "# outcome: ";
    lines_ += name(outcome);
    lines_ += '\n';
    flush();
    finished_ = true;
    file_.finish();
  }

  /// Path of the rows until finish; empty if they are written directly.
  const std::string& partial() const { return partial_; }
  /// Number of rows written.
  std::uint64_t rows() const { return rows_; }
  /// Number of bytes that have been passed to the file.
  std::uint64_t bytes() const { return file_.bytes(); }

 private:
  static constexpr std::size_t flush_size = 1 << 16;

  void append_number(double value) {
    char text[40];
    lines_.append(text, decimals::write_decimal(text, text + sizeof text, value == 0 ? 0.0 : value, 17));
  }

  /// Appends a comma and the name, in quotes if RFC 4180 requires them.
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
  AtomicFile file_;
  std::string lines_;
  std::uint64_t rows_ = 0;
  bool finished_ = false;
};

}  // namespace eom
