// SPDX-License-Identifier: GPL-3.0-or-later
// Elements that an import leaves out or changes: one entry for each kind, with the number of places and the first of
// them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "error.hpp"

namespace eomgen::import {

struct Finding {
  std::string what;  // "<collision>", "limits of velocity"
  std::string why;   // one sentence
  std::size_t count = 0;
  SourceLocation first;
};

class Findings {
 public:
  void add(const std::string& what, const std::string& why, const SourceLocation& where) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Finding& entry) { return entry.what == what && entry.why == why; });
    if (found != entries_.end()) {
      ++found->count;
    } else if (entries_.size() < most) {
      entries_.push_back({what, why, 1, where});
    } else {
      ++unlisted_;
    }
  }
  const std::vector<Finding>& entries() const { return entries_; }
  /// Places of further kinds, beyond the list.
  std::size_t unlisted() const { return unlisted_; }

 private:
  static constexpr std::size_t most = 200;
  std::vector<Finding> entries_;
  std::size_t unlisted_ = 0;
};

}  // namespace eomgen::import
