// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/lone_parameter.hpp"
#include "model/names.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::run {
namespace {

using mechanics::Mechanics;
using symbolic::Rational;

constexpr int parameter_digits = 40;

// The simplification of the equations assumed this sign.
void require_sign(const model::Parameter& p, const cln::cl_R& value, const model::Model& model) {
  if (!p.positive || cln::plusp(value)) return;
  throw Error(
      "scene", model.where(p.span),
      fmt::format("parameter '{}' is declared positive, and its value is {}", p.name, cln::double_approx(value)),
      "give it a positive value, or leave `positive` out of the model");
}

// Runs use binary64: a subnormal number would silently count as 0 there.
void require_normal(const std::string& what, const cln::cl_R& value, const SourceLocation& where) {
  if (cln::zerop(value)) return;
  const cln::cl_F written = cln::cl_float(value, cln::float_format(parameter_digits));
  const auto size = cln::float_exponent(written);  // |value| < 2^size
  const double power = std::log10(std::abs(cln::double_approx(cln::scale_float(written, -size)))) +
                       static_cast<double>(size) * std::numbers::ln2 / std::numbers::ln10;
  const bool small = size < std::numeric_limits<double>::min_exponent;
  if (!small && size <= std::numeric_limits<double>::max_exponent) return;
  throw Error("scene", where,
              fmt::format("{} is about 1e{} here, {}", what, std::lround(power),
                          small ? "which counts as 0: numbers of a run are from 2.2e-308 on"
                                : "which no run can hold: its numbers end at 1.8e308"),
              small ? "choose units in which it is larger" : "choose units in which it is smaller");
}

std::vector<Ref> parameter_formulas(Mechanics& m, const model::Scene& scene, const Overrides& overrides) {
  std::vector<Ref> formula = m.parameter_value;
  for (const auto& [index, value] : scene.parameters) formula[index] = mechanics::lower_scalar(m, value);
  for (const auto& [name, value] : overrides.values) {
    const auto is_input = [&wanted = name](const model::Input& input) {
      return input.source == model::Input::Source::scene && input.name == wanted;
    };
    if (is_start_value(*m.model, name) || std::any_of(m.model->inputs.begin(), m.model->inputs.end(), is_input))
      continue;
    const auto found = std::find_if(m.model->parameters.begin(), m.model->parameters.end(),
                                    [&wanted = name](const model::Parameter& p) { return p.name == wanted; });
    if (found == m.model->parameters.end()) {
      std::vector<std::string> names;
      for (const model::Parameter& p : m.model->parameters) names.push_back(p.name);
      std::vector<std::string> known = state_columns(*m.model);
      known.insert(known.begin(), names.begin(), names.end());
      for (const model::Input& input : m.model->inputs) known.push_back(input.name);
      std::string hint = model::did_you_mean(name, known);
      if (hint.empty() && !names.empty()) hint = fmt::format("the parameters are {}", fmt::join(names, ", "));
      if (hint.empty()) hint = "the model has none; the start of a coordinate or state can be set";
      throw Error("scene", {}, fmt::format("there is no parameter {} to set", model::quote(name)), hint);
    }
    const auto index = static_cast<std::size_t>(found - m.model->parameters.begin());
    if (index == m.model->start_time) {
      throw Error("scene", {},
                  fmt::format("'{}' is the start of the run, from which integrals count: it cannot be set", name),
                  "state it in the scene: t = [t0, t1]");
    }
    if (found->initial_value_of) {
      throw Error("scene", {}, fmt::format("'{}' is the start value of a coordinate: it cannot be set", name),
                  "state the start in the scene: initial = { .. }");
    }
    formula[index] = m.dag->constant(value);
  }
  return formula;
}

std::vector<cln::cl_R> parameter_values(Mechanics& m, const std::vector<Ref>& formula, int wanted_digits) {
  const std::size_t n = formula.size();
  std::vector<cln::cl_R> values(n, 0);
  std::vector<bool> known(n, false);
  // Parameters may depend on one another without cycles, in any order of the file: n rounds resolve the longest chain.
  for (std::size_t round = 0; round < n; ++round) {
    for (std::size_t i = 0; i < n; ++i) {
      if (known[i]) continue;
      bool ready = true;
      for (const Symbol& s : m.dag->symbols({formula[i]}))
        ready = ready && s.kind == SymbolKind::parameter && known[s.index];
      if (!ready) continue;
      const auto lookup = [&](const Symbol& s) -> cln::cl_R { return values[s.index]; };
      try {
        values[i] = symbolic::evaluate(*m.dag, {formula[i]}, lookup, wanted_digits)[0];
      } catch (const std::exception& error) {
        const model::Parameter& p = m.model->parameters[i];
        throw Error("scene", m.model->where(p.span),
                    fmt::format("parameter '{}' has no value: {}", p.name, error.what()),
                    "check the numbers that it is computed from");
      }
      known[i] = true;
      const model::Parameter& p = m.model->parameters[i];
      require_sign(p, values[i], *m.model);
      require_normal(fmt::format("parameter '{}'", p.name), values[i], m.model->where(p.span));
    }
  }
  return values;
}

// Values of expressions of parameters alone; the equations evaluate other expressions during the run.
std::optional<std::vector<cln::cl_R>> known_values(const Mechanics& m, const std::vector<Ref>& expressions,
                                                   const std::vector<cln::cl_R>& parameters, const std::string& what,
                                                   const model::Span& span) {
  const std::vector<Symbol> symbols = m.dag->symbols(expressions);
  if (std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind != SymbolKind::parameter; }))
    return std::nullopt;
  const auto lookup = [&](const Symbol& s) -> cln::cl_R { return parameters[s.index]; };
  try {
    return symbolic::evaluate(*m.dag, expressions, lookup, parameter_digits);
  } catch (const std::domain_error& error) {
    throw Error("scene", m.model->where(span), fmt::format("{} has no value here: {}", what, error.what()),
                "check the numbers that it is computed from");
  }
}

}  // namespace

void require_masses(Mechanics& m, const std::vector<cln::cl_R>& values, const model::Scene& scene) {
  struct Heavy {
    std::uint32_t place;
    model::NodeId mass;
    model::Span span;
  };
  std::vector<Heavy> all;
  for (const model::Particle& particle : m.model->particles)
    all.push_back({particle.place, particle.mass, particle.span});
  for (const model::Body& body : m.model->bodies) all.push_back({body.place, body.mass, body.span});
  for (const Heavy& particle : all) {
    const std::string what = fmt::format("the mass of '{}'", m.model->places[particle.place].name);
    const auto mass = known_values(m, {mechanics::lower_scalar(m, particle.mass)}, values, what, particle.span);
    if (mass) require_normal(what, mass->front(), m.model->where(particle.span));
    if (!mass || cln::plusp(mass->front())) continue;
    const auto set = std::find_if(scene.parameters.begin(), scene.parameters.end(), [&](const auto& parameter) {
      return model::lone_parameter(*m.model, particle.mass) == parameter.first;
    });
    const bool by_scene = set != scene.parameters.end() && !cln::plusp(values[set->first]);
    throw Error("scene", m.model->where(by_scene ? m.model->arena[set->second].span : particle.span),
                fmt::format("{} is {} here", what, cln::double_approx(mass->front())), "a mass is greater than 0");
  }
}

void require_friction_coefficients(const Mechanics& m, const std::vector<cln::cl_R>& values,
                                   const model::Scene& scene) {
  for (const mechanics::Contact& contact : m.contacts) {
    if (contact.dimensions() == 0) continue;
    const std::vector<Ref> both{contact.width ? contact.dynamic_coefficient : contact.static_coefficient,
                                contact.dynamic_coefficient};
    const std::string what = fmt::format("a coefficient of friction of '{}'", contact.name);
    const auto mu = known_values(m, both, values, what, scene.span);
    if (!mu) continue;
    const bool negative = cln::minusp((*mu)[0]) || cln::minusp((*mu)[1]);
    if (!negative && (*mu)[0] >= (*mu)[1]) continue;
    throw Error("scene", m.model->where(scene.span),
                negative ? fmt::format("{} is negative here", what)
                         : fmt::format("the static coefficient of friction of '{}' is less than the dynamic one here",
                                       contact.name),
                negative ? "friction opposes slip: give coefficients of 0 or more" : "give static >= dynamic");
  }
}

std::vector<cln::cl_R> exact_parameters(Mechanics& m, const model::Scene& scene, const Overrides& overrides,
                                        int wanted_digits, std::optional<std::uint64_t> moved) {
  std::vector<Ref> formula = parameter_formulas(m, scene, overrides);
  for (std::uint32_t i = 0; moved && i < formula.size(); ++i) {
    if (!m.dag->is_constant(formula[i])) continue;
    const Rational factor = 1 + (symbolic::sample({SymbolKind::parameter, i, 0}, *moved) - Rational(7) / 10) / 10;
    formula[i] = m.dag->constant(m.dag->value(formula[i]) * factor);
  }
  return parameter_values(m, formula, wanted_digits);
}

std::vector<std::string> independent_parameters(Mechanics& m, const model::Scene& scene, const Overrides& overrides) {
  const std::vector<Ref> formulas = parameter_formulas(m, scene, overrides);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    const model::Parameter& parameter = m.model->parameters[i];
    if (!parameter.initial_value_of && m.dag->is_constant(formulas[i])) names.push_back(parameter.name);
  }
  return names;
}

}  // namespace eomgen::run
