// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/kernels.hpp"

#include "emit/metadata.hpp"
#include "skeletons/kernels_sincos.hpp"
#include "skeletons/kernels_sincos_lanes.hpp"

namespace eomgen::emit {

std::string sincos_lanes(const std::string& prefix, const std::string& linkage, const std::string& standard) {
  return rendered(skeleton::kernels_sincos_lanes, {{"prefix", prefix}, {"inline", linkage}, {"std", standard}}, {});
}

std::string sincos_kernel(const std::string& prefix, const std::string& linkage, const std::string& standard) {
  std::vector<std::pair<std::string, std::string>> values = {
      {"prefix", prefix}, {"inline", linkage}, {"std", standard}};
  values.emplace_back("lanes", sincos_lanes(prefix, linkage, standard));
  return rendered(skeleton::kernels_sincos, values, {});
}

}  // namespace eomgen::emit
