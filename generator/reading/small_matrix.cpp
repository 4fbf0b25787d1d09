// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/small_matrix.hpp"

#include <algorithm>

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

/// By the first row.
Sum expanded_determinant(const std::vector<Sum>& matrix, std::size_t n) {
  if (n == 0) return 1;
  Sum result;
  for (std::size_t k = 0; k < n; ++k) {
    if (matrix[k].is_zero()) continue;
    const Sum part = matrix[k] * expanded_determinant(minor(matrix, n, 0, k), n - 1);
    result += k % 2 == 0 ? part : -part;
  }
  return simplify(result);
}

/// The indices of each diagonal block, in ascending order: an entry outside the blocks is zero. Many free coordinates
/// have many small blocks, for which expansions take no time.
std::vector<std::vector<std::size_t>> diagonal_blocks(const std::vector<Sum>& matrix, std::size_t n) {
  std::vector<bool> seen(n, false);
  std::vector<std::vector<std::size_t>> result;
  for (std::size_t first = 0; first < n; ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> block = {first};
    seen[first] = true;
    for (std::size_t j = 0; j < block.size(); ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        if (seen[k] || (matrix[block[j] * n + k].is_zero() && matrix[k * n + block[j]].is_zero())) continue;
        seen[k] = true;
        block.push_back(k);
      }
    }
    std::sort(block.begin(), block.end());
    result.push_back(std::move(block));
  }
  return result;
}

std::vector<Sum> submatrix(const std::vector<Sum>& matrix, std::size_t n, const std::vector<std::size_t>& indices) {
  std::vector<Sum> result;
  for (const std::size_t i : indices) {
    for (const std::size_t k : indices) result.push_back(matrix[i * n + k]);
  }
  return result;
}

}  // namespace

Sum determinant(const std::vector<Sum>& matrix, std::size_t n) {
  Sum result(1);
  for (const std::vector<std::size_t>& block : diagonal_blocks(matrix, n))
    result = result * expanded_determinant(submatrix(matrix, n, block), block.size());
  return simplify(result);
}

std::vector<Sum> inverse_matrix(const std::vector<Sum>& matrix, std::size_t n) {
  std::vector<Sum> result(n * n);
  for (const std::vector<std::size_t>& block : diagonal_blocks(matrix, n)) {
    const std::size_t size = block.size();
    const std::vector<Sum> part = submatrix(matrix, n, block);
    const Sum whole = expanded_determinant(part, size);
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t k = 0; k < size; ++k) {
        const Sum cofactor = expanded_determinant(minor(part, size, k, i), size - 1);
        result[block[i] * n + block[k]] = simplify(quotient((i + k) % 2 == 0 ? cofactor : -cofactor, whole));
      }
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
