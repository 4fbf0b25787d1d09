// SPDX-License-Identifier: GPL-3.0-or-later
// Random values of symbols, equal in every run and for every form of a system.
#pragma once

#include <cln/real.h>

#include "program/build.hpp"
#include "program/interpret.hpp"
#include "program/polynomials.hpp"
#include "symbolic/evaluate.hpp"

namespace test_systems {

/// A value in (0.3, 1.3) for a symbol.
inline symbolic::Rational value_at(const symbolic::Symbol& s, std::uint64_t point) {
  const std::uint64_t key = (static_cast<std::uint64_t>(s.kind) << 40) + (std::uint64_t{s.order} << 32) + s.index;
  return symbolic::Rational(static_cast<long>(program::hash_mix(key, point + 77) % 1009) + 300) / 1009;
}

/// The same point as arguments of a Function.
template <class Real>
program::Arguments<Real> arguments_at(const system::EquationSystem& system, std::uint64_t point) {
  const auto number = [](const symbolic::Rational& value) -> Real {
    if constexpr (std::is_same_v<Real, double>)
      return cln::double_approx(value);
    else
      return value;
  };
  program::Arguments<Real> arguments;
  arguments.t = number(value_at({symbolic::SymbolKind::time, 0, 0}, point));
  for (std::uint8_t order = 0; order < 2; ++order) {
    for (const std::uint32_t i : system.free) {
      arguments.x.push_back(number(value_at({symbolic::SymbolKind::coordinate, i, order}, point)));
    }
  }
  constexpr std::uint32_t enough = 60;
  for (std::uint32_t i = 0; i < enough; ++i) {
    arguments.p.push_back(number(value_at({symbolic::SymbolKind::parameter, i, 0}, point)));
    arguments.u.push_back(number(value_at({symbolic::SymbolKind::input, i, 0}, point)));
    arguments.v.push_back(number(value_at({symbolic::SymbolKind::vector, i, 0}, point)));
  }
  return arguments;
}

/// Values of expressions at the point in 60 digits.
inline std::vector<cln::cl_R> expressions_at(const symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots,
                                             std::uint64_t point, int digits = 60) {
  const auto value = [point](const symbolic::Symbol& s) -> cln::cl_R { return value_at(s, point); };
  return symbolic::evaluate(dag, roots, std::function<cln::cl_R(const symbolic::Symbol&)>(value), digits);
}

inline double difference(const std::vector<cln::cl_R>& a, const std::vector<cln::cl_R>& b) {
  if (a.size() != b.size()) return 1e300;
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, cln::double_approx(cln::abs(a[i] - b[i]) / (1 + cln::abs(a[i]))));
  }
  return worst;
}

inline program::Program build(const system::EquationSystem& system, const std::vector<std::string>& with = {},
                              bool optimise = true, bool outputs = false) {
  std::vector<system::EquationSystem> candidates{system};
  program::Request request;
  request.with = with;
  request.optimise = optimise;
  if (outputs) {
    for (const auto& output : system.outputs) request.outputs.push_back(output.name);
  }
  return program::build_program(candidates, request);
}

struct NamedSystem {
  const char* name;
  system::EquationSystem system;
};

}  // namespace test_systems
