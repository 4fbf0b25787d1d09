// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/small_matrix.hpp"

#include "reading/lagrangian.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

std::vector<Sum> minor(const std::vector<Sum>& matrix, std::size_t n, std::size_t row, std::size_t column) {
  std::vector<Sum> result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (i != row && k != column) result.push_back(matrix[i * n + k]);
    }
  }
  return result;
}

}  // namespace

Sum determinant(const std::vector<Sum>& matrix, std::size_t n) {
  if (n == 0) return 1;
  Sum result;
  for (std::size_t k = 0; k < n; ++k) {
    if (matrix[k].is_zero()) continue;
    const Sum part = matrix[k] * determinant(minor(matrix, n, 0, k), n - 1);
    result += k % 2 == 0 ? part : -part;
  }
  return simplify(result);
}

std::vector<Sum> inverse_matrix(const std::vector<Sum>& matrix, std::size_t n) {
  const Sum whole = determinant(matrix, n);
  std::vector<Sum> result;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const Sum cofactor = determinant(minor(matrix, n, k, i), n - 1);
      result.push_back(simplify(quotient((i + k) % 2 == 0 ? cofactor : -cofactor, whole)));
    }
  }
  return result;
}

std::vector<Sum> mass_matrix(GinacBridge& bridge, const Sum& kinetic, const std::vector<std::uint32_t>& coordinates) {
  const std::size_t n = coordinates.size();
  std::vector<Sum> result(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Sum momentum = bridge.derivative(kinetic, coordinate_symbol(coordinates[i], 1));
    for (std::size_t k = i; k < n; ++k) {
      result[i * n + k] = result[k * n + i] = bridge.derivative(momentum, coordinate_symbol(coordinates[k], 1));
    }
  }
  return result;
}

}  // namespace eomgen::reading
