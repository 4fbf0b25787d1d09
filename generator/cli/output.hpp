// SPDX-License-Identifier: GPL-3.0-or-later
// Output of results: documents to standard output, files to the paths given by options, messages to standard error.
#pragma once

#include <eom/output/csv.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/json.hpp"
#include "emit/targets.hpp"

namespace eomgen::cli {

/// Turns -0 into 0, for results.
inline double unsigned_zero(double value) { return value == 0 ? 0 : value; }

/// Prints to standard output. Invalid UTF-8 (of a path, for example) is replaced, numbers that are not finite become
/// null, -0 becomes 0.
void print_document(const Json& document);

/// Prints to standard error. If that fails, only this message is lost.
void print_message(std::string_view text) noexcept;

/// Destination of results given by an option; `-` is standard output.
struct OutputTarget {
  std::string option, path, extension;         // "--out", "a.csv", ".csv"; empty extension: any
  std::vector<std::string> alternatives = {};  // further extensions, if the extension selects the format
};

/// Throws Error unless all `places` can be written, are distinct, differ from the model file, and have no extension of
/// another format. `json`: the document already goes to standard output. Call it before the computation.
void require_writable_targets(const std::vector<OutputTarget>& places, const std::string& model_file, bool json);

/// Throws Error if the name of an output `folder` has the extension of a file.
void require_folder(const std::string& folder);

bool is_standard_output(const std::string& path);

/// ".png" for a path like "a.PNG".
std::string lowered_extension(const std::string& path);

/// Writes a text to a path, completely or not at all. Returns the number of bytes. Throws Error.
std::uint64_t write_text(const std::string& path, const std::string& text);

/// CSV table that is written row by row. Throws Error.
class TableFile {
 public:
  TableFile(const std::string& path, std::span<const std::string> columns);
  void row(double t, std::span<const double> values);
  void finish(eom::Outcome outcome);
  const eom::CsvWriter& writer() const { return writer_; }

 private:
  eom::CsvWriter writer_;
};

/// Writes files into a folder, each completely or not at all, and returns their paths. Throws Error if one would
/// replace the model file.
std::vector<std::string> write_results(const std::string& folder, const std::vector<emit::EmittedFile>& files,
                                       const std::string& model_file);

/// Prints readable results to standard output, or to standard error if standard output carries a file.
void print_readable(std::string_view text, bool output_taken);

/// Prints the document if `json`, else the readable text.
void print_result(bool json, const Json& document, std::string_view text, bool output_taken = false);

/// "1.2 MB"
std::string size_text(double bytes);

/// The shortest decimal that reads back as the same binary64.
std::string shortest(double value);

}  // namespace eomgen::cli
