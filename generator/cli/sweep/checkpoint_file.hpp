// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <eom/output/atomic_file.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/sweep/row_checksum.hpp"
#include "cli/sweep/rows.hpp"

namespace eomgen::cli {

/// Lock of a table, so that two sweeps do not write the same one. In: the path of the table. Out: FILE.lock, which this
/// process holds until it ends or destroys the lock. The file of a killed process holds no lock.
class TableLock {
 public:
  TableLock() = default;  // of no table
  /// `table`: with all links followed. Throws Error if another process holds the lock, std::system_error if the file
  /// cannot be made. On a file system without locks nothing is locked.
  explicit TableLock(const std::filesystem::path& table);
  TableLock(TableLock&& other) noexcept;
  TableLock& operator=(TableLock&& other) noexcept;
  TableLock(const TableLock&) = delete;
  TableLock& operator=(const TableLock&) = delete;
  ~TableLock() { release(); }

 private:
  void release() noexcept;

  std::string path_;
  int file_ = -1;
};

/// Table of a sweep with checkpoints. Rows are appended to FILE.partial-XXXXXX in the order of completion; finish()
/// writes FILE in the order of the runs and removes the partial file. The constructor takes over the rows of partial
/// files of the same sweep and those of a finished FILE. Rows without their checksum or their point are computed again,
/// with a warning. For safety it follows no links and reads no files of other users. A lock keeps a second sweep from
/// FILE. If FILE is not a regular file, nothing is locked or taken over and the table is written directly.
class CheckpointFile {
 public:
  enum class Role { whole, member };  // member: a process of a group other than its leader; it takes nothing over

  using IsRowOfRun = std::function<bool(std::size_t run, std::string_view line)>;
  /// `key` identifies the sweep; it is in the first line of the file. `is_row_of_run`: whether the table has this run,
  /// and the line its point. Throws Error if there is an unfinished table of another sweep, or another process writes.
  CheckpointFile(std::string file, std::string key, IsRowOfRun is_row_of_run, Role part = Role::whole);

  const Rows& rows() const { return rows_; }  // sorted before the first add() and after finish()
  void sort() { rows_.sort(); }
  const std::string& header() const { return header_; }
  /// First lines of the file.
  std::string file_header() const;
  /// Sets the column names and starts the file. Not needed if all rows exist. Throws Error if the rows that were taken
  /// over have other columns.
  void set_header(const std::string& header);
  /// `row`: without its checksum.
  void add(std::size_t run, const std::string& row);
  void finish();
  /// Throws Error unless FILE is a regular file.
  void require_file() const;
  /// Whether FILE has to be written: rows are in other files, or it has lines that are none.
  bool open() const { return out_ || !taken_over_.empty() || damaged_ > 0; }
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
  void read(const std::string& path, const OpenFile& file);
  void warn_of_damage();
  void write(const std::function<void(std::string_view)>& to) const;
  void whole() const;  // to FILE
  void remove_others();

  std::string file_, place_, key_, header_;
  IsRowOfRun is_row_of_run_;
  TableLock lock_;
  RowChecksum checksum_;
  bool kept_ = true;         // rows go to a partial file
  std::size_t damaged_ = 0;  // lines that were not taken over
  bool warned_ = false;
  std::vector<std::string> taken_over_;
  Rows rows_;
  std::optional<eom::AtomicFile> out_;
  OpenFile own_;  // the partial file of this process
  std::uint32_t number_ = 0;
  std::uint64_t end_ = 0;
};

}  // namespace eomgen::cli
