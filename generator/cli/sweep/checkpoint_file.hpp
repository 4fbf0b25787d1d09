// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <eom/output/atomic_file.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/sweep/rows.hpp"

namespace eomgen::cli {

/// Table of a sweep with checkpoints. Rows are appended to FILE.partial-XXXXXX in the order of completion; finish()
/// writes FILE in the order of the runs and removes the partial file. The constructor takes over the rows of partial
/// files of the same sweep, unless their process still runs, and those of a finished FILE. For safety it follows no
/// links and reads no files of other users. If FILE is not a regular file, nothing is taken over and the table is
/// written directly.
class CheckpointFile {
 public:
  enum class Role { whole, member };  // member: a process of a group other than its leader; it takes nothing over

  /// `key` identifies the sweep; it is in the first line of the file. `belongs`: whether the table has this run. Throws
  /// Error if there is an unfinished table of another sweep.
  CheckpointFile(std::string file, std::string key, std::function<bool(std::size_t run)> contains_run,
                 Role part = Role::whole);

  const Rows& rows() const { return rows_; }  // sorted before the first add() and after finish()
  void sort() { rows_.sort(); }
  const std::string& header() const { return header_; }
  /// First lines of the file.
  std::string file_header() const;
  /// Sets the column names and starts the file. Not needed if all rows exist.
  void set_header(const std::string& header);
  void add(std::size_t run, const std::string& line);
  void finish();
  /// Throws Error unless FILE is a regular file.
  void require_file() const;
  /// Whether rows are in files other than FILE.
  bool open() const { return out_ || !taken_over_.empty(); }
  /// Removes the partial files after another process wrote FILE.
  void remove_partial_files();
  /// Writes the rows so far if no partial file stores them.
  void interrupt();
  /// Path of the file that contains the rows.
  const std::string& path() const { return place_; }

 private:
  struct Unfinished {
    std::string path;
    OpenFile file;
    bool same = false;  // belongs to this sweep
  };
  std::vector<Unfinished> unfinished() const;
  void read(const OpenFile& file);
  void write(const std::function<void(std::string_view)>& to) const;
  void whole() const;  // to FILE
  void remove_others();

  std::string file_, place_, key_, header_;
  std::function<bool(std::size_t)> contains_run_;
  bool kept_ = true;  // rows go to a partial file
  std::vector<std::string> taken_over_;
  Rows rows_;
  std::optional<eom::AtomicFile> out_;
  OpenFile own_;  // the partial file of this process
  std::uint32_t number_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace eomgen::cli
