// SPDX-License-Identifier: GPL-3.0-or-later
// Solutions for right-hand sides with few entries, against the dense factorisation.
#include "program/rooted_solver.hpp"

#include <doctest/doctest.h>

#include "program/systems.hpp"
#include "program/values.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

constexpr double as_good_as_exact = 1e-50;  // of values in 60 digits

/// A symmetric matrix with symbols where `joined` pairs rows, and on the diagonal, which dominates.
struct Graph {
  std::size_t n = 0;
  std::vector<std::pair<std::size_t, std::size_t>> joined;

  std::vector<Ref> matrix(symbolic::Dag& dag) const {
    std::uint32_t next = 0;
    const auto symbol = [&] { return dag.symbol({SymbolKind::parameter, next++, 0}); };
    std::vector<Ref> S(n * n, dag.zero());
    for (std::size_t i = 0; i < n; ++i) S[i * n + i] = dag.add(dag.integer(6), symbol());
    for (const auto& [i, j] : joined) S[i * n + j] = S[j * n + i] = symbol();
    return S;
  }
};

const Graph row_of_six{6, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}};
const Graph siblings{7, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 4}, {2, 5}, {4, 5}, {5, 6}}};
const Graph two_parts{6, {{0, 1}, {1, 2}, {3, 4}, {4, 5}}};

std::vector<std::map<std::size_t, Ref>> all_unknowns(symbolic::Dag& dag, std::size_t n) {
  std::vector<std::map<std::size_t, Ref>> rows(n);
  for (std::size_t i = 0; i < n; ++i) rows[i].emplace(i, dag.one());
  return rows;
}

}  // namespace

TEST_CASE("a rooted solver solves for every right-hand side, in chains, with siblings and in separate parts") {
  for (const Graph& graph : {row_of_six, siblings, two_parts}) {
    const auto dag = std::make_shared<symbolic::Dag>();
    const std::size_t n = graph.n;
    const std::vector<Ref> S = graph.matrix(*dag);
    program::RootedSolver solver(*dag, S, n);
    const symbolic::Factorisation dense(*dag, S, n, symbolic::Ties::ascending);
    for (std::size_t mask = 0; mask < std::size_t{1} << n; ++mask) {
      CAPTURE(mask);
      std::vector<Ref> r(n, dag->zero());
      for (std::size_t i = 0; i < n; ++i) {
        if ((mask >> i & 1) != 0) r[i] = dag->symbol({SymbolKind::input, static_cast<std::uint32_t>(i), 0});
      }
      const std::vector<Ref> expected = dense.backward(dense.forward(r)), x = solver(r, all_unknowns(*dag, n));
      CHECK(difference(expressions_at(*dag, x, 1), expressions_at(*dag, expected, 1)) < as_good_as_exact);
      std::vector<std::map<std::size_t, Ref>> sums(1);
      Ref sum = dag->zero();
      for (std::size_t i = 0; i < n; i += 2) {
        const Ref weight = dag->symbol({SymbolKind::vector, static_cast<std::uint32_t>(i), 0});
        sums[0].emplace(i, weight);
        sum = dag->add(sum, dag->mul(weight, expected[i]));
      }
      CHECK(difference(expressions_at(*dag, solver(r, sums), 1), expressions_at(*dag, {sum}, 1)) < as_good_as_exact);
    }
  }
}

TEST_CASE("beyond the right-hand side a rooted solver needs one product for each unknown") {
  const auto dag = std::make_shared<symbolic::Dag>();
  const std::size_t n = row_of_six.n;
  program::RootedSolver solver(*dag, row_of_six.matrix(*dag), n);
  std::vector<Ref> r(n, dag->zero());
  r[2] = dag->symbol({SymbolKind::input, 0, 0});
  const std::vector<Ref> x = solver(r, all_unknowns(*dag, n));
  for (const std::size_t i : std::initializer_list<std::size_t>{1, 0, 3, 4, 5}) {
    symbolic::Node node = (*dag)[x[i]];
    if (node.op == symbolic::Op::neg) node = (*dag)[node.args[0]];
    REQUIRE(node.op == symbolic::Op::mul);
    const Ref inner = x[i < 2 ? i + 1 : i - 1];
    const Ref positive = (*dag)[inner].op == symbolic::Op::neg ? (*dag)[inner].args[0] : inner;
    CHECK((node.args[0] == positive || node.args[1] == positive));
  }
  CHECK(solver.pivots().size() == n);
}

TEST_CASE("a rooted solver has no elimination for a right-hand side of zeros") {
  const auto dag = std::make_shared<symbolic::Dag>();
  program::RootedSolver solver(*dag, row_of_six.matrix(*dag), row_of_six.n);
  const std::vector<Ref> none(row_of_six.n, dag->zero());
  CHECK(solver(none, all_unknowns(*dag, row_of_six.n)) == none);
  CHECK(solver.pivots().empty());
}
