// SPDX-License-Identifier: MIT
// Accelerations for unit forces: forces that change no common acceleration share an evaluation.
#include "eom/contacts/unit_responses.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace eom::contacts;

namespace {

/// Masses in a row with a contact between neighbours; the first one moves with the third. Contact j presses
/// masses j and j + 1 apart.
struct Chain : System {
  explicit Chain(std::size_t count) : n(count) {}
  std::size_t n;
  int evaluations = 0;
  bool is_coupled = true;  // the first mass to the third
  std::size_t version = 0;

  std::size_t coordinates() const override { return n; }
  int accelerations(double, const double* x, const double* u, double* qddot) override {
    ++evaluations;
    for (std::size_t i = 0; i < n; ++i) {
      const double left = i > 0 ? u[i - 1] : 0, right = i + 1 < n ? u[i] : 0;
      qddot[i] = (left - right) / (1 + x[i]) + std::sin(static_cast<double>(i));
    }
    if (is_coupled) qddot[0] += 0.25 * qddot[2];
    bool finite = true;
    for (std::size_t i = 0; i < n; ++i) finite = finite && std::isfinite(qddot[i]);
    return finite ? 0 : 5;
  }
  int rows(double, const double*, const double*, double*) override { return 0; }
  std::size_t equations() override { return version; }
};

Set contacts_of(std::size_t n) {
  Set set;
  for (std::size_t j = 0; j + 1 < n; ++j) {
    Description at;
    at.gap = 0;  // it has a constraint
    at.force_input = j;
    at.normal.columns = {j, j + 1};
    set.contacts.push_back(at);
  }
  return set;
}

}  // namespace

TEST_CASE("unit responses: as few evaluations as the couplings allow, with the bits of single ones") {
  const std::size_t n = 20;
  Chain chain(n);
  const Set set = contacts_of(n);
  std::vector<double> x(2 * n, 0.0), u(n - 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) x[i] = 0.1 * static_cast<double>(i);
  std::vector<Pattern> patterns;
  for (std::size_t j = 0; j + 1 < n; ++j) patterns.push_back({j, -1, {{j, 1.0}}});
  Eigen::VectorXd free(n);
  REQUIRE(chain.accelerations(0, x.data(), u.data(), free.data()) == 0);

  UnitResponses together(set, chain);
  UnitResponses::Groups groups;
  Eigen::MatrixXd all;
  REQUIRE(together.evaluate(0, x.data(), u.data(), free, patterns, groups, all) == 0);
  CHECK(groups.members.size() == 3);  // contacts 0, 1 and 2 all move mass 0
  chain.evaluations = 0;
  REQUIRE(together.evaluate(0, x.data(), u.data(), free, patterns, groups, all) == 0);
  CHECK(chain.evaluations == 3);
  CHECK(groups.changes == 1);
  for (const double force : u) CHECK(force == 0);

  UnitResponses alone(set, chain);
  for (std::size_t j = 0; j + 1 < n; ++j) {
    CAPTURE(j);
    UnitResponses::Groups of_one;
    Eigen::MatrixXd one;
    REQUIRE(alone.evaluate(0, x.data(), u.data(), free, {patterns[j]}, of_one, one) == 0);
    REQUIRE(alone.evaluate(0, x.data(), u.data(), free, {patterns[j]}, of_one, one) == 0);  // with its own amplitude
    CHECK(one.col(0) == all.col(static_cast<Eigen::Index>(j)));
    CHECK(std::abs(one(static_cast<Eigen::Index>(j), 0)) > 0.1);
  }

  // Other equations have other couplings.
  chain.is_coupled = false;
  ++chain.version;
  REQUIRE(chain.accelerations(0, x.data(), u.data(), free.data()) == 0);
  REQUIRE(together.evaluate(0, x.data(), u.data(), free, patterns, groups, all) == 0);
  CHECK(groups.members.size() == 2);
}

TEST_CASE("unit responses: the code of a failing right-hand side is returned") {
  Chain chain(3);
  const Set set = contacts_of(3);
  std::vector<double> x(6, 0.0), u(2, 0.0);
  x[1] = -1;  // a division by zero
  UnitResponses responses(set, chain);
  UnitResponses::Groups groups;
  Eigen::MatrixXd result;
  CHECK(responses.evaluate(0, x.data(), u.data(), Eigen::VectorXd::Ones(3), {{0, -1, {{0, 1.0}}}}, groups, result) ==
        UnitResponses::code_not_finite);
}
