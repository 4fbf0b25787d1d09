// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {

const ForceLaw& force_law(std::string_view kind) {
#define FORCE(name) {#name, name()},
  static const std::map<std::string_view, ForceLaw> all{
#include "forces/registry.inc"
  };
#undef FORCE
  return all.at(kind);
}

}  // namespace eomgen::verify::forces
