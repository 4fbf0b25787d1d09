// The coefficients against the order conditions, over all rooted trees (Hairer, Norsett, Wanner I, theorem II.2.13).
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "eom/registry.hpp"
#include "lib/rooted_trees.hpp"
#include "support/tolerances.hpp"

namespace {

using namespace eom::explicit_rk;
using trees::rooted_trees;
using trees::Tree;

/// The registered tableaus.
template <class... T>
auto tableaux_of(std::tuple<T...>*)
    -> decltype(std::tuple_cat(std::declval<std::conditional_t<Tableau<T>, std::tuple<T>, std::tuple<>>>()...));
using Tableaux = decltype(tableaux_of(static_cast<eom::Registry*>(nullptr)));

/// For each tree and column j of the tableau: the elementary weight of the stage, product over branches of (A Phi)_j.
template <class T>
std::vector<std::vector<double>> stage_weights(const std::vector<Tree>& trees) {
  constexpr std::size_t n = columns<T>;
  std::vector<std::vector<double>> weights(trees.size(), std::vector<double>(n, 1.0));
  for (std::size_t k = 0; k < trees.size(); ++k)
    for (const std::size_t b : trees[k].branches)
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += T::a[i][j] * weights[b][j];
        weights[k][i] *= sum;
      }
  return weights;
}

template <class Row>
double dot(const Row& row, const std::vector<double>& weights) {
  double sum = 0;
  for (std::size_t j = 0; j < row.size(); ++j) sum += row[j] * weights[j];
  return sum;
}

/// Largest order up to which the weights satisfy all conditions: sum_j row_j Phi_j(tree) = target(tree).
template <class Row, class Target>
int order_met(const Row& row, const std::vector<Tree>& trees, const std::vector<std::vector<double>>& weights,
              double tolerance, Target target) {
  for (std::size_t k = 0; k < trees.size(); ++k)
    if (std::abs(dot(row, weights[k]) - target(trees[k])) > tolerance) return trees[k].order - 1;
  return trees.back().order;
}

/// The weights of the dense output at s, as defined in tableau.hpp.
template <class T>
std::vector<double> dense_weights(double s) {
  const double r = 1 - s;
  std::vector<double> weights(columns<T>, 0.0);
  for (std::size_t j = 0; j < columns<T>; ++j) {
    const double d1 = T::a[T::stages][j];
    const double d2 = (j == 0 ? 1.0 : 0.0) - d1;
    const double d3 = d1 - (j == T::stages ? 1.0 : 0.0) - d2;
    double sum = 0;
    for (std::size_t row = T::dense.size(); row-- > 0;) sum = (row % 2 == 0 ? r : s) * (T::dense[row][j] + sum);
    weights[j] = s * (d1 + r * (d2 + s * (d3 + sum)));
  }
  return weights;
}

}  // namespace

TEST_CASE("trees: orders 1 to 9 have 1, 1, 2, 4, 9, 20, 48, 115 and 286 of them") {
  const std::vector<Tree> trees = rooted_trees(9);
  std::vector<int> count(10, 0);
  for (const Tree& tree : trees) ++count[static_cast<std::size_t>(tree.order)];
  CHECK(count == std::vector<int>{0, 1, 1, 2, 4, 9, 20, 48, 115, 286});
}

TEST_CASE_TEMPLATE_DEFINE("tableaux: c holds the row sums of a, which is strictly lower triangular", T,
                          tableau_claim_1) {
  for (std::size_t i = 0; i < columns<T>; ++i) {
    CAPTURE(i);
    double sum = 0;
    for (std::size_t j = 0; j < columns<T>; ++j) {
      if (j >= i) CHECK(T::a[i][j] == 0);
      sum += T::a[i][j];
    }
    CHECK(std::abs(sum - T::c[i]) < tolerances::order_condition);
  }
}

TEST_CASE_TEMPLATE_DEFINE("tableaux: the weights sum to 1 as exactly as binary64 can, so that no run drifts", T,
                          tableau_weight_sum) {
  long double sum = -1;
  for (std::size_t j = 0; j < T::stages; ++j) sum += static_cast<long double>(T::a[T::stages][j]);
  CHECK(std::abs(static_cast<double>(sum)) < tolerances::weight_sum);
}

TEST_CASE_TEMPLATE_DEFINE("tableaux: the weights meet all order conditions up to the order, and not one more", T,
                          tableau_claim_2) {
  CAPTURE(T::name);
  const auto trees = rooted_trees(T::order + 1);
  const auto weights = stage_weights<T>(trees);
  CHECK(order_met(T::a[T::stages], trees, weights, tolerances::order_condition,
                  [](const Tree& tree) { return 1 / tree.density; }) == T::order);
}

TEST_CASE_TEMPLATE_DEFINE("tableaux: sum b c^k = 1/(k+1), the quadrature conditions", T, tableau_claim_3) {
  for (int k = 0; k < T::order; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < T::stages; ++j) sum += T::a[T::stages][j] * std::pow(T::c[j], k);
    CHECK(std::abs(sum - 1.0 / (k + 1)) < tolerances::order_condition);
  }
}

TEST_CASE("tableaux: the error weights vanish up to order 4 (dopri5, tsit5) and to orders 5 and 3 (dop853)") {
  const auto zero = [](const Tree&) { return 0.0; };
  const auto trees = rooted_trees(6);
  const auto of_dopri5 = stage_weights<Dopri5>(trees);
  const auto of_dop853 = stage_weights<Dop853>(trees);
  CHECK(order_met(Dopri5::error[0], trees, of_dopri5, tolerances::order_condition, zero) == 4);
  CHECK(order_met(Tsit5::error[0], trees, stage_weights<Tsit5>(trees), tolerances::order_condition, zero) == 4);
  CHECK(order_met(Dop853::error[0], trees, of_dop853, tolerances::order_condition, zero) == 5);
  CHECK(order_met(Dop853::error[1], trees, of_dop853, tolerances::order_condition, zero) == 3);
}

TEST_CASE_TEMPLATE_DEFINE("tableaux: the dense output meets the order conditions at any point of the step", T,
                          tableau_claim_4) {
  CAPTURE(T::name);
  const auto trees = rooted_trees(T::dense_order + 1);
  const auto weights = stage_weights<T>(trees);
  for (const double s : {0.15, 0.4, 0.65, 0.9}) {
    CAPTURE(s);
    CHECK(order_met(dense_weights<T>(s), trees, weights, tolerances::dense_order_condition,
                    [&](const Tree& tree) { return std::pow(s, tree.order) / tree.density; }) == T::dense_order);
  }
}

TEST_CASE_TEMPLATE_APPLY(tableau_claim_1, Tableaux);
TEST_CASE_TEMPLATE_APPLY(tableau_claim_2, Tableaux);
TEST_CASE_TEMPLATE_APPLY(tableau_claim_3, Tableaux);
TEST_CASE_TEMPLATE_APPLY(tableau_claim_4, Tableaux);
TEST_CASE_TEMPLATE_APPLY(tableau_weight_sum, Tableaux);
