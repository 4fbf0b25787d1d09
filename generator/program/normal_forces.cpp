// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/normal_forces.hpp"

#include "program/elimination.hpp"

namespace eomgen::program {

using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;

namespace {

constexpr int iterations = 7;  // quadratic convergence: from a change by half to rounding in six

class Iteration {
 public:
  Iteration(Dag& dag, const std::vector<CurveForce>& curves) : dag_(dag), curves_(curves) {}

  NormalForces run() {
    const std::size_t n = curves_.size();
    NormalForces result;
    for (const CurveForce& c : curves_) result.nu.push_back(root(form(c, c.a, c.a)));
    Ref last = dag_.zero();
    for (int k = 0; k < iterations; ++k) {
      const std::vector<Ref> step = newton(result.nu);
      last = dag_.zero();
      for (std::size_t c = 0; c < n; ++c) {
        const Ref half = dag_.div(result.nu[c], dag_.integer(2));
        const Ref next = dag_.call(Op::max, dag_.add(result.nu[c], step[c]), half);
        last = dag_.call(Op::max, last, dag_.call(Op::abs, dag_.sub(next, result.nu[c])));
        result.nu[c] = next;
      }
    }
    Ref size = dag_.zero();
    for (const Ref nu : result.nu) size = dag_.call(Op::max, size, nu);
    const symbolic::Rational enough =
        symbolic::Rational(1) / 1000000000;  // its square, the remaining error, is at rounding level
    result.solution_margin = dag_.sub(dag_.mul(dag_.constant(enough), size), last);
    // At rest without any normal force the iteration has converged.
    result.solution_margin = dag_.select(dag_.zero(), size, result.solution_margin, dag_.one());
    result.multiplicity = dag_.integer(-1);  // the number of solutions is unknown in that case
    return result;
  }

  // One curve: nu^2 = a.Ga + 2 nu a.Gb + nu^2 b.Gb, with one positive solution if b.Gb < 1.
  NormalForces closed() const {
    const CurveForce& c = curves_[0];
    const Ref A = form(c, c.a, c.a), half = form(c, c.a, c.b[0]),
              margin = dag_.sub(dag_.one(), form(c, c.b[0], c.b[0]));
    const Ref discriminant = dag_.add(dag_.mul(half, half), dag_.mul(margin, A));
    // Otherwise the roots have the same sign. Both are solutions if their sum 2 half/margin is positive.
    return {{dag_.div(dag_.add(half, root(discriminant)), margin)},
            margin,
            dag_.call(Op::min, dag_.neg(half), discriminant)};
  }

 private:
  Ref root(Ref r) const { return dag_.call(Op::sqrt, r); }
  Ref form(const CurveForce& c, const std::array<Ref, 2>& x, const std::array<Ref, 2>& y) const {
    Ref sum = dag_.zero();
    for (std::size_t k = 0; k < 4; ++k) sum = dag_.add(sum, dag_.mul(c.gram[k], dag_.mul(x[k / 2], y[k % 2])));
    return sum;
  }

  // F_c = nu_c - |lambda_c|, dF_c/dnu_d = delta_cd - (b_d . G lambda)/|lambda|; the solution of F' step = -F.
  std::vector<Ref> newton(const std::vector<Ref>& nu) const {
    const std::size_t n = nu.size();
    std::vector<Ref> matrix(n * n), right(n);
    for (std::size_t c = 0; c < n; ++c) {
      std::array<Ref, 2> lambda = curves_[c].a;
      for (std::size_t d = 0; d < n; ++d) {
        for (std::size_t k = 0; k < 2; ++k) lambda[k] = dag_.add(lambda[k], dag_.mul(curves_[c].b[d][k], nu[d]));
      }
      const Ref size = root(form(curves_[c], lambda, lambda));
      right[c] = dag_.sub(size, nu[c]);
      for (std::size_t d = 0; d < n; ++d) {
        const Ref slope = dag_.div(form(curves_[c], curves_[c].b[d], lambda), size);
        matrix[c * n + d] = dag_.sub(c == d ? dag_.one() : dag_.zero(), slope);
      }
    }
    std::vector<std::vector<Ref>> sides{std::move(right)};
    eliminate(dag_, std::move(matrix), sides);
    return std::move(sides[0]);
  }

  Dag& dag_;
  const std::vector<CurveForce>& curves_;
};

}  // namespace

NormalForces coupled_normal_forces(Dag& dag, const std::vector<CurveForce>& curves) {
  Iteration iteration(dag, curves);
  return curves.size() == 1 ? iteration.closed() : iteration.run();
}

}  // namespace eomgen::program
