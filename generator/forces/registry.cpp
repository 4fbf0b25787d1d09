// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {
namespace {

const std::vector<Kind>& all() {
#define FORCE(name) name(),
  static const std::vector<Kind> kinds{
#include "forces/registry.inc"
  };
#undef FORCE
  return kinds;
}

}  // namespace

std::span<const Kind> registry() { return all(); }

const Kind* find(std::string_view name) {
  for (const Kind& kind : registry()) {
    if (kind.name == name) return &kind;
  }
  return nullptr;
}

}  // namespace eomgen::forces
