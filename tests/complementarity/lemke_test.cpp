// SPDX-License-Identifier: MIT
// Complementarity problems: known solutions, random ones, degenerate ones, those without a solution.
#include "eom/contacts/lemke.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <random>

#include "eom/contacts/least_norm.hpp"

using eom::contacts::ComplementaritySolution;
using eom::contacts::LeastNormSolver;
using eom::contacts::solve_complementarity;
using eom::contacts::solve_least_norm;

namespace {

/// The largest violation of w = M z + q, w >= 0, w . z = 0, relative to the terms of each row.
double violation(const Eigen::MatrixXd& M, const Eigen::VectorXd& q, const Eigen::VectorXd& z) {
  const Eigen::VectorXd w = M * z + q;
  const Eigen::VectorXd terms = M.cwiseAbs() * z.cwiseAbs() + q.cwiseAbs();
  double largest = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (terms(i) == 0) continue;
    const double size = 1 / terms(i);
    largest = std::max(largest, -w(i) * size);
    if (z(i) > 0) largest = std::max(largest, std::abs(w(i)) * size);
  }
  return largest;
}

Eigen::MatrixXd random_matrix(std::mt19937& generator, Eigen::Index rows, Eigen::Index columns) {
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd result(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index k = 0; k < columns; ++k) result(i, k) = value(generator);
  return result;
}

}  // namespace

TEST_CASE("lemke: the unique solution of a small problem") {
  // w = M z + q with M = [2 1; 1 2], q = (-5, -6): z = (4/3, 7/3), w = 0.
  Eigen::MatrixXd M(2, 2);
  M << 2, 1, 1, 2;
  const ComplementaritySolution solution = solve_complementarity(M, Eigen::Vector2d(-5, -6));
  REQUIRE(solution.found);
  CHECK(solution.z(0) == doctest::Approx(4.0 / 3));
  CHECK(solution.z(1) == doctest::Approx(7.0 / 3));
}

TEST_CASE("lemke: random positive semidefinite problems of any rank are solved to rounding") {
  std::mt19937 generator(7);
  for (const Eigen::Index n : {1, 2, 5, 12, 40}) {
    for (int trial = 0; trial < 20; ++trial) {
      CAPTURE(n);
      CAPTURE(trial);
      const Eigen::Index rank = 1 + trial % n;
      const Eigen::MatrixXd A = random_matrix(generator, n, rank);
      // q in the range of A plus something positive: the problem is feasible, hence solvable.
      const Eigen::VectorXd q = A * random_matrix(generator, rank, 1) + random_matrix(generator, n, 1).cwiseAbs();
      for (const bool scaled : {false, true}) {
        CAPTURE(scaled);
        const ComplementaritySolution solution = solve_complementarity(A * A.transpose(), q, scaled);
        REQUIRE(solution.found);
        CHECK(violation(A * A.transpose(), q, solution.z) < 1e-10);
      }
    }
  }
}

TEST_CASE("lemke: four corners of a plate share its weight, and a problem without a solution is reported") {
  // Accelerations of the corners of a square plate of unit mass and inertia, under unit gravity.
  Eigen::MatrixXd J(4, 3);
  J << 1, 1, 1, 1, -1, 1, 1, 1, -1, 1, -1, -1;
  const ComplementaritySolution shared = solve_complementarity(J * J.transpose(), Eigen::VectorXd::Constant(4, -1));
  REQUIRE(shared.found);
  CHECK(shared.z.sum() == doctest::Approx(1));
  CHECK(violation(J * J.transpose(), Eigen::VectorXd::Constant(4, -1), shared.z) < 1e-12);

  Eigen::MatrixXd pulled(1, 1);
  pulled << -1;
  CHECK_FALSE(solve_complementarity(pulled, Eigen::VectorXd::Constant(1, -1)).found);
}

TEST_CASE("least norm: dependent rows have the solution of least norm, others the only one") {
  Eigen::MatrixXd A(2, 2);
  A << 1, 1, 1, 1;
  const auto shared = solve_least_norm(A, Eigen::Vector2d(2, 2));
  CHECK(shared.rank == 1);
  CHECK(shared.x(0) == doctest::Approx(1));
  CHECK(shared.x(1) == doctest::Approx(1));
  std::mt19937 generator(3);
  for (const Eigen::Index n : {1, 2, 3, 4, 10}) {
    const Eigen::MatrixXd M = random_matrix(generator, n, n);
    const Eigen::VectorXd b = random_matrix(generator, n, 1);
    const auto only = solve_least_norm(M, b);
    CHECK(only.rank == n);
    CHECK((M * only.x - b).lpNorm<Eigen::Infinity>() < 1e-10);
  }
}

// W = J J^T with more rows than columns, so that rows depend on one another: the rank stays the same while they turn.
TEST_CASE("least norm: equations that change little are solved from the factors of earlier ones") {
  std::mt19937 generator(5);
  const Eigen::Index rows = 24, columns = 14;
  const Eigen::MatrixXd A = random_matrix(generator, rows, columns), B = random_matrix(generator, rows, columns);
  const Eigen::VectorXd pull = random_matrix(generator, columns, 1);
  LeastNormSolver solver;
  int reused = 0;  // the bits differ from those of the direct solution
  for (int k = 0; k <= 300; ++k) {
    const double t = 1e-5 * k + 0.5 * (k / 50);  // small turns, and jumps after which factors are computed anew
    CAPTURE(t);
    const Eigen::MatrixXd J = std::cos(t) * A + std::sin(t) * B, W = J * J.transpose();
    const Eigen::VectorXd right = J * pull;
    const auto kept = solver.solve(W, right), direct = solve_least_norm(W, right);
    REQUIRE(kept.rank == direct.rank);
    REQUIRE(kept.rank == columns);
    const double size = direct.x.lpNorm<Eigen::Infinity>();
    REQUIRE((kept.x - direct.x).lpNorm<Eigen::Infinity>() < 1e-9 * size);  // rounding times the condition of W
    REQUIRE((W * kept.x - right).lpNorm<Eigen::Infinity>() < 1e-11 * (size + 1));
    reused += kept.x != direct.x ? 1 : 0;
  }
  CHECK(reused > 280);  // all but one after each of six jumps
  CHECK(reused < 296);
  // Equations of another rank, and ones that contradict one another, are solved anew.
  const Eigen::MatrixXd regular = A * A.transpose() + Eigen::MatrixXd::Identity(rows, rows);
  CHECK(solver.solve(regular, A * pull).rank == rows);
  const Eigen::MatrixXd W = A * A.transpose();
  const Eigen::VectorXd any = random_matrix(generator, rows, 1);
  const auto kept = solver.solve(W, any), direct = solve_least_norm(W, any);
  CHECK(kept.rank == columns);
  CHECK((kept.x - direct.x).norm() < 1e-9 * direct.x.norm());
}
