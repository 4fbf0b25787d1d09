// SPDX-License-Identifier: GPL-3.0-or-later
// Abbreviation of terms that are too long for a line. Lines break between terms, never within roots or fractions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reading/formula.hpp"

namespace eomgen::print {

class Shortener {
 public:
  /// `text`: prints a term. `fits`: whether that text fits on a line.
  Shortener(std::function<std::string(const reading::Formula&)> text, std::function<bool(const std::string&)> fits)
      : text_(std::move(text)), fits_(std::move(fits)) {}

  bool fits(const reading::Formula& term) const { return fits_(text_(term)); }

  /// Replaces the longest sums within the term by S_1, S_2, ... until it fits.
  reading::Formula operator()(reading::Formula term);

  /// The abbreviated sums so far; S_1 is the first.
  const std::vector<reading::Formula>& definitions() const { return definitions_; }
  static reading::Formula abbreviation(std::size_t index);

 private:
  reading::Formula name_of(const reading::Formula& sum);

  std::function<std::string(const reading::Formula&)> text_;
  std::function<bool(const std::string&)> fits_;
  std::vector<reading::Formula> definitions_;
  std::vector<std::string> texts_;  // texts of the sums: equal sums share a name
};

}  // namespace eomgen::print
