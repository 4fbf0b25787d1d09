// SPDX-License-Identifier: GPL-3.0-or-later
// Lock of a table, so that two sweeps do not write the same one. In: the path of the table. Out: FILE.lock, which this
// process holds until it ends or destroys the lock. The file of a killed process holds no lock.
#pragma once

#include <filesystem>
#include <string>

namespace eomgen::cli {

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

}  // namespace eomgen::cli
