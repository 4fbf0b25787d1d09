// SPDX-License-Identifier: GPL-3.0-or-later
// Which pair is the most frequent one, while pairs come and go.
#pragma once

#include <algorithm>
#include <cstdint>
#include <queue>
#include <unordered_map>
#include <vector>

#include "program/polynomials.hpp"

namespace eomgen::program {

/// Pairs are 64-bit keys that occur in rows. Ties go by `seed`; nothing depends on the order of the hash table.
class Frequency {
 public:
  explicit Frequency(std::uint64_t seed) : seed_(seed) {}

  void add(std::uint64_t key, std::uint32_t row, int count = 1) {
    Entry& entry = entries_[key];
    entry.count += count;
    entry.rows.push_back(row);
    if (entry.count >= 2) heap_.push({entry.count, rank(key), key});
  }
  void remove(std::uint64_t key, int count = 1) { entries_[key].count -= count; }

  /// The most frequent pair that occurs at least twice, with the rows where it may still be; false if there is none.
  bool pop(std::uint64_t& key, std::vector<std::uint32_t>& rows) {
    while (!heap_.empty()) {
      const Candidate top = heap_.top();
      heap_.pop();
      Entry& entry = entries_[top.key];
      if (entry.count < 2) continue;
      if (entry.count != top.count) {  // out of date: back with what is true now
        heap_.push({entry.count, top.rank, top.key});
        continue;
      }
      key = top.key;
      rows = std::move(entry.rows);
      entry.rows.clear();
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      return true;
    }
    return false;
  }

 private:
  struct Entry {
    int count = 0;
    std::vector<std::uint32_t> rows;
  };
  struct Candidate {
    int count;
    std::uint64_t rank, key;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      if (a.count != b.count) return a.count < b.count;
      return a.rank != b.rank ? a.rank < b.rank : a.key < b.key;
    }
  };
  std::uint64_t rank(std::uint64_t key) const { return seed_ == 0 ? ~key : scramble(key, seed_); }

  std::uint64_t seed_;
  std::unordered_map<std::uint64_t, Entry> entries_;
  std::priority_queue<Candidate> heap_;
};

}  // namespace eomgen::program
