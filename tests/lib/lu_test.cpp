// LU with partial pivoting: residuals of solutions; singular matrices are reported.
#include "eom/linalg/lu.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "eom/ensemble/lu_lanes.hpp"
#include "support/tolerances.hpp"

namespace {

using eom::Complex;

Complex random_complex(std::mt19937& generator) {
  std::uniform_real_distribution<double> value(-1, 1);
  return {value(generator), value(generator)};
}

/// Largest entry of A x - b for a random complex system of n unknowns, with zeros on the diagonal, so that pivoting is
/// needed.
double residual(std::size_t n, unsigned seed) {
  std::mt19937 generator(seed);
  eom::Lu<Complex> lu(n);
  std::vector<Complex> a(n * n), b(n);
  for (std::size_t k = 0; k < n * n; ++k) a[k] = k % (n + 1) == 0 && n > 1 ? Complex{} : random_complex(generator);
  for (Complex& value : b) value = random_complex(generator);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) lu(i, j) = a[i + n * j];
  REQUIRE(lu.factor());
  std::vector<Complex> x = b;
  lu.solve(x.data());
  double largest = 0, size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Complex sum = b[i];
    for (std::size_t j = 0; j < n; ++j) sum -= a[i + n * j] * x[j];
    largest = std::max({largest, std::abs(sum.re), std::abs(sum.im)});
    size = std::max({size, std::abs(x[i].re), std::abs(x[i].im)});
  }
  return largest / size;
}

}  // namespace

TEST_CASE("complex numbers: products and quotients without intermediate overflow") {
  const Complex p = Complex{1, 2} * Complex{3, -1};
  CHECK(p.re == 5);
  CHECK(p.im == 5);
  const Complex q = Complex{5e200, 5e200} / Complex{3e200, -1e200};
  CHECK(q.re == doctest::Approx(1));
  CHECK(q.im == doctest::Approx(2));
}

TEST_CASE("lu: the residual of complex systems that require pivoting is at rounding") {
  for (const std::size_t n : std::initializer_list<std::size_t>{1, 2, 3, 7, 20})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      CAPTURE(n);
      CHECK(residual(n, seed) < tolerances::rounding);
    }
}

TEST_CASE("lu: a real system with its known solution; singular and not finite matrices are reported") {
  eom::Lu<double> lu(2);
  const auto fill = [&](double a, double b, double c, double d) {
    lu(0, 0) = a, lu(0, 1) = b, lu(1, 0) = c, lu(1, 1) = d;
  };
  fill(0, 2, 4, 8);
  REQUIRE(lu.factor());
  double x[2]{6, 20};
  lu.solve(x);
  CHECK(x[0] == -1);
  CHECK(x[1] == 3);
  fill(1, 2, 2, 4);
  CHECK_FALSE(lu.factor());
  fill(std::numeric_limits<double>::quiet_NaN(), 2, 2, 4);
  CHECK_FALSE(lu.factor());
}

TEST_CASE("lu: lanes are bitwise equal to single systems, with their own pivots, and singular ones are reported") {
  constexpr std::size_t width = eom::ensemble::pack_width, lanes = 3 * width;
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> value(-1, 1);
  for (const std::size_t n : std::initializer_list<std::size_t>{1, 2, 5, 12}) {
    CAPTURE(n);
    std::vector<double> a(n * n * lanes), pivots(n * lanes), b(n * lanes), regular(lanes);
    for (double& entry : a) entry = value(generator) < -0.6 ? 0 : value(generator);
    for (double& entry : b) entry = value(generator);
    for (std::size_t i = 0; i < n * n; ++i) a[i * lanes + 1] = 0;
    a[2] = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> matrix = a, right = b;
    eom::ensemble::LuLanes<width> together(n, lanes, a.data(), pivots.data());
    for (std::size_t l = 0; l < lanes; l += width) {
      together.factor(l, regular.data());
      together.solve(l, b.data());
    }
    CHECK(regular[1] == 0);
    for (std::size_t l = 0; l < lanes; ++l) {
      CAPTURE(l);
      eom::Lu<double> alone(n);
      std::vector<double> x(n);
      for (std::size_t j = 0; j < n; ++j) {
        x[j] = right[j * lanes + l];
        for (std::size_t i = 0; i < n; ++i) alone(i, j) = matrix[(i + n * j) * lanes + l];
      }
      REQUIRE((regular[l] != 0) == alone.factor());
      if (regular[l] == 0) continue;
      alone.solve(x.data());
      for (std::size_t i = 0; i < n; ++i) CHECK(b[i * lanes + l] == x[i]);
    }
  }
}
