// SPDX-License-Identifier: GPL-3.0-or-later
// An index of numbered entries by hash: an open-addressing table of (hash, number). The entries themselves, and their
// comparison, belong to the caller.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace eomgen::symbolic {

/// Entries with equal hashes keep their order of insertion.
class HashIndex {
 public:
  using Entry = std::uint32_t;

  /// The first entry with this hash that satisfies `is_it`; null if there is none.
  template <class IsIt>
  const Entry* find(std::uint64_t hash, const IsIt& is_it) const {
    if (slots_.empty()) return nullptr;
    for (std::size_t at = hash & (slots_.size() - 1); slots_[at].taken; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].hash == hash && is_it(slots_[at].entry)) return &slots_[at].entry;
    }
    return nullptr;
  }
  void add(std::uint64_t hash, Entry entry) {
    reserve(++taken_);
    place({hash, entry, true});
  }
  void reserve(std::size_t entries) {
    std::size_t size = std::max<std::size_t>(64, slots_.size());
    while (size < 2 * entries) size *= 2;
    if (size == slots_.size()) return;
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(size));
    // Starts at an empty slot, so that entries of equal hash keep their order.
    std::size_t first = 0;
    while (first < old.size() && old[first].taken) ++first;
    for (std::size_t i = 0; i < old.size(); ++i) {
      const Slot& slot = old[(first + i) & (old.size() - 1)];
      if (slot.taken) place(slot);
    }
  }

 private:
  struct Slot {
    std::uint64_t hash = 0;
    Entry entry = 0;
    bool taken = false;
  };
  void place(const Slot& slot) {
    std::size_t at = slot.hash & (slots_.size() - 1);
    while (slots_[at].taken) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = slot;
  }

  std::vector<Slot> slots_;  // the size is 0 or a power of 2
  std::size_t taken_ = 0;
};

}  // namespace eomgen::symbolic
