// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>

#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {

const Statement& statement(std::string_view kind) {
#define FORCE(name) {#name, name()},
  static const std::map<std::string_view, Statement> all{
#include "forces/registry.inc"
  };
#undef FORCE
  return all.at(kind);
}

}  // namespace eomgen::verify::forces
