// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "forces/kind.hpp"
#include "stress/stress.hpp"

namespace eomgen::stress {
namespace {

using Exponents = std::array<int, 3>;  // of m, kg, s; rad is 1
constexpr Exponents mass{0, 1, 0}, inertia{2, 1, 0}, stiffness{0, 1, -2}, torsion{2, 1, -2}, damping{0, 1, -1};

constexpr double least = 1e-300;  // the smallest number that a file may contain
constexpr double denormal = 1e-310;

class Cases {
 public:
  Cases(const mechanics::Mechanics& m, const run::Scene& scene, bool quick) : m_(m), scene_(scene), quick_(quick) {}

  std::vector<Case> all() {
    result_.push_back({.name = "as it is"});
    parameters();
    for (const double factor : chosen({10, 1e3, 1e6}, {1e3})) speeds(factor);
    charts();
    for (const double rtol : chosen({1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15}, {1e-3, 1e-12})) {
      result_.push_back({.name = fmt::format("rtol {:g}", rtol), .rtol = rtol});
    }
    for (const double part : chosen({0.5, 0.9, 1.1}, {0.9, 1.1}))
      result_.push_back({.name = fmt::format("{:g} of the stable step", part), .stability_fraction = part});
    for (const double span : chosen({0.1, 10, 100, 1000}, {10}))
      result_.push_back({.name = fmt::format("span x {:g}", span), .span_factor = span});
    if (std::any_of(scene_.qdot.begin(), scene_.qdot.end(), [](double v) { return v != 0; })) slow();
    zeros();
    return std::move(result_);
  }

 private:
  std::vector<double> chosen(std::vector<double> all, std::vector<double> few) const {
    return quick_ ? std::move(few) : std::move(all);
  }

  bool is_independent(std::uint32_t p) const {
    return m_.dag->is_constant(m_.parameter_value[p]) && !m_.model->parameters[p].initial_value_of;
  }

  void parameters() {
    for (std::uint32_t p = 0; p < m_.model->parameters.size(); ++p) {
      if (!is_independent(p) || scene_.parameters[p] == 0) continue;
      const model::Parameter& parameter = m_.model->parameters[p];
      if (is(parameter, stiffness) || is(parameter, torsion) || is_stiffness(p)) {
        for (const double factor : chosen({1e-3, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12}, {1e4, 1e10})) scaled(p, factor);
      } else if (is(parameter, damping)) {
        for (const double factor : chosen({1e3, 1e6, 1e9}, {1e6})) scaled(p, factor);
      } else if (is(parameter, mass) || is(parameter, inertia)) {
        for (const double factor : chosen({1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9}, {1e-6, 1e6})) scaled(p, factor);
      }
      if (!parameter.used) continue;
      if (!quick_) result_.push_back({.name = fmt::format("{} = {:g}", parameter.name, least), .value = {{p, least}}});
      const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
      for (const double value : chosen({nan, infinite, -infinite}, {nan})) {
        result_.push_back(
            {.name = fmt::format("{} = {}", parameter.name, value), .value = {{p, value}}, .has_no_motion = true});
      }
    }
  }

  void scaled(std::uint32_t p, double factor) {
    result_.push_back(
        {.name = fmt::format("{} x {:g}", m_.model->parameters[p].name, factor), .factor = {{p, factor}}});
  }

  static bool is(const model::Parameter& parameter, const Exponents& of) {
    if (!parameter.unit.dimension) return false;
    const auto& e = parameter.unit.dimension->exponents;
    for (std::size_t k = 3; k < e.size(); ++k) {
      if (!cln::zerop(e[k])) return false;
    }
    return e[0] == of[0] && e[1] == of[1] && e[2] == of[2];
  }

  // Whether it is the stiffness of a spring, for parameters without known units.
  bool is_stiffness(std::uint32_t p) const {
    for (const model::Force& force : m_.model->forces) {
      for (const forces::Key& key : forces::find(force.kind)->keys) {
        if (!key.is_stiffness) continue;
        const bool triple = key.type == forces::ValueType::triple;
        for (const char* component : {"", "1", "2", "3"}) {
          if (triple != (*component == 0) && mentions(force.value(key.name + component), p)) return true;
        }
      }
    }
    return false;
  }

  bool mentions(model::NodeId node, std::uint32_t p) const {
    if (node == model::no_node) return false;
    const model::Node& n = m_.model->arena[node];
    if (n.op == model::Op::parameter) return n.index == p;
    return std::any_of(n.args.begin(), n.args.end(), [&](model::NodeId child) { return mentions(child, p); });
  }

  void speeds(double factor) {
    if (std::all_of(scene_.qdot.begin(), scene_.qdot.end(), [](double v) { return v == 0; })) return;
    result_.push_back({.name = fmt::format("speed x {:g}", factor), .speed_factor = factor});
  }

  // Starts with zero or very small slip.
  void slow() {
    result_.push_back({.name = "from rest", .speed_factor = 0});
    if (m_.contacts.empty()) return;
    for (const double factor : chosen({1e-3, 1e-6, 1e-9, 1e-12, 1e-15}, {1e-9})) speeds(factor);
  }

  void zeros() {
    bool any = false;
    for (const std::uint32_t i : m_.free) any = any || scene_.q[i] == 0 || scene_.qdot[i] == 0;
    if (any)
      result_.push_back({.name = fmt::format("zeros of the start {:g}", denormal), .zero_replacement = denormal});
  }

  void charts() {
    for (const std::uint32_t i : m_.free) {
      for (const bool upper : {false, true}) {
        const double bound = upper ? scene_.upper[i] : scene_.lower[i];
        if (!std::isfinite(bound)) continue;
        for (const double distance : chosen({1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15}, {1e-3, 1e-9})) {
          near(i, bound, upper ? -distance : distance);
        }
      }
    }
    for (const model::Frame& frame : m_.model->frames) {  // the second angle, at 0 or a quarter turn
      if (frame.singularity == model::no_node || frame.entries.size() != 3) continue;
      const model::Node& node = m_.model->arena[frame.entries[1]];
      if (node.op != model::Op::coordinate || m_.is_eliminated(node.index)) continue;
      const double bound = frame.rotation.front() == frame.rotation.back() ? 0 : std::acos(0.0);
      for (const double distance : chosen({1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15}, {1e-3, 1e-9}))
        near(node.index, bound, distance);
    }
  }

  void near(std::uint32_t i, double bound, double offset) {
    result_.push_back({.name = fmt::format("{} at {:g} {} {:g}", m_.model->coordinates[i].name, bound,
                                           offset < 0 ? '-' : '+', std::abs(offset)),
                       .start = {{i, bound + offset}},
                       .singularity_distance = std::abs(offset)});
  }

  const mechanics::Mechanics& m_;
  const run::Scene& scene_;
  bool quick_;
  std::vector<Case> result_;
};

}  // namespace

std::vector<Case> make_cases(const mechanics::Mechanics& mechanics, const run::Scene& scene, bool quick) {
  return Cases(mechanics, scene, quick).all();
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::reported: return "reported";
    case Verdict::undetected: break;
  }
  return "undetected";
}

}  // namespace eomgen::stress
