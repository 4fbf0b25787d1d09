// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/signal.hpp"

#include <algorithm>

#include "run/expression_tables.hpp"

namespace eomgen::run {

using symbolic::SymbolKind;

Signal::Signal(const symbolic::Dag& dag, symbolic::Ref expression, const std::vector<double>& values)
    : expression_(*table_of(dag, {expression}, [](const symbolic::Symbol& s) {
        if (s.kind == SymbolKind::time) return Leaf::of_variable(0);
        return s.kind == SymbolKind::parameter ? Leaf::of_parameter(s.index) : Leaf::of(0);
      })) {
  parameters(values);
}

Signal::Signal(std::vector<double> time, std::vector<double> value)
    : time_(std::move(time)), value_(std::move(value)) {}

void Signal::parameters(const std::vector<double>& values) {
  if (!expression_.empty()) code_ = eom::expressions::Code(expression_, values);
}

double Signal::operator()(double t, double side_of) const {
  if (time_.empty()) return expression_.empty() ? 0.0 : code_.value({&t, 1});
  const auto after = std::upper_bound(time_.begin(), time_.end(), side_of);
  const auto segment = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - time_.begin() - 1));
  return value_[segment];
}

bool Signal::moves() const { return time_.empty() && !expression_.constant(); }

}  // namespace eomgen::run
