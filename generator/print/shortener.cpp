// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/shortener.hpp"

#include <algorithm>

namespace eomgen::print {

using reading::Formula;
using reading::FormulaKind;

Formula Shortener::abbreviation(std::size_t index) {
  return reading::mark("cal S", {reading::number(static_cast<long>(index) + 1)});
}

Formula Shortener::operator()(Formula term) {
  while (!fits(term)) {
    Formula* longest = nullptr;
    std::size_t length = 0;
    const std::function<void(Formula&)> visit = [&](Formula& f) {
      if (f.kind == FormulaKind::sum) {
        const std::size_t here = text_(f).size();
        if (here > length) longest = &f, length = here;
        return;
      }
      for (Formula& arg : f.args) visit(arg);
    };
    visit(term);
    if (!longest) break;
    *longest = name_of(*longest);
  }
  return term;
}

Formula Shortener::name_of(const Formula& sum) {
  const std::string text = text_(sum);
  const auto known = std::find(texts_.begin(), texts_.end(), text);
  const auto index = static_cast<std::size_t>(known - texts_.begin());
  if (known == texts_.end()) texts_.push_back(text), definitions_.push_back(sum);
  return abbreviation(index);
}

}  // namespace eomgen::print
