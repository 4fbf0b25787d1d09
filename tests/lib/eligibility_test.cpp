// Requirements of all registered methods. Each one integrates the smallest system that meets them. It refuses, with the
// reason, a system that lacks a part and one with an unsupported feature.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "eom/ensemble/integrate.hpp"
#include "eom/modes/machine.hpp"
#include "lib/compiled.hpp"

namespace {

using eom::Feature;
using eom::Features;
using Reason = eom::Eligibility::Reason;

/// The features that a method may require.
constexpr Feature parts[] = {Feature::series, Feature::momenta, Feature::constraints};

template <unsigned Parts>
concept Series = (Parts & 1U) != 0;
template <unsigned Parts>
concept Momenta = (Parts & 2U) != 0;
template <unsigned Parts>
concept Constraints = (Parts & 4U) != 0;

/// x'' = -x in the plane, constrained to y = 0, with a subset of the optional functions.
template <unsigned Parts>
struct Slider {
  Features further = {};
  Features features() const { return further; }
  int operator()(double, const double* x, double* dx) const {
    dx[0] = x[2], dx[1] = x[3], dx[2] = -x[0], dx[3] = 0;
    return 0;
  }
  int taylor_order() const { return 30; }
  std::size_t taylor_states() const { return 4; }
  int taylor(double, const double* x, int order, double* c) const requires Series<Parts> {
    for (int i = 0; i < 4; ++i) c[i] = x[i];
    for (int k = 0; k < order; ++k) {
      (*this)(0, c + 4 * k, c + 4 * (k + 1));
      for (int i = 0; i < 4; ++i) c[4 * (k + 1) + i] /= k + 1;
    }
    return 0;
  }
  std::size_t coordinates() const { return 2; }
  int mass(double, const double*, double* M) const {
    M[0] = M[3] = 1, M[1] = M[2] = 0;
    return 0;
  }
  int momenta(double, const double* x, double* p, double* rate) const requires Momenta<Parts> {
    p[0] = x[2], p[1] = x[3], rate[0] = -x[0], rate[1] = 0;
    return 0;
  }
  std::size_t constraints() const { return 1; }
  int constrain(double, const double* x, double* psi, double* A, double* b) const requires Constraints<Parts> {
    psi[0] = x[1], A[0] = 0, A[1] = 1, b[0] = 0;
    return 0;
  }
};

const std::vector<double> start{1, 0, 0, 0};

template <unsigned Parts>
double end_of(const eom::MethodInfo& method, Features further) {
  eom::Options options;
  if (!method.adaptive) options.fixed_step = 1e-3;
  Slider<Parts> slider{further};
  const eom::Result result = eom::integrate(method.name, eom::system_of(slider), 0, start, 1, options);
  CHECK(result.outcome == eom::Outcome::done);
  return result.x[0];
}

/// x(1) of an oscillator with exactly these functions.
double slide(const eom::MethodInfo& method, Features features, Features further = {}) {
  unsigned chosen = 0;
  for (unsigned k = 0; k < std::size(parts); ++k) chosen |= features.has(parts[k]) ? 1U << k : 0U;
  static constexpr auto table = []<unsigned... P>(std::integer_sequence<unsigned, P...>) {
    return std::array{&end_of<P>...};
  }
  (std::make_integer_sequence<unsigned, 8>{});
  return table[chosen](method, further);
}

std::string refusal(const eom::MethodInfo& method, Features features, Features further = {}) {
  try {
    slide(method, features, further);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("eligibility: every method integrates a system with exactly its requirements") {
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    CHECK(eom::eligible(method, method.needs.required));
    CHECK(std::abs(slide(method, method.needs.required) - std::cos(1.0)) < 1e-6);
  }
}

TEST_CASE("eligibility: every method refuses a system without one of its requirements, and names it") {
  std::size_t refused = 0;
  for (const eom::MethodInfo& method : eom::methods()) {
    for (const Feature part : parts) {
      CAPTURE(std::string(method.name));
      CAPTURE(std::string(eom::name(part)));
      const Features others = Features{Feature::series, Feature::momenta, Feature::constraints}.set(part, false);
      const eom::Eligibility found = eom::eligible(method, others);
      const std::string reason = refusal(method, others);
      CHECK(static_cast<bool>(found) == !method.needs.required.has(part));
      CHECK(reason.empty() == static_cast<bool>(found));
      if (found) continue;
      ++refused;
      CHECK(found.reason == Reason::missing);
      CHECK(found.feature == part);
      CHECK(says(reason, std::string(method.name) + " needs a right-hand side with " + eom::name(part)));
    }
  }
  CHECK(refused == 5);  // ggl, taylor, and three variational ones
}

TEST_CASE("eligibility: every method refuses a system with a feature on its list of refusals, with the reason") {
  for (const eom::MethodInfo& method : eom::methods()) {
    for (const Feature feature : eom::all_features) {
      const eom::Refusal* const expected = method.needs.refusal(feature);
      CAPTURE(std::string(method.name));
      CAPTURE(std::string(eom::name(feature)));
      const Features required = method.needs.required;
      const eom::Eligibility found = eom::eligible(method, required.set(feature));
      CHECK(static_cast<bool>(found) == (expected == nullptr));
      if (expected == nullptr) continue;
      CHECK(found.reason == Reason::refused);
      CHECK(found.feature == feature);
      CHECK(std::string(found.why) == expected->why);
      CHECK(!std::string(expected->why).empty());
      const std::string reason = refusal(method, required, {feature});
      CHECK(says(reason, std::string(method.name) + " takes no right-hand side with " + eom::name(feature)));
      CHECK(says(reason, expected->why));
    }
  }
}

TEST_CASE("eligibility: the features of a right-hand side follow from its members and its state") {
  Slider<0> plain;
  CHECK(eom::system_of(plain).features(4) == Features{});
  Slider<7> full{{Feature::kinks}};
  CHECK(eom::system_of(full).features(4) ==
        Features{Feature::series, Feature::momenta, Feature::constraints, Feature::kinks});
  CHECK(eom::system_of(full).features(5).has(Feature::other_states));
  eom::System system = eom::system_of(full);
  system.position_constraints = 0;
  CHECK(system.features(4).has(Feature::velocity_constraints));
  system.constraints = 0;
  CHECK(!system.features(4).has(Feature::constraints));
  eom::WithJacobian with{plain, [](double, const double*, double*, double*) { return 0; }};
  CHECK(eom::system_of(with).features(4) == Features{Feature::jacobian});
}

TEST_CASE("eligibility: methods with a fixed set of constraints refuse a system with modes") {
  const auto rhs = [](double, const double* x, int, double* dx) { return dx[0] = -x[0], 0; };
  const auto events = [](double, const double*, int, double*) { return 0; };
  const auto rule = [](const eom::ModePoint& point) { return eom::Transition{point.mode}; };
  const std::vector<eom::Mode> table{{"only", {}}};
  const std::vector<double> x{1};
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    eom::Options options;
    if (!method.adaptive) options.fixed_step = 1e-3;
    const auto run = [&] {
      return eom::integrate_modes(method.name, rhs, 0, x, 0, 1, options, events, 0, table, rule).x[0];
    };
    if (method.needs.required.none())
      CHECK(std::abs(run() - std::exp(-1.0)) < 1e-6);
    else
      CHECK_THROWS_WITH_AS(run(),
                           doctest::Contains(method.needs.refusal(Feature::modes) != nullptr ? "with modes" : "with a"),
                           std::invalid_argument);
  }
}

TEST_CASE("registry: names are unique and found; ensembles accept the methods that declare it") {
  std::set<std::string> names{eom::Automatic::name};
  std::string all = eom::Automatic::name;
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    CHECK(names.insert(method.name).second);
    all += std::string(", ") + method.name;
    CHECK(eom::find_method(method.name) == &method);
    CHECK(method.order >= 1);
    CHECK(method.dense_order >= 1);
    const auto rhs = [](std::size_t count, std::size_t, const double*, const double* y, const double*, double* dx,
                        int* codes) {
      for (std::size_t s = 0; s < count; ++s) dx[s] = -y[s], codes[s] = 0;
      return 0;
    };
    eom::EnsembleOptions options;
    if (!method.adaptive) options.fixed_step = 1e-3;
    double end = 0;
    const auto run = [&] {
      eom::integrate_ensemble(
          method.name, rhs, 1, 1, 0, options, [](std::size_t, eom::EnsembleStart& s) { s.x[0] = 1, s.t1 = 1; },
          [&](const eom::EnsembleEnd& e) { end = e.x[0]; });
    };
    if (method.ensemble) {
      run();
      CHECK(std::abs(end - std::exp(-1.0)) < 1e-6);
    } else {
      CHECK_THROWS_AS(run(), std::invalid_argument);
    }
  }
  CHECK(std::string(eom::find_method("auto")->name) == "auto");
  CHECK(eom::find_method("no such method") == nullptr);
  CHECK_THROWS_WITH_AS(eom::integrate("no such method", Slider<0>{}, 0, start, 1),
                       doctest::Contains(("there are " + all).c_str()), std::invalid_argument);
}
