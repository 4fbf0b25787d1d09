// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/signal.hpp"

#include <algorithm>

namespace eomgen::run {

using symbolic::SymbolKind;

Signal::Signal(const symbolic::Dag& dag, symbolic::Ref expression, const std::vector<double>& parameters)
    : code_(dag, {expression}, [&parameters](const symbolic::Symbol& s) {
        if (s.kind == SymbolKind::time) return RangeCode::Leaf::of_variable(0);
        return RangeCode::Leaf::of(s.kind == SymbolKind::parameter ? parameters[s.index] : 0.0);
      }) {}

Signal::Signal(std::vector<double> time, std::vector<double> value)
    : time_(std::move(time)), value_(std::move(value)) {}

double Signal::operator()(double t, double side_of) const {
  if (time_.empty()) return code_.roots() == 0 ? 0.0 : code_.value({&t, 1});
  const auto after = std::upper_bound(time_.begin(), time_.end(), side_of);
  const auto segment = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - time_.begin() - 1));
  return value_[segment];
}

bool Signal::moves() const { return time_.empty() && !code_.constant(); }

}  // namespace eomgen::run
