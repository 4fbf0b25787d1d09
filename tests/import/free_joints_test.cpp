// SPDX-License-Identifier: GPL-3.0-or-later
// Damping and armature of ball and free joints of MJCF files against the balance of moments, written by hand for bodies
// whose centres do not move and whose inertia is the same about every axis.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "import/imported.hpp"

using namespace eomgen;
using import::ImportOptions;
using test::Imported;

namespace {

using Vec = std::array<double, 3>;
Vec plus(const Vec& a, const Vec& b, double s = 1) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
Vec times(double s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }
Vec across(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length_of(const Vec& a) { return std::hypot(a[0], a[1], a[2]); }
Vec about_z(double angle, const Vec& a) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * a[0] - s * a[1], s * a[0] + c * a[1], a[2]};
}
constexpr Vec vertical{0, 0, 1};

/// A rotation by coordinates and their rates: w, and its rate for accelerations of the coordinates.
struct Attitude {
  std::vector<double> q, rates;
  bool is_euler;

  Vec w() const { return is_euler ? by_axes(rates) : by_parameters(rates); }
  Vec w_dot(const std::vector<double>& accelerations) const {
    if (!is_euler) return by_parameters(accelerations);
    const Vec before = times(rates[0], vertical), before_last = plus(before, axis(1), rates[1]);
    return plus(plus(by_axes(accelerations), across(before, axis(1)), rates[1]), across(before_last, axis(2)),
                rates[2]);
  }

 private:
  Vec axis(int k) const {  // of yaw, pitch, roll
    if (k == 0) return vertical;
    return about_z(q[0], k == 1 ? Vec{0, 1, 0} : Vec{std::cos(q[1]), 0, -std::sin(q[1])});
  }
  Vec by_axes(const std::vector<double>& r) const {
    return plus(plus(times(r[0], axis(0)), axis(1), r[1]), axis(2), r[2]);
  }
  Vec by_parameters(const std::vector<double>& r) const {  // w = 2 (e0 e' - e0' e + e x e')
    const Vec e{q[1], q[2], q[3]}, rate{r[1], r[2], r[3]};
    return times(2, plus(plus(times(q[0], rate), e, -r[0]), across(e, rate)));
  }
};

Attitude attitude(import::Attitude kind) {
  if (kind == import::Attitude::euler) return {{0.4, -0.7, 0.3}, {1.1, 0.6, -0.8}, true};
  // Of unit length, with rates across it.
  return {{0.1, 0.5, -0.7, 0.5}, {-0.4, 0.3, 0.5, 0.48}, false};
}

std::vector<ImportOptions> all_options() {
  std::vector<ImportOptions> result;
  for (const import::Attitude kind : {import::Attitude::euler, import::Attitude::euler_parameters})
    for (const bool parameters : {false, true}) {
      result.emplace_back();
      result.back().attitude = kind;
      result.back().parameters = parameters;
    }
  return result;
}

std::string weightless_world(const std::string& bodies) {
  return "<mujoco model=\"m\">\n<option gravity=\"0 0 0\"/>\n<worldbody>\n" + bodies + "</worldbody>\n</mujoco>\n";
}
const std::string losses_text = "damping=\"0.7\" armature=\"0.5\"";
constexpr double damping = 0.7, armature = 0.5;

std::vector<double> joined(std::vector<double> first, const std::vector<double>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

TEST_CASE("MJCF: a ball joint on the ground has its damping and armature about every axis") {
  const std::string file = weightless_world("<body name=\"b\"><joint name=\"j\" type=\"ball\" " + losses_text +
                                            "/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"2 2 2\"/></body>\n");
  for (const ImportOptions& options : all_options()) {
    CAPTURE(options.parameters);
    const Imported imported(file, options);
    const Attitude at = attitude(options.attitude);
    CHECK(imported.model->warnings.empty());
    CHECK(length_of(plus(at.w_dot(imported.accelerations(at.q, at.rates)), at.w(), damping / (2 + armature))) <
          test::rounding);
    CHECK(imported.text.findings.entries().empty());
  }
}

TEST_CASE("MJCF: a free joint has its damping and armature along and about every axis") {
  const std::string file = weightless_world("<body name=\"b\"><joint name=\"j\" type=\"free\" " + losses_text +
                                            "/><inertial pos=\"0 0 0\" mass=\"3\" diaginertia=\"2 2 2\"/></body>\n");
  const std::vector<double> place{0.3, 0.2, -0.1}, velocity{0.9, -1.2, 0.4};
  for (const ImportOptions& options : all_options()) {
    CAPTURE(options.parameters);
    const Imported imported(file, options);
    const Attitude at = attitude(options.attitude);
    const std::vector<double> all = imported.accelerations(joined(place, at.q), joined(velocity, at.rates));
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(all[k] == doctest::Approx(-damping * velocity[k] / (3 + armature)).epsilon(1e-12));
    CHECK(length_of(plus(at.w_dot({all.begin() + 3, all.end()}), at.w(), damping / (2 + armature))) < test::rounding);
  }
}

TEST_CASE("MJCF: damping and armature of a ball joint between two links act on both") {
  // A turns about z with the inertia 3, B about its centre on the axis of A with the inertia 2.
  const std::string file = weightless_world(
      "<body name=\"A\"><joint name=\"h\" axis=\"0 0 1\"/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"3 3 3\"/>\n"
      "<body name=\"B\" pos=\"0 0 1\"><joint name=\"j\" type=\"ball\" " +
      losses_text + "/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"2 2 2\"/></body></body>\n");
  const double angle = 0.6, W = 1.3;
  for (const ImportOptions& options : all_options()) {
    CAPTURE(options.parameters);
    const Imported imported(file, options);
    const Attitude at = attitude(options.attitude);
    const std::vector<double> all = imported.accelerations(joined({angle}, at.q), joined({W}, at.rates));
    const double W_dot = all[0];
    const Vec w = about_z(angle, at.w()), w_B = plus(w, vertical, W);
    const Vec w_dot = plus(about_z(angle, at.w_dot({all.begin() + 1, all.end()})), across(vertical, w), W);
    const Vec w_B_dot = plus(w_dot, vertical, W_dot);
    // The armature times the rate of w along the axes of B is the moment of the armature.
    const Vec moment = plus(times(-damping, w), plus(w_dot, across(w_B, w), -1), -armature);
    CHECK(length_of(plus(times(2, w_B_dot), moment, -1)) < test::rounding);
    CHECK(3 * W_dot == doctest::Approx(-moment[2]).epsilon(1e-12));
  }
}

TEST_CASE("MJCF: springs, friction and ranges of ball joints are reported with their lines") {
  const Imported imported(weightless_world(
      "<body name=\"b\">\n<joint name=\"j\" type=\"ball\" stiffness=\"1\"\nfrictionloss=\"1\"\nrange=\"0 "
      "1\"/>\n<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"2 2 2\"/></body>\n"));
  const std::vector<std::pair<std::string, unsigned>> expected{{"frictionloss of ball and free joints", 6},
                                                               {"stiffness of ball and free joints", 5},
                                                               {"range of ball joints", 7}};
  REQUIRE(imported.text.findings.entries().size() == expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CHECK(imported.text.findings.entries()[k].what == expected[k].first);
    CHECK(imported.text.findings.entries()[k].first.line == expected[k].second);
  }
}
