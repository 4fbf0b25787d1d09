// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/kernels.hpp"

#include "emit/metadata.hpp"
#include "skeletons/kernels_sincos.hpp"
#include "skeletons/kernels_sincos_lanes.hpp"

namespace eomgen::emit {

std::string sincos_kernel(const std::string& prefix, const std::string& linkage, const std::string& standard) {
  std::vector<std::pair<std::string, std::string>> values = {{"prefix", prefix}, {"inline", linkage}, {"std", standard}};
  const std::string lanes = rendered(skeleton::kernels_sincos_lanes, values, {});
  values.emplace_back("lanes", lanes);
  return rendered(skeleton::kernels_sincos, values, {});
}

}  // namespace eomgen::emit
