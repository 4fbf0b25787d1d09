// SPDX-License-Identifier: MIT
// The argument `mode` of the C ABI (docs/abi.md, "Modes"): the discrete state of emitted code, one int for each
// contact, kink and exchangeable chart, in this order. In: numbers of each. Out: the array and its entries by meaning.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "eom/modes/contact_state.hpp"

namespace eom {

/// Numbers of contacts, kinks and exchangeable charts.
struct ModeLayout {
  std::size_t contacts = 0, kinks = 0, charts = 0;

  /// Length of the array.
  std::size_t size() const { return contacts + kinks + charts; }
  /// Index of the entry of kink k.
  std::size_t kink(std::size_t k) const { return contacts + k; }
  /// Index of the entry of chart j.
  std::size_t chart(std::size_t j) const { return contacts + kinks + j; }
};

/// All entries are 0 at first: contacts stick, branches follow the state, the charts are the own ones.
class ModeArray {
 public:
  ModeArray() = default;
  /// All entries are 0.
  explicit ModeArray(const ModeLayout& layout) : layout_(layout), entries_(layout.size()) {}

  /// Numbers of entries of each kind.
  const ModeLayout& layout() const { return layout_; }
  /// All entries.
  const std::vector<int>& entries() const { return entries_; }
  /// The argument `mode` of the C ABI.
  const int* data() const { return entries_.data(); }
  bool operator==(const ModeArray& other) const { return entries_ == other.entries_; }

  /// The number of the mode of the contacts, with one digit per contact (contact_digit()).
  int contacts() const {
    int number = 0;
    for (std::size_t j = layout_.contacts; j-- > 0;) number = contact_states * number + entries_[j];
    return number;
  }
  /// Sets the entries of all contacts from the number of their mode.
  void set_contacts(int number) {
    for (std::size_t j = 0; j < layout_.contacts; ++j) entries_[j] = contact_digit(number, j);
  }

  /// 1: the branch of positive values of the surface is frozen, -1: that of negative ones, 0: none.
  int kink(std::size_t k) const { return entries_[layout_.kink(k)]; }
  /// Freezes a branch of kink k (1 or -1), or releases it (0).
  void set_kink(std::size_t k, int side) { entries_[layout_.kink(k)] = side; }
  /// Whether some branch is frozen.
  bool has_frozen_branches() const {
    return std::any_of(kinks_begin(), kinks_end(), [](int side) { return side != 0; });
  }
  /// Releases all branches, so that they follow the state.
  void release_branches() { std::fill(kinks_begin(), kinks_end(), 0); }

  /// The set of second charts: bit j for chart j.
  unsigned charts() const {
    unsigned set = 0;
    for (std::size_t j = 0; j < layout_.charts; ++j) set |= (entries_[layout_.chart(j)] != 0 ? 1u : 0u) << j;
    return set;
  }
  /// Bit j of the set: chart j is the second one.
  void set_charts(unsigned set) {
    for (std::size_t j = 0; j < layout_.charts; ++j) entries_[layout_.chart(j)] = static_cast<int>(set >> j & 1u);
  }

 private:
  using Iterator = std::vector<int>::iterator;
  using ConstIterator = std::vector<int>::const_iterator;
  Iterator kinks_begin() { return entries_.begin() + static_cast<std::ptrdiff_t>(layout_.contacts); }
  Iterator kinks_end() { return kinks_begin() + static_cast<std::ptrdiff_t>(layout_.kinks); }
  ConstIterator kinks_begin() const { return entries_.begin() + static_cast<std::ptrdiff_t>(layout_.contacts); }
  ConstIterator kinks_end() const { return kinks_begin() + static_cast<std::ptrdiff_t>(layout_.kinks); }

  ModeLayout layout_;
  std::vector<int> entries_;
};

/// The largest number of exchangeable charts: code in every set of second charts exists.
inline constexpr std::size_t max_charts = 3;

}  // namespace eom
