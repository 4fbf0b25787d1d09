// Projection onto constraints: to rounding, in the metric of M, also for singular M or redundant rows of A; without
// allocations; failures of convergence are reported.
#include <doctest/doctest.h>

#include <stdexcept>
#define EIGEN_RUNTIME_NO_MALLOC  // Eigen then asserts on allocation; the assertion throws
#define eigen_assert(condition)                                     \
  do {                                                              \
    if (!(condition)) throw std::logic_error("Eigen: " #condition); \
  } while (false)
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "eom/constraints/projection.hpp"
#include "lib/compiled.hpp"
#include "support/tolerances.hpp"

namespace {

/// A pendulum of length 1 in (x, y) with the constraint written `copies` times. The mass depends on the direction.
struct CartesianPendulum {
  int copies = 1;
  double mass_x = 1, mass_y = 1;

  auto constraints() const {
    return [m = copies](double, const double* x, double* psi, double* A, double* b) {
      for (int i = 0; i < m; ++i) {
        psi[i] = (i + 1) * (x[0] * x[0] + x[1] * x[1] - 1);
        A[i] = (i + 1) * 2 * x[0];
        A[i + m] = (i + 1) * 2 * x[1];
        b[i] = 0;
      }
      return 0;
    };
  }
  auto mass() const {
    return [mx = mass_x, my = mass_y](double, const double*, double* M, double* h) {
      M[0] = mx;
      M[1] = M[2] = 0;
      M[3] = my;
      h[0] = h[1] = 0;
      return 0;
    };
  }
};

void check_on_pendulum(const std::array<double, 4>& x) {
  CHECK(std::abs(x[0] * x[0] + x[1] * x[1] - 1) < tolerances::on_constraint);
  CHECK(std::abs(x[0] * x[2] + x[1] * x[3]) < tolerances::on_constraint);
}

/// Linear constraints A q = c in n coordinates, so that one Newton step is sufficient.
struct Linear {
  Eigen::MatrixXd A, M;
  Eigen::VectorXd c, b;

  auto constraints() const {
    return [this](double, const double* x, double* psi, double* A_out, double* b_out) {
      const auto n = A.cols();
      Eigen::Map<Eigen::VectorXd>(psi, A.rows()) = A * Eigen::Map<const Eigen::VectorXd>(x, n) - c;
      Eigen::Map<Eigen::MatrixXd>(A_out, A.rows(), n) = A;
      Eigen::Map<Eigen::VectorXd>(b_out, A.rows()) = b;
      return 0;
    };
  }
  auto mass() const {
    return [this](double, const double*, double* M_out, double*) {
      Eigen::Map<Eigen::MatrixXd>(M_out, M.rows(), M.cols()) = M;
      return 0;
    };
  }
  /// The correction by the KKT system [M A^T; A 0] with a complete orthogonal decomposition.
  Eigen::VectorXd reference(const Eigen::VectorXd& defect) const {
    const auto n = A.cols();
    const auto m = A.rows();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
    K.topLeftCorner(n, n) = M;
    K.topRightCorner(n, m) = A.transpose();
    K.bottomLeftCorner(m, n) = A;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m);
    right.tail(m) = -defect;
    return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(K).solve(right).head(n);
  }
};

/// Projects a fixed state by the given linear problem and compares both corrections with the reference.
void check_against_reference(const Linear& problem) {
  const auto n = problem.A.cols();
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(2 * n, 0.3, 1.7).array().sin();
  const Eigen::VectorXd before = x;
  eom::Projection projection(static_cast<std::size_t>(n), static_cast<std::size_t>(problem.A.rows()));
  const auto result = projection(0, x.data(), problem.constraints(), problem.mass());
  CHECK(result.code == 0);
  const Eigen::VectorXd q = before.head(n);
  const Eigen::VectorXd v = before.tail(n);
  CHECK((x.head(n) - q - problem.reference(problem.A * q - problem.c)).norm() < tolerances::same_correction);
  CHECK((x.tail(n) - v - problem.reference(problem.A * v + problem.b)).norm() < tolerances::same_correction);
  CHECK((problem.A * x.head(n) - problem.c).norm() < tolerances::on_constraint);
  CHECK((problem.A * x.tail(n) + problem.b).norm() < tolerances::on_constraint);
}

Linear random_problem(Eigen::Index n, Eigen::Index m) {
  std::srand(7);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, n);
  return {Eigen::MatrixXd::Random(m, n), B * B.transpose() + Eigen::MatrixXd::Identity(n, n),
          Eigen::VectorXd::Random(m), Eigen::VectorXd::Random(m)};
}

}  // namespace

TEST_CASE("projection: the pendulum returns to its circle, in positions and velocities") {
  std::array<double, 4> x{0.6 + 1e-3, -0.8, 0.8, 0.6 + 2e-3};
  const CartesianPendulum pendulum;
  eom::Projection projection(2, 1);
  const auto result = projection(0, x.data(), pendulum.constraints(), pendulum.mass());
  CHECK(result.code == 0);
  CHECK(result.rank == 1);
  CHECK(result.iterations >= 1);
  CHECK(result.iterations <= 4);
  CHECK(result.position_correction > 1e-4);
  CHECK(result.velocity_correction > 1e-4);
  check_on_pendulum(x);
}

TEST_CASE("projection: a state on the constraints does not change by a bit") {
  std::array<double, 4> x{0, -1, 2, 0};
  const CartesianPendulum pendulum;
  eom::Projection projection(2, 1);
  const auto result = projection(0, x.data(), pendulum.constraints(), pendulum.mass());
  CHECK(result.code == 0);
  CHECK(result.iterations == 0);
  CHECK(result.rank == -1);
  CHECK(x == std::array<double, 4>{0, -1, 2, 0});
}

TEST_CASE("projection: it solves the KKT system with the metric M") {
  check_against_reference(random_problem(5, 2));
  check_against_reference(random_problem(6, 5));
  check_against_reference(random_problem(4, 4));
}

TEST_CASE("projection: redundant constraints, rows repeated and rows of zeros, change nothing") {
  const Linear plain = random_problem(5, 2);
  Linear redundant = plain;
  redundant.A.conservativeResize(5, 5);
  redundant.c.conservativeResize(5);
  redundant.b.conservativeResize(5);
  redundant.A.row(2) = 3 * plain.A.row(0);
  redundant.A.row(3) = 1e3 * (plain.A.row(0) - plain.A.row(1));
  redundant.A.row(4).setZero();
  redundant.c.tail(3) << 3 * plain.c(0), 1e3 * (plain.c(0) - plain.c(1)), 0;
  redundant.b.tail(3) << 3 * plain.b(0), 1e3 * (plain.b(0) - plain.b(1)), 0;
  Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(10, -1, 1);
  Eigen::VectorXd b = a;
  eom::Projection two(5, 2);
  eom::Projection five(5, 5);
  CHECK(two(0, a.data(), plain.constraints(), plain.mass()).rank == 2);
  const auto result = five(0, b.data(), redundant.constraints(), redundant.mass());
  CHECK(result.code == 0);
  CHECK(result.rank == 2);
  CHECK((a - b).norm() < tolerances::same_correction);
}

TEST_CASE("projection: three copies of a nonlinear constraint have the effect of one") {
  const CartesianPendulum once;
  const CartesianPendulum thrice{3};
  std::array<double, 4> a{0.7, -0.8, 0.8, 0.5};
  std::array<double, 4> b = a;
  eom::Projection one(2, 1);
  eom::Projection three(2, 3);
  one(0, a.data(), once.constraints(), once.mass());
  const auto result = three(0, b.data(), thrice.constraints(), thrice.mass());
  CHECK(result.code == 0);
  CHECK(result.rank == 1);
  check_on_pendulum(b);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(a[i] - b[i]) < tolerances::on_constraint);
}

TEST_CASE("projection: M may be singular if it is positive definite on the null space of the constraints") {
  Linear problem = random_problem(5, 2);
  problem.M.setZero();
  problem.M.diagonal() << 1, 2, 3, 0, 0;  // null space of dimension 2, transversal to the two constraints
  check_against_reference(problem);
}

TEST_CASE("projection: a coordinate with more mass is moved less") {
  const CartesianPendulum heavy_y{1, 1e-6, 1};
  std::array<double, 4> x{0.7, -0.8, 0, 0};
  eom::Projection projection(2, 1);
  projection(0, x.data(), heavy_y.constraints(), heavy_y.mass());
  CHECK(std::abs(x[1] + 0.8) < 1e-5);
  CHECK(std::abs(x[0] - 0.6) < 1e-5);
}

TEST_CASE("projection: a direction without any mass does not move, and all numbers are finite") {
  const CartesianPendulum massless{1, 0, 0};
  std::array<double, 4> x{0.7, -0.8, 0.8, 0.61};
  eom::Projection projection(2, 1);
  CHECK(projection(0, x.data(), massless.constraints(), massless.mass()).code == 0);
  check_on_pendulum(x);
}

TEST_CASE("projection: velocity constraints have no psi and do not change the positions") {
  // a blade: the velocity across its heading; psi is not written
  const auto constraints = [](double, const double* x, double*, double* A, double* b) {
    A[0] = -std::sin(x[2]);
    A[1] = std::cos(x[2]);
    A[2] = 0;
    b[0] = 0;
    return 0;
  };
  const auto mass = [](double, const double*, double* M, double*) {
    Eigen::Map<Eigen::Matrix3d>(M).setIdentity();
    return 0;
  };
  std::array<double, 6> x{1, 2, 0.5, 1, 0.6, 0.1};
  eom::Projection projection(3, 1, 0);
  const auto result = projection(0, x.data(), constraints, mass);
  CHECK(result.code == 0);
  CHECK(result.position_correction == 0);
  CHECK(std::abs(-std::sin(0.5) * x[3] + std::cos(0.5) * x[4]) < tolerances::on_constraint);
  CHECK(x[0] == 1);
}

TEST_CASE("projection: contradictory constraints and codes of the callbacks are reported, and the state is unchanged") {
  const auto contradicting = [](double, const double* x, double* psi, double* A, double* b) {
    psi[0] = x[0] - 1;
    psi[1] = x[0] - 2;
    A[0] = A[1] = 1;
    A[2] = A[3] = 0;
    b[0] = b[1] = 0;
    return 0;
  };
  const auto fails = [](double, const double*, double*, double*, double*) { return 2; };
  const CartesianPendulum pendulum;
  const std::array<double, 4> before{0.3, 0.4, 0.5, 0.6};
  std::array<double, 4> x = before;
  eom::Projection two(2, 2);
  CHECK(two(0, x.data(), contradicting, pendulum.mass()).code == eom::ProjectionResult::not_converged);
  CHECK(x == before);
  CHECK(two(0, x.data(), fails, pendulum.mass()).code == 2);
  CHECK(x == before);
  const auto no_root = [](double, const double* y, double* psi, double* A, double* b) {
    psi[0] = y[0] * y[0] + 1;
    A[0] = 2 * y[0];
    A[1] = b[0] = 0;
    return 0;
  };
  eom::Projection one(2, 1);
  CHECK(one(0, x.data(), no_root, pendulum.mass()).code != 0);
  CHECK(x == before);
}

TEST_CASE("projection: no allocation after construction, also when the rank changes") {
  const CartesianPendulum thrice{3};
  eom::Projection projection(2, 3);
  std::array<double, 4> x{0.7, -0.8, 0.8, 0.5};
  Eigen::internal::set_is_malloc_allowed(false);
  CHECK_THROWS_AS(Eigen::MatrixXd(3, 3), std::logic_error);  // the guard itself works
  eom::ProjectionResult on_circle;
  eom::ProjectionResult at_centre;
  std::array<double, 4> y{0, 0, 1, 1};  // A vanishes here
  CHECK_NOTHROW(on_circle = projection(0, x.data(), thrice.constraints(), thrice.mass()));
  CHECK_NOTHROW(at_centre = projection(0, y.data(), thrice.constraints(), thrice.mass()));
  Eigen::internal::set_is_malloc_allowed(true);
  CHECK(on_circle.code == 0);
  CHECK(at_centre.code == eom::ProjectionResult::not_converged);
}

TEST_CASE("projection in a run: the Cartesian pendulum stays on its circle; without projection it drifts off") {
  const CartesianPendulum pendulum;
  const auto rhs = [](double, const double* x, double* dx) {
    // lambda from x . x'' + v . v = 0 with gravity (0, -1)
    const double lambda = (x[1] - x[2] * x[2] - x[3] * x[3]) / (x[0] * x[0] + x[1] * x[1]);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = lambda * x[0];
    dx[3] = lambda * x[1] - 1;
    return 0;
  };
  const std::vector<double> start{1, 0, 0, 0};
  eom::Options options;
  options.rtol = 1e-6;
  eom::Projection projection(2, 1);
  const auto project = [&](double t, double* x) {
    return projection(t, x, pendulum.constraints(), pendulum.mass()).code;
  };
  const auto off_circle = [](const eom::Result& result) { return std::abs(std::hypot(result.x[0], result.x[1]) - 1); };
  const auto with = eom::integrate("dopri5", rhs, 0, start, 50, options, eom::NoObserver{}, project);
  const auto without = eom::integrate("dopri5", rhs, 0, start, 50, options);
  CHECK(with.outcome == eom::Outcome::done);
  CHECK(off_circle(with) < tolerances::on_constraint);
  CHECK(off_circle(without) > 1e-6);
}

// Rows of a chain of rods, each twice, so that half of them are redundant. The kept inverse belongs to another state.
TEST_CASE("projection: with many rows the inverse of an earlier state serves later ones") {
  constexpr int links = 20, n = 2 * links, m = 2 * links;
  const auto constraints = [](double, const double* x, double* psi, double* A, double* b) {
    Eigen::Map<Eigen::MatrixXd> rows(A, m, n);
    rows.setZero();
    for (int copy = 0; copy < 2; ++copy) {
      for (int k = 0; k < links; ++k) {
        const double dx = x[2 * k] - (k > 0 ? x[2 * k - 2] : 0), dy = x[2 * k + 1] - (k > 0 ? x[2 * k - 1] : 0);
        const int row = copy * links + k;
        psi[row] = dx * dx + dy * dy - 1;
        b[row] = 0;
        rows(row, 2 * k) = 2 * dx, rows(row, 2 * k + 1) = 2 * dy;
        if (k > 0) rows(row, 2 * k - 2) = -2 * dx, rows(row, 2 * k - 1) = -2 * dy;
      }
    }
    return 0;
  };
  int masses = 0;
  const auto mass = [&](double, const double*, double* M, double*) {
    ++masses;
    Eigen::Map<Eigen::MatrixXd>(M, n, n) = Eigen::VectorXd::LinSpaced(n, 1, 3).asDiagonal();
    return 0;
  };
  int of_kept = 0;  // evaluations of M: one for each new inverse
  double worst = 0;
  eom::Projection kept(n, m);
  for (int k = 0; k < 60; ++k) {
    CAPTURE(k);
    Eigen::VectorXd x(2 * n);
    for (int i = 0; i < links; ++i) {
      const double angle = 0.002 * k + 0.3 * i, rate = 1 + 0.1 * i;
      const double far = 1 + 1e-6 * std::sin(3 * i + k);  // the drift of a step
      for (int c = 0; c < 2; ++c) {
        x(2 * i + c) = (i > 0 ? x(2 * i - 2 + c) : 0) + far * (c == 0 ? std::cos(angle) : std::sin(angle));
        x(n + 2 * i + c) =
            (i > 0 ? x(n + 2 * i - 2 + c) : 0) + far * rate * (c == 0 ? -std::sin(angle) : std::cos(angle) + 1e-6);
      }
    }
    Eigen::VectorXd anew = x;
    eom::Projection fresh(n, m);
    const int before = masses;
    const auto result = kept(0, x.data(), constraints, mass);
    of_kept += masses - before;
    REQUIRE(result.code == 0);
    REQUIRE(fresh(0, anew.data(), constraints, mass).code == 0);
    Eigen::VectorXd psi(m), b(m);
    Eigen::MatrixXd A(m, n);
    constraints(0, x.data(), psi.data(), A.data(), b.data());
    REQUIRE(psi.norm() < 1e-13);
    REQUIRE((A * x.tail(n)).norm() < 1e-12);
    // Along the constraints both differ by the correction times the change of the inverse.
    const double corrections = result.position_correction + result.velocity_correction;
    worst = std::max(worst, (x - anew).lpNorm<Eigen::Infinity>() / corrections);
  }
  CHECK(worst < 0.2);   // an inverse is kept while each correction is a tenth of the one before
  CHECK(of_kept < 10);  // of 60 states
}

// Rows that differ by 1e-9 turn errors of 1e-12 into corrections of 1e-3, which diverge with the curvature of the rows.
TEST_CASE("projection: nearly dependent rows move the state along fewer directions") {
  const auto constraints = [](double, const double* x, double* psi, double* A, double* b) {
    constexpr double tilt = 1e-9, curvature = 1e3, error = 1e-12;
    psi[0] = x[0];
    psi[1] = x[0] + tilt * x[1] + curvature * x[1] * x[1] + error;
    A[0] = A[1] = 1, A[2] = 0, A[3] = tilt + 2 * curvature * x[1];
    b[0] = b[1] = 0;
    return 0;
  };
  const auto mass = [](double, const double*, double* M, double*) {
    Eigen::Map<Eigen::Matrix2d>(M).setIdentity();
    return 0;
  };
  std::array<double, 4> x{1e-10, 0, 0, 0};
  eom::Projection projection(2, 2);
  const auto result = projection(0, x.data(), constraints, mass);
  CHECK(result.code == 0);
  CHECK(result.rank == 1);
  CHECK(std::abs(x[0]) < 1e-12);  // the error is shared
  CHECK(x[1] == 0);
}
