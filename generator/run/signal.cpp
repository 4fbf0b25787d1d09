// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/signal.hpp"

#include "run/expression_tables.hpp"

namespace eomgen::run {

Signal::Signal(const symbolic::Dag& dag, symbolic::Ref expression, const std::vector<double>& values) {
  signal_.expression = *make_table(dag, {expression}, [](const symbolic::Symbol& s) {
    if (s.kind == SymbolKind::time) return SymbolMeaning::of_variable(0);
    return s.kind == SymbolKind::parameter ? SymbolMeaning::of_parameter(s.index) : SymbolMeaning::of(0);
  });
  set_parameters(values);
}

Signal::Signal(std::vector<double> time, std::vector<double> value, bool linear)
    : signal_{{}, std::move(time), std::move(value), {}, linear} {}

void Signal::set_parameters(const std::vector<double>& values) {
  if (!signal_.expression.empty()) code_ = eom::expressions::Code(signal_.expression, values);
}

double Signal::operator()(double t, double side_of) const {
  return signal_.expression.empty() ? eom::hybrid::table_value(signal_, t, side_of).value : code_.value({&t, 1});
}

bool Signal::is_varying() const { return eom::hybrid::is_time_dependent(signal_); }

}  // namespace eomgen::run
