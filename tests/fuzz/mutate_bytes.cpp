// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "commands.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace eomgen::fuzz {

std::size_t mutate_bytes(const std::vector<Words>& calls, std::uint8_t* data, std::size_t size, std::size_t most,
                         unsigned seed) {
  if (seed % 16 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string text = mutate(calls, {reinterpret_cast<const char*>(data), size}, seed);
  if (text.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::copy(text.begin(), text.end(), data);
  return text.size();
}

}  // namespace eomgen::fuzz
