// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/chart_change.hpp"

#include <array>

#include "symbolic/vectors.hpp"

namespace eomgen::derive {
namespace {

using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Scalar;
using symbolic::Vec3;
using Matrix = std::array<Vec3, 3>;  // rows
using Axes = std::array<std::size_t, 3>;

struct Turn {
  Scalar sine, cosine;
};

/// Values and rates of the angles as symbols.
struct Angles {
  std::vector<Scalar> value, rate;
};

Angles symbols(Dag& dag, const std::vector<std::uint32_t>& angles) {
  Angles result;
  for (const std::uint32_t q : angles) {
    result.value.push_back({&dag, dag.symbol({symbolic::SymbolKind::coordinate, q, 0})});
    result.rate.push_back({&dag, dag.symbol({symbolic::SymbolKind::coordinate, q, 1})});
  }
  return result;
}

Turn turn_by(Dag& dag, Ref angle) { return {{&dag, dag.call(Op::sin, angle)}, {&dag, dag.call(Op::cos, angle)}}; }

/// e_k = sum_j R[k][j] p_j of the step about `axis`, eq. (5.32).
Matrix step(Dag& dag, std::size_t axis, const Turn& turn) {
  Matrix R{symbolic::zero_vector(dag), symbolic::zero_vector(dag), symbolic::zero_vector(dag)};
  const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
  R[axis][axis] = dag.one();
  R[j][j] = R[k][k] = turn.cosine.ref;
  R[j][k] = turn.sine.ref;
  R[k][j] = dag.neg(turn.sine.ref);
  return R;
}
Vec3 matrix_product(Dag& dag, const Matrix& R, const Vec3& v) {
  return {symbolic::dot(dag, R[0], v), symbolic::dot(dag, R[1], v), symbolic::dot(dag, R[2], v)};
}
Matrix transpose_of(const Matrix& R) {
  return {Vec3{R[0][0], R[1][0], R[2][0]}, Vec3{R[0][1], R[1][1], R[2][1]}, Vec3{R[0][2], R[1][2], R[2][2]}};
}
Matrix matrix_product(Dag& dag, const Matrix& A, const Matrix& B) {
  const Matrix columns = transpose_of(B);
  return transpose_of(
      {matrix_product(dag, A, columns[0]), matrix_product(dag, A, columns[1]), matrix_product(dag, A, columns[2])});
}
Vec3 along_axis(Dag& dag, std::size_t axis, Ref size) {
  Vec3 v = symbolic::zero_vector(dag);
  v[axis] = size;
  return v;
}

/// Sines and cosines of the angles of a set whose matrix is Q, eq. (5.57). The expression of the middle angle that
/// vanishes at the singularity is taken as positive.
std::array<Turn, 3> read_off(Dag& dag, const Axes& axes, const Matrix& Q) {
  const auto [i, j, k] = axes;
  const std::size_t m = 3 - i - j;  // the third axis
  const auto q = [&](std::size_t a, std::size_t b) { return Scalar{&dag, Q[a][b]}; };
  const auto length = [&](Scalar a, Scalar b) { return Scalar{&dag, dag.call(Op::sqrt, (a * a + b * b).ref)}; };
  const Scalar sign{&dag, dag.integer((i + 1) % 3 == j ? 1 : -1)};
  if (i == k) {
    const Scalar s = length(q(i, j), q(i, m));
    return {Turn{q(i, j) / s, -(sign * q(i, m)) / s}, Turn{s, q(i, i)}, Turn{q(j, i) / s, sign * q(m, i) / s}};
  }
  const Scalar c = length(q(k, j), q(k, k));
  return {Turn{-(sign * q(k, j)) / c, q(k, k) / c}, Turn{sign * q(k, i), c}, Turn{-(sign * q(j, i)) / c, q(i, i) / c}};
}

std::vector<Ref> change_of_angles(Dag& dag, const std::vector<std::uint32_t>& angles, const Axes& from,
                                  const Axes& to) {
  const Angles n = symbols(dag, angles);
  std::array<Matrix, 3> R;
  for (std::size_t s = 0; s < 3; ++s) R[s] = step(dag, from[s], turn_by(dag, n.value[s].ref));
  // w along the axes of the body, eq. (5.59).
  Vec3 w = symbolic::add(dag, matrix_product(dag, R[1], along_axis(dag, from[0], n.rate[0].ref)),
                         along_axis(dag, from[1], n.rate[1].ref));
  w = symbolic::add(dag, matrix_product(dag, R[2], w), along_axis(dag, from[2], n.rate[2].ref));
  const std::array<Turn, 3> turns = read_off(dag, to, matrix_product(dag, R[2], matrix_product(dag, R[1], R[0])));

  // Along the axes before the last step, g2 and g3 are two of the axes, and g1 has no component along g2.
  const Vec3 v = matrix_product(dag, transpose_of(step(dag, to[2], turns[2])), w);
  const Matrix second = step(dag, to[1], turns[1]);
  const std::size_t third = 3 - to[1] - to[2];
  const Scalar rate1 = Scalar{&dag, v[third]} / Scalar{&dag, second[third][to[0]]};
  const Scalar rate3 = Scalar{&dag, v[to[2]]} - rate1 * Scalar{&dag, second[to[2]][to[0]]};
  std::vector<Ref> result;
  for (const Turn& turn : turns) result.push_back(dag.call(Op::atan2, turn.sine.ref, turn.cosine.ref));
  result.insert(result.end(), {rate1.ref, v[to[1]], rate3.ref});
  return result;
}

/// Converts phi from the axis `from` and theta about it to the same angles for the axis `to`.
std::vector<Ref> change_of_direction(Dag& dag, const std::vector<std::uint32_t>& angles, std::size_t from,
                                     std::size_t to) {
  const Angles n = symbols(dag, angles);
  const Turn phi = turn_by(dag, n.value[0].ref), theta = turn_by(dag, n.value[1].ref);
  std::array<Scalar, 3> e, v;  // the direction, and its rate
  const std::size_t a = (from + 1) % 3, b = (from + 2) % 3;
  e[from] = phi.cosine;
  e[a] = phi.sine * theta.cosine;
  e[b] = phi.sine * theta.sine;
  v[from] = -(phi.sine * n.rate[0]);
  v[a] = phi.cosine * theta.cosine * n.rate[0] - phi.sine * theta.sine * n.rate[1];
  v[b] = phi.cosine * theta.sine * n.rate[0] + phi.sine * theta.cosine * n.rate[1];
  const std::size_t c = (to + 1) % 3, d = (to + 2) % 3;
  const Scalar square = e[c] * e[c] + e[d] * e[d];
  const Scalar s{&dag, dag.call(Op::sqrt, square.ref)};
  const Scalar phi_rate = e[to] * (e[c] * v[c] + e[d] * v[d]) / s - s * v[to];
  const Scalar theta_rate = (e[c] * v[d] - e[d] * v[c]) / square;
  return {dag.call(Op::atan2, s.ref, e[to].ref), dag.call(Op::atan2, e[d].ref, e[c].ref), phi_rate.ref, theta_rate.ref};
}

}  // namespace

system::ChartChange chart_change(Dag& dag, const model::Model& model, const model::ChartPair& chart) {
  system::ChartChange change{chart.of,
                             chart.own,
                             chart.second,
                             chart.singularity(model),
                             chart.angles,
                             chart.guarded,
                             chart.at_sine,
                             true,
                             true,
                             {},
                             {}};
  if (chart.kind == model::ChartPair::Kind::rotation) {
    Axes second = chart.axes;
    second[2] = chart.second_axis;
    change.second_at_sine = !chart.at_sine;
    change.to_second = change_of_angles(dag, chart.angles, chart.axes, second);
    change.to_own = change_of_angles(dag, chart.angles, second, chart.axes);
  } else {
    change.rotation = false;
    change.to_second = change_of_direction(dag, chart.angles, 2, 0);
    change.to_own = change_of_direction(dag, chart.angles, 0, 2);
  }
  return change;
}

}  // namespace eomgen::derive
