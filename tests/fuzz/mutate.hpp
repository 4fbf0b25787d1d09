// SPDX-License-Identifier: GPL-3.0-or-later
// In: the text of a model. Out: a text with one or two changes that is mostly still a model: names, numbers, operators
// and values are replaced by others, sections come from other models. Random bytes seldom pass the reader.
#pragma once

#include <random>
#include <string>
#include <vector>

namespace eomgen::fuzz {

using Random = std::minstd_rand;

class Mutator {
 public:
  /// `donors`: models that provide values and sections.
  explicit Mutator(std::vector<std::string> donors);

  std::string operator()(std::string text, Random& random) const;
  /// One of the donors; every second time without units, so that changes cannot violate them.
  std::string donor(Random& random) const;

 private:
  std::string changed(const std::string& text, Random& random) const;

  std::vector<std::string> donors_;
};

/// `text` without units, in values and in expressions.
std::string without_units(const std::string& text);

}  // namespace eomgen::fuzz
