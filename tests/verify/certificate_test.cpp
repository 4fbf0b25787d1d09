// SPDX-License-Identifier: GPL-3.0-or-later
// Correct equations pass with nearly all digits; wrong ones fail, and the certificate names them.
#include "verify/certificate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "support/folders.hpp"
#include "symbolic/evaluate.hpp"
#include "verify/sample_models.hpp"

using namespace eomgen;
using namespace eomgen::verify;
using namespace eomgen::verify::test;
using symbolic::Ref;
using symbolic::SymbolKind;
using system::EquationSystem;

namespace {

const Comparison& find(const Certificate& c, const std::string& a, const std::string& b) {
  for (const Comparison& row : c.comparisons)
    if (row.a == a && row.b == b) return row;
  throw std::logic_error("no comparison of " + a + " with " + b);
}

/// The certificate of `model` with a fault in one formulation.
Certificate with_fault(const model::Model& model, const std::string& formulation, system::Approach approach,
                       const std::function<void(symbolic::Dag&, EquationSystem&)>& fault) {
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  Subjects subjects;
  subjects.systems = all_formulations(m);
  const auto chosen = std::find_if(subjects.systems.begin(), subjects.systems.end(), [&](const EquationSystem& s) {
    return s.formulation == formulation && s.approach == approach;
  });
  REQUIRE(chosen != subjects.systems.end());
  fault(*m.dag, *chosen);
  return certify(m, subjects, {50, 3, 1});
}

void check_only_failing(const Certificate& c, const std::string& culprit) {
  CHECK(std::string(c.verdict()) == "fail");
  bool named = false;
  for (const Comparison& row : c.comparisons) {
    const bool concerns = row.a.find(culprit) != std::string::npos || row.b.find(culprit) != std::string::npos;
    CAPTURE(row.a);
    CAPTURE(row.b);
    if (!row.pass) CHECK(concerns);
    named = named || (!row.pass && row.b == "d'Alembert");
  }
  CHECK(named);
  CHECK(c.summary().find("fail: ") == 0);
  CHECK(c.summary().find(culprit) != std::string::npos);
}

}  // namespace

TEST_CASE("certificate: P7 by every formulation and both approaches agrees with the oracle to 45 digits at 20 states") {
  const model::Model model = moving_sphere();
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const Certificate c = verify::verify(m, {50, 20, 1});
  CHECK(c.points == 20);
  CHECK(c.pass);
  for (const char* formulation : {"lagrange I", "lagrange II", "jacobian I", "jacobian II"}) {
    const Comparison& row = find(c, formulation, "d'Alembert");
    CHECK(!row.shares_code);
    CHECK(row.digits_agreed >= 45);
    CHECK(row.max_relative_difference < 1e-45);
  }
  CHECK(find(c, "lagrange I", "jacobian II").shares_code);
  CHECK(c.summary().find("pass: 20 points, 50 digits, worst ") == 0);
}

TEST_CASE("certificate: multipliers, energies, chains, springs and dampers pass, at 30 and at 100 digits") {
  for (const model::Model& model : {rod_pendulum(), cart_pendulum(), chain(3)})
    for (const int digits : {30, 100}) {
      CAPTURE(model.id);
      mechanics::Mechanics m = mechanics::build_mechanics(model);
      const Certificate c = verify::verify(m, {digits, 4, 2});
      for (const Comparison& row : c.comparisons) {
        CAPTURE(row.a);
        CAPTURE(row.b);
        CAPTURE(row.max_relative_difference);
        CHECK(row.pass);
        CHECK(row.digits_agreed >= digits - 5);
      }
    }
}

TEST_CASE("certificate: if all terms cancel, rounding errors do not count as a difference") {
  model::Model free;  // no force at all: the acceleration is 0 by cancellation
  const ModelFormula mass = parameter(free, "m", 1);
  const ModelFormula R = coordinate(free, "R"), phi = coordinate(free, "phi"), theta = coordinate(free, "theta");
  free.coordinates[0].lower = free.coordinates[1].lower = number(free, 0).id;
  free.coordinates[1].upper = leaf(free, Op::pi, 0).id;
  place(free, "P", spherical(R, phi, theta), mass);
  default_scene(free);
  mechanics::Mechanics m = mechanics::build_mechanics(free);
  const Certificate c = verify::verify(m, {50, 20, 1});
  CHECK(c.pass);
  for (const Comparison& row : c.comparisons) {
    CAPTURE(row.a);
    CAPTURE(row.b);
    CHECK(row.digits_agreed >= 45);
  }
}

TEST_CASE("certificate: a wrong sign in f fails and is named") {
  const auto turn = [](symbolic::Dag& dag, EquationSystem& s) { s.f[0] = dag.neg(s.f[0]); };
  check_only_failing(with_fault(moving_sphere(), "lagrange", system::Approach::two, turn), "lagrange II");
  check_only_failing(with_fault(chain(2), "jacobian", system::Approach::one, turn), "jacobian I");
}

TEST_CASE("certificate: a missing Christoffel term fails and is named") {
  // the centrifugal R^2 sin(phi) cos(phi) theta_dot^2 of phi's equation: f loses the term quadratic in theta_dot
  const auto drop = [](symbolic::Dag& dag, EquationSystem& s) {
    symbolic::Substitution at_rest(dag, {{{SymbolKind::coordinate, 2, 1}, dag.zero()}});
    s.f[0] = at_rest(s.f[0]);
  };
  check_only_failing(with_fault(moving_sphere(), "jacobian", system::Approach::two, drop), "jacobian II");
}

TEST_CASE("certificate: a missing force fails and is named") {
  const auto drop_damping = [](symbolic::Dag& dag, EquationSystem& s) {  // damping: c -> 0
    symbolic::Substitution undamped(dag, {{{SymbolKind::parameter, 4, 0}, dag.zero()}});
    for (Ref& f : s.f) f = undamped(f);
  };
  check_only_failing(with_fault(cart_pendulum(), "lagrange", system::Approach::one, drop_damping), "lagrange I");
}

TEST_CASE("certificate: reactions of the wrong sign fail, eliminated or with a multiplier") {
  const auto turn = [](symbolic::Dag& dag, EquationSystem& s) { s.reactions[0].value = dag.neg(s.reactions[0].value); };
  check_only_failing(with_fault(moving_sphere(), "lagrange", system::Approach::one, turn), "lagrange I");
  check_only_failing(with_fault(rod_pendulum(), "jacobian", system::Approach::two, turn), "jacobian II");
}

TEST_CASE("certificate: a wrong entry of M, A, b or gamma fails and is named") {
  const auto culprit = std::string("lagrange II");
  const auto lagrange_two = [](auto fault) {
    return with_fault(rod_pendulum(), "lagrange", system::Approach::two, fault);
  };
  check_only_failing(
      lagrange_two([](symbolic::Dag& dag, EquationSystem& s) { s.M[0] = dag.mul(dag.integer(2), s.M[0]); }), culprit);
  check_only_failing(lagrange_two([](symbolic::Dag& dag, EquationSystem& s) { s.A[1] = dag.neg(s.A[1]); }), culprit);
  check_only_failing(lagrange_two([](symbolic::Dag& dag, EquationSystem& s) { s.b[0] = dag.one(); }), culprit);
  check_only_failing(lagrange_two([](symbolic::Dag& dag, EquationSystem& s) { s.gamma[0] = dag.neg(s.gamma[0]); }),
                     culprit);
}

TEST_CASE("certificate: wrong energies, power and outputs fail and are named") {
  const auto lagrange_one = [](auto fault) {
    return with_fault(moving_sphere(), "lagrange", system::Approach::one, fault);
  };
  const auto half = [](symbolic::Dag& dag, Ref& r) { r = dag.div(r, dag.integer(2)); };
  check_only_failing(lagrange_one([&](symbolic::Dag& dag, EquationSystem& s) { half(dag, s.energy); }), "lagrange I");
  check_only_failing(lagrange_one([&](symbolic::Dag& dag, EquationSystem& s) { half(dag, s.potential); }),
                     "lagrange I");
  check_only_failing(lagrange_one([&](symbolic::Dag& dag, EquationSystem& s) { half(dag, s.power); }), "lagrange I");
  check_only_failing(lagrange_one([&](symbolic::Dag& dag, EquationSystem& s) {
                       for (system::Output& o : s.outputs)
                         if (o.name == "R_dot") half(dag, o.value);
                     }),
                     "lagrange I");
}

namespace {

const Certificate& certificate_with(Certificate& keep, const model::Model& model, double error) {
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  Subjects subjects;
  subjects.systems = all_formulations(m);
  // phi_ddot = theta_dot^2 sin cos + g/d sin - 2 d_dot/d phi_dot; theta_ddot = D/(m sin) - 2 (d_dot/d + phi_dot cot)
  // theta_dot
  const auto by_hand = [](auto t, const auto& x, const auto& p, const auto& sine, const auto& cosine, auto off) {
    using Number = std::decay_t<decltype(t)>;
    const Number d = p[3] + p[4] * sine(p[5] * t), ddot = p[4] * p[5] * cosine(p[5] * t);
    const Number s = sine(x[0]), c = cosine(x[0]);
    return std::vector<Number>{x[2], x[3], x[3] * x[3] * s * c + p[1] / d * s - 2 * ddot / d * x[2],
                               p[2] / (p[0] * s) - 2 * (ddot / d + x[2] * c / s) * x[3] + off};
  };
  subjects.compiled.push_back(
      {"emitted code", [=](double t, const auto& x, const auto& p, const auto&, const auto&) {
         return std::optional(by_hand(
             t, x, p, [](double a) { return std::sin(a); }, [](double a) { return std::cos(a); }, error));
       }});
  subjects.programs.push_back({"program", [=](const Real& t, const auto& x, const auto& p, const auto&, const auto&) {
                                 const Real off = cln::rational(
                                     Real(error));  // exact: a binary64 would reduce the precision of the sum
                                 return by_hand(
                                     t, x, p, [](const Real& a) { return Real(cln::sin(a)); },
                                     [](const Real& a) { return Real(cln::cos(a)); }, off);
                               }});
  symbolic::Dag& dag = *m.dag;
  std::vector<Ref> residuals;  // M qddot - f, correct or wrong, as a display form
  const EquationSystem& s = subjects.systems.back();
  for (std::size_t i = 0; i < s.free.size(); ++i) {
    Ref sum = dag.neg(s.f[i]);
    for (std::size_t k = 0; k < s.free.size(); ++k)
      sum = dag.add(sum, dag.mul(s.M[i * s.free.size() + k], m.qddot[s.free[k]]));
    residuals.push_back(error == 0 ? sum : dag.add(sum, dag.constant(cln::rational(Real(error)))));
  }
  subjects.reading.push_back({"display form II", residuals});
  subjects.reading.push_back({"half a display form", {residuals.front()}});  // without an equation for theta
  return keep = certify(m, subjects, {50, 5, 1});
}

}  // namespace

TEST_CASE("certificate: program, compiled code and display form match the first formulation and the oracle") {
  const model::Model model = moving_sphere();
  Certificate good, bad;
  certificate_with(good, model, 0);
  CHECK(!find(good, "half a display form", "d'Alembert").pass);
  for (const Comparison& row : good.comparisons)
    if (row.a != "half a display form") CHECK(row.pass);
  CHECK(find(good, "program", "lagrange I").max_relative_difference < 1e-45);
  CHECK(find(good, "emitted code", "lagrange I").max_relative_difference > 0);
  CHECK(find(good, "emitted code", "lagrange I").max_relative_difference < 1e-14);
  CHECK(find(good, "display form II", "d'Alembert").digits_agreed >= 45);
  certificate_with(bad, model, 1e-9);
  CHECK(!bad.pass);
  for (const char* name : {"program", "emitted code"}) CHECK(!find(bad, name, "lagrange I").pass);
  CHECK(!find(bad, "display form II", "d'Alembert").pass);
}

TEST_CASE("certificate: code that reports undecided friction at every state fails") {
  const model::Model model = model::read_model(eomgen::test::source_folder() + "/models/rough_incline_puck.toml");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  Subjects subjects;
  subjects.systems = all_formulations(m);
  const std::string first =
      subjects.systems.front().formulation + " " + system::name(subjects.systems.front().approach);
  CHECK(certify(m, subjects, {50, 3, 1}).pass);
  subjects.programs.push_back(
      {"program", [](const Real&, const std::vector<Real>&, const std::vector<Real>&, const std::vector<Real>&,
                     const std::vector<int>&) { return std::vector<Real>{}; }});
  const Certificate found = certify(m, subjects, {50, 3, 1});
  CHECK_FALSE(found.pass);
  CHECK_FALSE(find(found, "program", first).pass);
}

TEST_CASE("certificate: 301 digits are rejected, as binary64 cannot hold such differences; 300 are accepted") {
  const model::Model model = chain(1);
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  CHECK_THROWS_AS(verify::verify(m, {301, 1, 1}), Error);
  CHECK_THROWS_AS(verify::verify(m, {9, 1, 1}), Error);
  CHECK(verify::verify(m, {300, 1, 1}).pass);
}

TEST_CASE("certificate: the same seed gives the same certificate") {
  const model::Model model = moving_sphere();
  const auto differences = [&](std::uint64_t seed) {
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    std::vector<double> values;
    for (const Comparison& row : verify::verify(m, {50, 3, seed}).comparisons)
      values.push_back(row.max_relative_difference);
    return values;
  };
  CHECK(differences(1) == differences(1));
  CHECK(differences(1) != differences(2));
}
