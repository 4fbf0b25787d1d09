// SPDX-License-Identifier: GPL-3.0-or-later
// Where results go: documents to standard output, files to the places that options name; and what is told beside them.
#pragma once

#include <eom/output/csv.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/json.hpp"
#include "emit/targets.hpp"

namespace eomgen::cli {

/// Of a result: 0 has no sign.
inline double unsigned_zero(double value) { return value == 0 ? 0 : value; }

/// To standard output. Bytes that are no UTF-8 (of a path, say) are replaced, numbers that are not finite are null, -0
/// is 0.
void print_document(const Json& document);

/// To standard error; where that is closed or full the words are lost, and nothing else is.
void tell(std::string_view text) noexcept;

/// A place for results, as an option named it; `-` is standard output. An empty `path` of an option that was not given
/// is no place.
struct Place {
  std::string option, path, ending;  // "--out", "a.csv", ".csv"; an empty ending: any
  std::string or_ending = {};        // where the ending chooses the format: this or the first, and no other
};

/// Throws Error unless every one of `places` can be written to, is none of the others and not the model's own file, and
/// has no ending that names another format. `json`: standard output has the document already. Called before the work
/// whose results go there.
void require_places(const std::vector<Place>& places, const std::string& model_file, bool json);

/// Throws Error where `folder`, which is to hold files, has the name of one.
void require_folder(const std::string& folder);

bool is_standard_output(const std::string& path);

/// A whole text to a place; gives the number of bytes. Throws Error.
std::uint64_t write_text(const std::string& path, const std::string& text);

/// A table at a place. Throws Error.
class TableFile {
 public:
  TableFile(const std::string& path, std::span<const std::string> columns);
  void row(double t, std::span<const double> values);
  void finish(eom::Outcome outcome);
  const eom::CsvWriter& writer() const { return writer_; }

 private:
  eom::CsvWriter writer_;
};

/// Files into a folder that an option named, each whole or none; none of them is the model's own file. Gives their
/// paths.
std::vector<std::string> write_results(const std::string& folder, const std::vector<emit::EmittedFile>& files,
                                       const std::string& model_file);

/// Readable results: to standard output, or to standard error where a file has taken that.
void print_readable(std::string_view text, bool output_taken);

/// "1.2 MB"
std::string size_text(double bytes);

/// The shortest decimal that reads back as the same binary64.
std::string shortest(double value);

}  // namespace eomgen::cli
