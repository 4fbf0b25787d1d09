// SPDX-License-Identifier: GPL-3.0-or-later
// A queue of the most frequent pairs while pairs are added and removed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "program/polynomials.hpp"

namespace eomgen::program {

/// Pairs are 64-bit keys that occur in rows. `seed` breaks ties; the order of the hash table has no influence.
class FrequentPairQueue {
 public:
  explicit FrequentPairQueue(std::uint64_t seed) : seed_(seed), entries_(std::size_t{1} << first_bits) {}

  void add(std::uint64_t key, std::uint32_t row, int count = 1) {
    Entry& entry = at(key);
    entry.count += count;
    entry.rows.push_back(row);
    if (entry.count >= 2) heap_.push({entry.count, rank(key), key});
  }
  void remove(std::uint64_t key, int count = 1) { at(key).count -= count; }

  /// Pops the most frequent pair that occurs at least twice, and the rows that may still contain it. Returns false if
  /// there is none.
  bool pop(std::uint64_t& key, std::vector<std::uint32_t>& rows) {
    while (!heap_.empty()) {
      const Candidate top = heap_.top();
      heap_.pop();
      Entry& entry = at(top.key);
      if (entry.count < 2) continue;
      if (entry.count != top.count) {  // outdated: pushed again with the current count
        heap_.push({entry.count, top.rank, top.key});
        continue;
      }
      key = top.key;
      rows.assign(entry.rows.begin(), entry.rows.end());
      entry.rows.truncate(0);
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
      return true;
    }
    return false;
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    int count = 0;
    bool taken = false;
    symbolic::SmallVector<std::uint32_t, 2> rows;
  };
  struct Candidate {
    int count;
    std::uint64_t rank, key;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      if (a.count != b.count) return a.count < b.count;
      return a.rank != b.rank ? a.rank < b.rank : a.key < b.key;
    }
  };
  static constexpr int first_bits = 6;

  std::uint64_t rank(std::uint64_t key) const { return seed_ == 0 ? ~key : hash_mix(key, seed_); }

  Entry& place(std::uint64_t key) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t i = hash_mix(key, 0) & mask;
    while (entries_[i].taken && entries_[i].key != key) i = (i + 1) & mask;
    return entries_[i];
  }
  Entry& at(std::uint64_t key) {
    Entry* entry = &place(key);
    if (entry->taken) return *entry;
    if (2 * ++taken_ > entries_.size()) {
      std::vector<Entry> old = std::exchange(entries_, std::vector<Entry>(2 * entries_.size()));
      for (Entry& moved : old) {
        if (moved.taken) place(moved.key) = std::move(moved);
      }
      entry = &place(key);
    }
    entry->key = key;
    entry->taken = true;
    return *entry;
  }

  std::uint64_t seed_;
  std::vector<Entry> entries_;  // the size is a power of 2; at most half are in use
  std::size_t taken_ = 0;
  std::priority_queue<Candidate> heap_;
};

}  // namespace eomgen::program
