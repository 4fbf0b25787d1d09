// SPDX-License-Identifier: GPL-3.0-or-later
// In: the text of a model. Out: one that is a change or two away and mostly still a model: names, numbers, operators
// and values are exchanged for others, sections come from other models. Bytes alone seldom get past the reader.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace eomgen::fuzz {

using Random = std::minstd_rand;

class Mutator {
 public:
  /// `donors`: models whose values and sections are taken.
  explicit Mutator(std::vector<std::string> donors);

  std::string operator()(std::string text, Random& random) const;
  /// One of the donors; without its units every second time, so that no change breaks them.
  std::string donor(Random& random) const;

 private:
  std::string changed(const std::string& text, Random& random) const;

  std::vector<std::string> donors_;
};

/// `text` without units, in values and in expressions.
std::string without_units(const std::string& text);

}  // namespace eomgen::fuzz
