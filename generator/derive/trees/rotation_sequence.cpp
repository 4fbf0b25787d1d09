// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/rotation_sequence.hpp"

namespace eomgen::derive {

Mat3 zero_matrix(const Dag& dag) {
  const Vec3 none = symbolic::zero_vector(dag);
  return {none, none, none};
}

Mat3 transposed(const Mat3& a) {
  Mat3 result = a;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = a[k][i];
  }
  return result;
}

Vec3 times(Dag& dag, const Mat3& a, const Vec3& v) { return {dot(dag, a[0], v), dot(dag, a[1], v), dot(dag, a[2], v)}; }

Mat3 product(Dag& dag, const Mat3& a, const Mat3& b) {
  const Mat3 columns = transposed(b);
  Mat3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = dot(dag, a[i], columns[k]);
  }
  return result;
}

Mat3 add(Dag& dag, const Mat3& a, const Mat3& b) {
  return {symbolic::add(dag, a[0], b[0]), symbolic::add(dag, a[1], b[1]), symbolic::add(dag, a[2], b[2])};
}

Mat3 cross_matrix(Dag& dag, const Vec3& d) {
  const Ref o = dag.zero();
  return {Vec3{o, dag.neg(d[2]), d[1]}, Vec3{d[2], o, dag.neg(d[0])}, Vec3{dag.neg(d[1]), d[0], o}};
}

std::size_t axis_of(const Dag& dag, const Mat3& R) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const bool about = dag.is_one(R[i][i]) && dag.is_zero(R[i][j]) && dag.is_zero(R[i][k]) && dag.is_zero(R[j][i]) &&
                       dag.is_zero(R[k][i]);
    if (about) return i;
  }
  return 3;
}

namespace {

/// R^T A R with A symmetric and R about axis i; the double angle gives one auxiliary quantity in place of four products
/// each.
Mat3 about_axis_to_parent(Dag& dag, const Mat3& R, const Mat3& a, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const Ref c = R[j][j], s = R[j][k];
  const Ref h = a[j][k];
  const Ref w = dag.add(dag.mul(s, dag.sub(a[k][k], a[j][j])), dag.mul(dag.neg(c), dag.add(h, h)));
  Mat3 result = a;
  result[j][j] = dag.add(a[j][j], dag.mul(s, w));
  result[k][k] = dag.sub(a[k][k], dag.mul(s, w));
  result[j][k] = result[k][j] = dag.neg(dag.add(dag.mul(c, w), h));
  const Ref x = a[i][j], y = a[i][k];
  result[i][j] = result[j][i] = dag.sub(dag.mul(c, x), dag.mul(s, y));
  result[i][k] = result[k][i] = dag.add(dag.mul(s, x), dag.mul(c, y));
  return result;
}

/// R^T A R of any matrix, with the double angle likewise.
Mat3 any_about_axis_to_parent(Dag& dag, const Mat3& R, const Mat3& a, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const Ref c = R[j][j], s = R[j][k];
  const Ref sum = dag.add(a[j][k], a[k][j]);
  const Ref w = dag.sub(dag.mul(s, dag.sub(a[k][k], a[j][j])), dag.mul(c, sum));
  Mat3 result = a;
  result[j][j] = dag.add(a[j][j], dag.mul(s, w));
  result[k][k] = dag.sub(a[k][k], dag.mul(s, w));
  result[j][k] = dag.neg(dag.add(dag.mul(c, w), a[k][j]));
  result[k][j] = dag.neg(dag.add(dag.mul(c, w), a[j][k]));
  result[i][j] = dag.sub(dag.mul(c, a[i][j]), dag.mul(s, a[i][k]));
  result[i][k] = dag.add(dag.mul(s, a[i][j]), dag.mul(c, a[i][k]));
  result[j][i] = dag.sub(dag.mul(c, a[j][i]), dag.mul(s, a[k][i]));
  result[k][i] = dag.add(dag.mul(s, a[j][i]), dag.mul(c, a[k][i]));
  return result;
}

}  // namespace

Vec3 RotationSequence::to_own_axes(Dag& dag, Vec3 v) const {
  for (const RotationStep& step : steps) v = times(dag, step.R, v);
  return v;
}

Vec3 RotationSequence::to_parent(Dag& dag, Vec3 v) const {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) v = times(dag, transposed(step->R), v);
  return v;
}

Mat3 RotationSequence::to_parent(Dag& dag, Mat3 a, bool symmetric) const {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const std::size_t axis = axis_of(dag, step->R);
    if (axis < 3 && dag.is_one(step->R[(axis + 1) % 3][(axis + 1) % 3])) continue;  // the same axes
    if (axis < 3 && !dag.is_constant(step->R[(axis + 1) % 3][(axis + 1) % 3])) {
      a = symmetric ? about_axis_to_parent(dag, step->R, a, axis) : any_about_axis_to_parent(dag, step->R, a, axis);
      continue;
    }
    a = product(dag, product(dag, transposed(step->R), a), step->R);
    if (!symmetric) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < i; ++k) a[i][k] = a[k][i];
    }
  }
  return a;
}

RotationSequence RotationSequence::reversed() const {
  RotationSequence result;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) result.steps.push_back({transposed(step->R), {}, {}});
  return result;
}

}  // namespace eomgen::derive
