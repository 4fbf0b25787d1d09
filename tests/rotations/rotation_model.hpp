// SPDX-License-Identifier: GPL-3.0-or-later
// A model with bodies, evaluated in 60 digits: axes and angular velocities by names of definitions.
#pragma once

#include <cln/rational.h>
#include <cln/real.h>
#include <doctest/doctest.h>

#include <array>
#include <map>
#include <string>

#include "mechanics/mechanics.hpp"
#include "rotations/rotation.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::test {

using Real = cln::cl_R;
using Numbers = std::array<Real, 3>;

inline Real ratio(long a, long b = 1) { return Real(cln::cl_RA(a) / b); }
inline Real dot(const Numbers& a, const Numbers& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Numbers cross(const Numbers& a, const Numbers& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double size(const Real& x) { return cln::double_approx(cln::abs(x)); }
inline double distance(const Numbers& a, const Numbers& b) {
  return size(a[0] - b[0]) + size(a[1] - b[1]) + size(a[2] - b[2]);
}

constexpr int digits = 60;
constexpr double exact = 1e-50;       // some hundred operations in 60 digits
constexpr double difference = 1e-35;  // of central differences with steps of 1e-20

/// The rotation of a registry entry in the syntax of a model file, with coordinates named like the entries plus a
/// suffix.
inline std::string rotation_toml(const rotations::Rotation& r, const std::string& suffix = "") {
  std::string names;
  for (const rotations::Entry& entry : r.entries) names += (names.empty() ? "\"" : ", \"") + entry.name + suffix + "\"";
  if (r.family == "euler") return "{ euler = \"" + r.name + "\", angles = [" + names + "] }";
  if (r.family == "axis") return "{ axis = \"E1 + 2*E2 - 2*E3\", angle = " + names + " }";
  if (r.family == "fixed") return "{ fixed = true }";
  return "{ " + r.family + " = [" + names + "] }";
}

inline std::string body(const std::string& name, const std::string& rotation, const std::string& more = "") {
  return "[[body]]\nname = \"" + name +
         "\"\nmass = 1\ninertia = { principal = [1, 1, 1] }\nposition = { cartesian = [\"x" + name + "\", \"y" + name +
         "\", \"z" + name + "\"] }\nrotation = " + rotation + "\n" + more;
}

class RotationModel {
 public:
  explicit RotationModel(const std::string& text)
      : model_(model::read_model_text("format = 1\n" + text, "turning.toml")), m_(mechanics::build_mechanics(model_)) {}

  /// Values of coordinates (order 0) and rates (order 1) by name; everything else is 0.
  std::map<std::pair<std::string, int>, Real> at;

  Real scalar(const std::string& definition) { return value({m_.scalar_definition[index(definition)]})[0]; }
  Numbers vector(const std::string& definition) {
    return numbers(mechanics::lower_vector(m_, model_.definitions[index(definition)].expression));
  }
  Numbers angular_velocity(std::size_t frame) { return numbers(m_.angular_velocity[frame]); }
  /// The vector at q + h qdot.
  Numbers later(const std::string& definition, const Real& h) {
    const auto here = at;
    for (const auto& [key, x] : here) {
      if (key.second == 1) at[{key.first, 0}] = here.at({key.first, 0}) + h * x;
    }
    const Numbers result = vector(definition);
    at = here;
    return result;
  }
  /// Its rate by a central difference.
  Numbers rate(const std::string& definition) {
    const Real h = cln::expt(ratio(1, 10), 20);
    const Numbers a = later(definition, -h), b = later(definition, h);
    return {(b[0] - a[0]) / (2 * h), (b[1] - a[1]) / (2 * h), (b[2] - a[2]) / (2 * h)};
  }
  /// The axial vector of Qdot Q^T from axes NAME1, NAME2, NAME3.
  Numbers axial_vector(const std::string& name) {
    Numbers sum{0, 0, 0};
    for (const char* k : {"1", "2", "3"}) {
      const Numbers part = cross(vector(name + k), rate(name + k));
      for (std::size_t c = 0; c < 3; ++c) sum[c] = sum[c] + part[c] / 2;
    }
    return sum;
  }
  model::Model& model() { return model_; }

 private:
  std::size_t index(const std::string& definition) {
    for (std::size_t k = 0; k < model_.definitions.size(); ++k) {
      if (model_.definitions[k].name == definition) return k;
    }
    FAIL("no definition ", definition);
    return 0;
  }
  std::vector<Real> value(const std::vector<symbolic::Ref>& roots) {
    return symbolic::evaluate(
        *m_.dag, roots,
        [this](const symbolic::Symbol& s) -> Real {
          if (s.kind != symbolic::SymbolKind::coordinate) return ratio(1, 3);
          const auto found = at.find({model_.coordinates[s.index].name, s.order});
          return found == at.end() ? Real(0) : found->second;
        },
        digits);
  }
  Numbers numbers(const std::array<symbolic::Ref, 3>& v) {
    const std::vector<Real> x = value({v[0], v[1], v[2]});
    return {x[0], x[1], x[2]};
  }

  model::Model model_;
  mechanics::Mechanics m_;
};

}  // namespace eomgen::test
