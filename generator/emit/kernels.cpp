// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/kernels.hpp"

#include "emit/metadata.hpp"
#include "skeletons/kernels_sincos.hpp"
#include "skeletons/kernels_sincos_generic.hpp"
#include "skeletons/kernels_sincos_lanes.hpp"
#include "skeletons/kernels_sincos_lanes_single.hpp"

namespace eomgen::emit {

std::string sincos_lanes(const std::string& prefix, const std::string& linkage, const std::string& standard,
                         bool single) {
  return render_template(single ? skeleton::kernels_sincos_lanes_single : skeleton::kernels_sincos_lanes,
                         {{"prefix", prefix}, {"inline", linkage}, {"std", standard}}, {});
}

std::string sincos_kernel(const std::string& prefix, const std::string& linkage, const std::string& standard,
                          bool single) {
  std::vector<std::pair<std::string, std::string>> values = {
      {"prefix", prefix}, {"inline", linkage}, {"std", standard}};
  values.emplace_back("lanes", sincos_lanes(prefix, linkage, standard, single));
  values.emplace_back("real", single ? "float" : "double");
  values.emplace_back("bits", single ? "unsigned int" : "unsigned long long");
  values.emplace_back("f", single ? "f" : "");
  values.emplace_back("far", single ? "2048" : "65536");
  values.emplace_back("reach", single ? "2048.0f" : "65536.0");
  values.emplace_back("kept", single ? "FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 16"
                                     : "FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 1 || FLT_EVAL_METHOD == 16");
  return render_template(skeleton::kernels_sincos, values, {});
}

std::string generic_sincos(const std::string& mark) {
  return render_template(skeleton::kernels_sincos_generic, {{"mark", mark}}, {});
}

}  // namespace eomgen::emit
