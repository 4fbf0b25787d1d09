// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/vectors.hpp"

#include <algorithm>

namespace eomgen::symbolic {
namespace {

/// The matrix entry in row i and column k is C[i * row + k * column].
std::vector<Ref> product(Dag& dag, const std::vector<Rational>& C, const std::vector<Ref>& x, std::size_t row,
                         std::size_t column) {
  const std::size_t n = x.size();
  std::vector<Ref> result(n, dag.zero());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = n; k-- > 0;) {
      const Rational& c = C[i * row + k * column];
      if (!cln::zerop(c)) result[i] = dag.add(result[i], dag.mul(dag.constant(c), x[k]));
    }
  }
  return result;
}

}  // namespace

bool is_zero(const Dag& dag, const Vec3& a) {
  return std::all_of(a.begin(), a.end(), [&dag](Ref r) { return dag.is_zero(r); });
}

Vec3 add(Dag& dag, const Vec3& a, const Vec3& b) {
  return {dag.add(a[0], b[0]), dag.add(a[1], b[1]), dag.add(a[2], b[2])};
}

Vec3 subtract(Dag& dag, const Vec3& a, const Vec3& b) {
  return {dag.sub(a[0], b[0]), dag.sub(a[1], b[1]), dag.sub(a[2], b[2])};
}

Vec3 scale(Dag& dag, Ref factor, const Vec3& a) {
  return {dag.mul(factor, a[0]), dag.mul(factor, a[1]), dag.mul(factor, a[2])};
}

Ref dot(Dag& dag, const Vec3& a, const Vec3& b) {
  Ref sum = dag.mul(a[0], b[0]);
  for (std::size_t k = 1; k < 3; ++k) sum = dag.add(sum, dag.mul(a[k], b[k]));
  return sum;
}

Vec3 cross(Dag& dag, const Vec3& a, const Vec3& b) {
  Vec3 result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    result[k] = dag.sub(dag.mul(a[i], b[j]), dag.mul(a[j], b[i]));
  }
  return result;
}

std::vector<Ref> multiply(Dag& dag, const std::vector<Rational>& C, const std::vector<Ref>& x) {
  return product(dag, C, x, x.size(), 1);
}

std::vector<Ref> multiply_transposed(Dag& dag, const std::vector<Rational>& C, const std::vector<Ref>& x) {
  return product(dag, C, x, 1, x.size());
}

}  // namespace eomgen::symbolic
