// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>

#include "jit/steps.hpp"

namespace eomgen::jit {

std::uint32_t Constants::index(double value) {
  const auto [found, is_new] =
      index_.try_emplace(std::bit_cast<std::uint64_t>(value), static_cast<std::uint32_t>(values_.size()));
  if (is_new) values_.push_back(value);
  return found->second;
}

}  // namespace eomgen::jit
