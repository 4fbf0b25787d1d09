// SPDX-License-Identifier: MIT
// Compiled where the code of runs is (compiled_runtime.hpp). In, out: as momentum_jump.hpp.
#pragma once

#include <Eigen/QR>
#include <vector>

#include "eom/hybrid/momentum_jump.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE std::vector<double> rates_of_momenta(const std::vector<double>& M, const std::vector<double>& p) {
  const auto n = static_cast<Eigen::Index>(p.size());
  std::vector<double> rates(p.size());
  Eigen::Map<Eigen::VectorXd>(rates.data(), n) =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(Eigen::Map<const Eigen::MatrixXd>(M.data(), n, n))
          .solve(Eigen::Map<const Eigen::VectorXd>(p.data(), n));
  return rates;
}

}  // namespace eom::hybrid
