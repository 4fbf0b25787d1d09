// SPDX-License-Identifier: GPL-3.0-or-later
// Terms that are too long for a line, made short enough: lines break between terms, never within roots or fractions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "reading/formula.hpp"

namespace eomgen::print {

class Shortener {
 public:
  /// Of a term alone: its text, and whether that fits on a line.
  Shortener(std::function<std::string(const reading::Formula&)> text, std::function<bool(const std::string&)> fits)
      : text_(std::move(text)), fits_(std::move(fits)) {}

  bool fits(const reading::Formula& term) const { return fits_(text_(term)); }

  /// The term with the longest sums within it written as S_1, S_2, ... until it fits.
  reading::Formula operator()(reading::Formula term);

  /// What was abbreviated so far: S_1 is the first.
  const std::vector<reading::Formula>& meanings() const { return meanings_; }
  static reading::Formula abbreviation(std::size_t index);

 private:
  reading::Formula name_of(const reading::Formula& sum);

  std::function<std::string(const reading::Formula&)> text_;
  std::function<bool(const std::string&)> fits_;
  std::vector<reading::Formula> meanings_;
  std::vector<std::string> texts_;  // of the meanings: the same sum has the same name
};

}  // namespace eomgen::print
