// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/impulse_in_digits.hpp"

#include <algorithm>

#include "error.hpp"
#include "numeric/elimination.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using cln::cl_F;
using cln::cl_R;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

ImpulseInDigits::ImpulseInDigits(const system::EquationSystem& system, const std::vector<double>& parameters)
    : system_(system), parameters_(parameters) {
  symbolic::Dag& dag = *system.dag;
  const Ref lagrangian = dag.sub(system.kinetic, system.potential);
  for (const std::uint32_t q : system.free)
    momenta_.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, q, 1})(lagrangian));
}

std::vector<cl_R> ImpulseInDigits::values(const std::vector<Ref>& roots, const cl_R& t, const std::vector<double>& u,
                                          const std::vector<cl_F>& x, int digits) const {
  const std::size_t n = system_.free.size();
  const auto at = [&](const Symbol& symbol) -> cl_R {
    switch (symbol.kind) {
      case SymbolKind::time: return t;
      case SymbolKind::parameter: return numeric::exact(parameters_[symbol.index]);
      case SymbolKind::input: return numeric::exact(u[symbol.index]);
      case SymbolKind::branch: return 0;
      case SymbolKind::coordinate: {
        const auto place = std::find(system_.free.begin(), system_.free.end(), symbol.index) - system_.free.begin();
        return x.at(static_cast<std::size_t>(place) + (symbol.order == 1 ? n : 0));
      }
      case SymbolKind::state:
      case SymbolKind::integral:
        for (std::size_t i = 0; i < system_.states.size(); ++i) {
          if (system_.states[i].symbol == symbol) return x.at(system_.layout().first_order_begin() + i);
        }
        break;
      default: break;
    }
    throw Error("bench", {}, "an impulse depends on a quantity that has no value in many digits",
                "shorten the run (--t-end) to before it", ErrorKind::numerical);
  };
  return symbolic::evaluate(*system_.dag, roots, at, digits);
}

void ImpulseInDigits::apply(const Kink& kink, std::vector<cl_F>& x, int digits) const {
  std::vector<cl_R> impulse = values(momenta_, numeric::exact(kink.before), kink.u_before, x, digits);
  const std::vector<cl_R> behind = values(momenta_, numeric::exact(kink.behind), kink.u_behind, x, digits);
  for (std::size_t i = 0; i < impulse.size(); ++i) impulse[i] = impulse[i] - behind[i];
  change(impulse, numeric::exact(kink.behind), kink.u_behind, x, digits);
}

void ImpulseInDigits::make_consistent(const cl_R& t, const std::vector<double>& u, std::vector<cl_F>& x,
                                      int digits) const {
  if (!system_.active.empty()) change(std::vector<cl_R>(system_.free.size(), 0), t, u, x, digits);
}

void ImpulseInDigits::change(const std::vector<cl_R>& impulse, const cl_R& t, const std::vector<double>& u,
                             std::vector<cl_F>& x, int digits) const {
  const std::size_t n = system_.free.size(), m = system_.active.size();
  const std::vector<cl_R> M = values(system_.M, t, u, x, digits), A = values(system_.A, t, u, x, digits),
                          b = values(system_.b, t, u, x, digits);
  // (M  -A^T) (qdot+ - qdot-)   (impulse       )
  // (A   0  ) (   Lambda     ) = (-b+ - A qdot- )
  numeric::Matrix<cl_R> K(n + m, n + m), right(n + m, 1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) K(i, j) = M[i * n + j];
    right(i, 0) = impulse[i];
  }
  for (std::size_t k = 0; k < m; ++k) {
    right(n + k, 0) = -b[k];
    for (std::size_t j = 0; j < n; ++j) {
      K(n + k, j) = A[k * n + j];
      K(j, n + k) = -A[k * n + j];
      right(n + k, 0) = right(n + k, 0) - A[k * n + j] * x[n + j];
    }
  }
  const numeric::Elimination<cl_R> factors(std::move(K), 0);
  if (factors.rank() < n + m) {
    throw Error("bench", {}, "an impulse is not determined: the constraints depend on one another there",
                "shorten the run (--t-end) to before it", ErrorKind::numerical);
  }
  const numeric::Matrix<cl_R> change = factors.solve(right);
  for (std::size_t i = 0; i < n; ++i) x[n + i] = x[n + i] + cln::cl_float(change(i, 0), cln::float_format(x[n + i]));
}

}  // namespace eomgen::analysis
