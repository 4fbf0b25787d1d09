// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/prescribed_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {
namespace {

using symbolic::SymbolKind;

double length(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// The normal force of a contact, from the reactions or as given.
symbolic::Ref squared_normal_force(const system::EquationSystem& s, const system::Contact& contact) {
  symbolic::Dag& dag = *s.dag;
  if (contact.reactions.empty()) return dag.mul(contact.normal, contact.normal);
  symbolic::Ref sum = dag.zero();
  const std::size_t n = contact.reactions.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const symbolic::Ref product =
          dag.mul(s.reactions[contact.reactions[i]].value, s.reactions[contact.reactions[j]].value);
      sum = dag.add(sum, dag.mul(contact.gram[i * n + j], product));
    }
  }
  return sum;
}

}  // namespace

PrescribedFriction::PrescribedFriction(const system::EquationSystem& system, const std::string& file)
    : system_(system) {
  for (const system::Contact& contact : system.contacts) {
    if (contact.unilateral) {
      throw Error("inverse", SourceLocation{file, 0, 0, 1, ""},
                  fmt::format("'{}' can open, though the motion is prescribed as a whole", contact.name),
                  "write holds = \"bilateral\" here: the sign of its reaction shows where it would open");
    }
    count_ = std::max(count_, contact.first + contact.slip.size());
  }
}

/// slip/|slip|, or its limit after this time where slip vanishes; smoothed by the width of a smooth law. Empty at rest.
std::vector<double> PrescribedFriction::direction(const system::Contact& contact, const Lookup& lookup) const {
  std::vector<double> slip = symbolic::evaluate(*system_.dag, contact.slip, lookup);
  double speed = length(slip);
  if (contact.width) {
    speed = std::hypot(speed, symbolic::evaluate(*system_.dag, {*contact.width}, lookup)[0]);
  } else if (speed == 0) {
    slip = symbolic::evaluate(*system_.dag, contact.slip_rate, lookup);
    speed = length(slip);
    if (speed == 0) return {};
  }
  for (double& x : slip) x /= speed;
  return slip;
}

std::optional<PrescribedFriction::Forces> PrescribedFriction::at(const Lookup& lookup) const {
  constexpr int most_iterations = 500;
  constexpr double converged = 4 * std::numeric_limits<double>::epsilon();
  Forces result{std::vector<double>(count_, 0.0), {}};
  std::vector<double>& phi = result.phi;
  const Lookup with_friction = [&](const symbolic::Symbol& s) {
    return s.kind == SymbolKind::friction ? phi.at(s.index) : lookup(s);
  };
  std::vector<std::vector<double>> directions;
  std::vector<symbolic::Ref> strengths;
  for (const system::Contact& contact : system_.contacts) {
    directions.push_back(direction(contact, lookup));
    if (directions.back().empty() && !contact.slip.empty()) {
      result.resting.push_back(contact.name);
      directions.back().assign(contact.slip.size(), 0.0);
    }
    if (contact.slip.empty()) continue;
    strengths.push_back(contact.dynamic_coefficient);
    strengths.push_back(squared_normal_force(system_, contact));
  }
  // The normal forces depend on friction where its directions are not perpendicular to theirs: fixed point.
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const std::vector<double> values = symbolic::evaluate(*system_.dag, strengths, with_friction);
    double change = 0, largest = 0;
    std::vector<double> next(count_, 0.0);
    std::size_t at = 0;
    for (std::size_t j = 0; j < system_.contacts.size(); ++j) {
      const system::Contact& contact = system_.contacts[j];
      if (contact.slip.empty()) continue;
      const double force = values[at] * std::sqrt(values[at + 1]);
      at += 2;
      for (std::size_t a = 0; a < contact.slip.size(); ++a) {
        double& value = next[contact.first + a];
        value = -force * directions[j][a];
        change = std::max(change, std::fabs(value - phi[contact.first + a]));
        largest = std::max(largest, std::fabs(value));
      }
    }
    phi = next;
    if (!std::isfinite(largest)) break;
    if (change <= converged * largest) return result;
  }
  return std::nullopt;
}

}  // namespace eomgen::analysis
