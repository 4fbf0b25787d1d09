// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>

#include "jit/steps.hpp"

namespace eomgen::jit {

std::uint32_t Constants::index(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  const auto [found, is_new] = index_.try_emplace(bits, static_cast<std::uint32_t>(values_.size()));
  if (is_new) values_.push_back(value);
  return found->second;
}

}  // namespace eomgen::jit
