// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <eom/output/whole_file.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::cli {

/// The table of a sweep. While it grows, rows go to FILE.partial-XXXXXX as they come in; finish() writes FILE in the order of the
/// runs and removes the other. Rows of such a file of the same sweep that was interrupted are taken over, unless the
/// process that writes it is still there; so are those of FILE if the sweep is done. Links are not followed there, nor
/// are files of other users read. Where FILE is no regular file nothing is taken over, and the table is written at once.
class Ledger {
 public:
  /// `key`: what makes two sweeps the same; it stands in the first line. Throws Error where an unfinished table of
  /// another sweep is in the way.
  Ledger(std::string file, std::string key);

  const std::map<std::size_t, std::string>& rows() const { return rows_; }  // by the number of the run
  const std::string& header() const { return header_; }
  /// What the columns are called; the file is begun with it. Nothing to do where all rows are there.
  void set_header(const std::string& header);
  void add(std::size_t run, const std::string& line);
  void finish();
  /// The rows so far, where no file keeps them for the next time.
  void interrupt();
  /// Where the rows are.
  const std::string& place() const { return place_; }

 private:
  struct Unfinished {
    std::string path;
    bool same = false;  // of this sweep
  };
  std::vector<Unfinished> unfinished() const;
  void read(const std::string& path);
  void write(const std::function<void(std::string_view)>& to) const;
  void whole() const;  // to FILE

  std::string file_, place_, key_, header_;
  bool kept_ = true;  // in a file of its own while it grows
  std::vector<std::string> taken_over_;
  std::map<std::size_t, std::string> rows_;
  std::optional<eom::WholeFile> out_;
};

}  // namespace eomgen::cli
