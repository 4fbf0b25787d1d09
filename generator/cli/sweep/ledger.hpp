// SPDX-License-Identifier: GPL-3.0-or-later
// The table of a sweep on disk: rows are added as runs end, in any order, so that a sweep that was cut off goes on where it was; when
// all are there the file is put in order under its own name.
#pragma once

#include <cstdio>
#include <map>
#include <memory>
#include <string>

namespace eomgen::cli {

class Ledger {
 public:
  /// FILE.partial, and FILE itself, are read; `key` is what makes two sweeps the same. Throws Error where FILE.partial is of another sweep.
  Ledger(std::string file, std::string key);

  /// Line of a run that is there, by its number.
  const std::map<std::size_t, std::string>& rows() const { return rows_; }
  const std::string& header() const { return header_; }  // "" before there is one
  void set_header(const std::string& header);
  void add(std::size_t run, const std::string& line);  // on disk when it returns
  void finish();                                        // FILE, in order; FILE.partial is gone

 private:
  bool read(const std::string& path);
  void write(const std::string& text);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string file_, partial_, key_, header_;
  std::map<std::size_t, std::string> rows_;
  std::unique_ptr<std::FILE, Close> out_;
};

}  // namespace eomgen::cli
