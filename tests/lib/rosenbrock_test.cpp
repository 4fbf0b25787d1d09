// The coefficients of the Rosenbrock method against the order conditions: Hairer, Wanner, Solving Ordinary Differential
// Equations II, section IV.7, theorem 7.4, with beta = alpha + Gamma, the diagonal included.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "eom/implicit/rodas5p.hpp"
#include "eom/ode.hpp"
#include "lib/compiled.hpp"
#include "lib/problems.hpp"
#include "lib/rooted_trees.hpp"
#include "support/tolerances.hpp"

namespace {

using T = eom::implicit::Rodas5p;
using trees::Tree;
constexpr std::size_t n = T::stages;
using Vector = std::array<double, n>;
using Matrix = std::array<Vector, n>;

/// The inverse of diag(1/gamma) - C, lower triangular.
Matrix gamma_matrix() {
  Matrix result{};
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j; i < n; ++i) {
      double sum = i == j ? 1 : 0;
      for (std::size_t k = j; k < i; ++k) sum += T::C[i][k] * result[k][j];
      result[i][j] = T::gamma * sum;
    }
  return result;
}

template <class Row>
Vector times_gamma(const Row& row) {
  const Matrix gamma = gamma_matrix();
  Vector result{};
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t k = 0; k < n; ++k) result[j] += row[k] * gamma[k][j];
  return result;
}

/// Per tree the elementary weights of the stages: alpha at a vertex with several branches, beta at one with one.
std::vector<Vector> rosenbrock_weights(const std::vector<Tree>& all) {
  const Matrix gamma = gamma_matrix();
  Matrix alpha{};
  for (std::size_t i = 0; i < n; ++i) alpha[i] = times_gamma(T::a[i]);
  std::vector<Vector> weights(all.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    weights[t].fill(1);
    const bool one = all[t].branches.size() == 1;
    for (const std::size_t branch : all[t].branches)
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += (alpha[i][j] + (one ? gamma[i][j] : 0)) * weights[branch][j];
        weights[t][i] *= sum;
      }
  }
  return weights;
}

/// Largest order up to which the weights of the stages give s^order / density for all trees; for s = 0 they give 0.
int order_met(const Vector& row, double s, int highest) {
  const std::vector<Tree> all = trees::rooted_trees(highest);
  const std::vector<Vector> weights = rosenbrock_weights(all);
  for (std::size_t t = 0; t < all.size(); ++t) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += row[j] * weights[t][j];
    const double target = s == 0 ? 0 : std::pow(s, all[t].order) / all[t].density;
    if (std::abs(sum - target) > tolerances::rosenbrock_condition) return all[t].order - 1;
  }
  return highest;
}

}  // namespace

TEST_CASE("rodas: order 5 exactly; the estimate is that of an embedded method of order 4") {
  CHECK(order_met(times_gamma(T::b), 1, 6) == 5);
  Vector last{};
  last[n - 1] = 1;
  CHECK(order_met(times_gamma(last), 0, 6) == 4);
}

TEST_CASE("rodas: a constant derivative is integrated to rounding, so that no run drifts") {
  std::array<long double, n> u{};
  long double sum = -1;
  for (std::size_t i = 0; i < n; ++i) {
    long double right = 1;
    for (std::size_t j = 0; j < i; ++j) right += static_cast<long double>(T::C[i][j]) * u[j];
    u[i] = static_cast<long double>(T::gamma) * right;
    sum += static_cast<long double>(T::b[i]) * u[i];
  }
  CHECK(std::abs(static_cast<double>(sum)) < tolerances::weight_sum);
}

TEST_CASE("rodas: the dense output is of order 4 at any point of the step") {
  for (const double s : {0.15, 0.4, 0.65, 0.9}) {
    Vector row{};
    for (std::size_t j = 0; j < n; ++j)
      row[j] = s * (T::b[j] + (1 - s) * (T::dense[0][j] + s * (T::dense[1][j] + s * T::dense[2][j])));
    CHECK(order_met(times_gamma(row), s, 5) == 4);
  }
}

TEST_CASE("rodas: times of the stages and weights of df/dt are row sums of alpha and Gamma") {
  const Matrix gamma = gamma_matrix();
  for (std::size_t i = 0; i < n; ++i) {
    double c = 0, d = 0;
    const Vector alpha = times_gamma(T::a[i]);
    for (std::size_t j = 0; j < n; ++j) {
      c += alpha[j];
      d += gamma[i][j];
    }
    CHECK(std::abs(c - T::c[i]) < tolerances::rosenbrock_condition);
    CHECK(std::abs(d - T::d[i]) < tolerances::rosenbrock_condition);
  }
}

TEST_CASE("rodas: the order holds for time-dependent right-hand sides, with df/dt given or by differences") {
  // x' = -x sin t, x = exp(cos t - 1)
  const auto rhs = [](double t, const double* x, double* dx) { return dx[0] = -x[0] * std::sin(t), 0; };
  const auto jacobian = [](double t, const double* x, double* dfdx, double* dfdt) {
    dfdx[0] = -std::sin(t);
    dfdt[0] = -x[0] * std::cos(t);
    return 0;
  };
  const auto error = [](auto&& f, double step) {
    eom::Options options;
    options.fixed_step = step;
    return std::abs(compiled::integrate("rodas", f, 0, problems::State{1}, 3, options).x[0] -
                    std::exp(std::cos(3.0) - 1));
  };
  const double given =
      std::log2(error(eom::WithJacobian{rhs, jacobian}, 0.1) / error(eom::WithJacobian{rhs, jacobian}, 0.05));
  const double differences = std::log2(error(rhs, 0.1) / error(rhs, 0.05));
  const auto without_time = [](double t, const double*, double* dfdx, double*) {
    dfdx[0] = -std::sin(t);
    return eom::no_time_derivative_here;
  };
  const eom::WithJacobian half{rhs, without_time};
  CHECK(std::abs(std::log2(error(half, 0.1) / error(half, 0.05)) - 5) < 0.5);
  CHECK(std::abs(given - 5) < 0.5);
  CHECK(std::abs(differences - 5) < 0.5);
}
