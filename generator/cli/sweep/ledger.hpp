// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <eom/output/whole_file.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/sweep/rows.hpp"

namespace eomgen::cli {

/// The table of a sweep. While it grows, rows go to FILE.partial-XXXXXX as they come in; finish() writes FILE in the
/// order of the runs and removes the other. Rows of such files of the same sweep that was interrupted are taken over,
/// unless the process that writes them is still there; so are those of FILE if the sweep is done. Links are not
/// followed there, nor are files of other users read. Where FILE is no regular file nothing is taken over, and the
/// table is written at once.
class Ledger {
 public:
  enum class Part {
    whole,
    member
  };  // of several processes that make one table all but the first are members: they take nothing over

  /// `key`: what makes two sweeps the same; it stands in the first line. `belongs`: whether a run is one of the table.
  /// Throws Error where an unfinished table of another sweep is in the way.
  Ledger(std::string file, std::string key, std::function<bool(std::size_t run)> belongs, Part part = Part::whole);

  const Rows& rows() const { return rows_; }  // in order before the first add() and after finish()
  void sort() { rows_.sort(); }
  const std::string& header() const { return header_; }
  /// What the file begins with.
  std::string beginning() const;
  /// What the columns are called; the file is begun with it. Nothing to do where all rows are there.
  void set_header(const std::string& header);
  void add(std::size_t run, const std::string& line);
  void finish();
  /// Throws Error where FILE is no regular file.
  void require_file() const;
  /// Rows are in other places than FILE.
  bool open() const { return out_ || !taken_over_.empty(); }
  /// The rows are in FILE, which somebody else wrote: removes the others.
  void finish_elsewhere();
  /// The rows so far, where no file keeps them for the next time.
  void interrupt();
  /// Where the rows are.
  const std::string& place() const { return place_; }

 private:
  struct Unfinished {
    std::string path;
    OpenFile file;
    bool same = false;  // of this sweep
  };
  std::vector<Unfinished> unfinished() const;
  void read(const OpenFile& file);
  void write(const std::function<void(std::string_view)>& to) const;
  void whole() const;  // to FILE
  void remove_others();

  std::string file_, place_, key_, header_;
  std::function<bool(std::size_t)> belongs_;
  bool kept_ = true;  // in a file of its own while it grows
  std::vector<std::string> taken_over_;
  Rows rows_;
  std::optional<eom::WholeFile> out_;
  OpenFile own_;  // what rows are added to
  std::uint32_t number_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace eomgen::cli
