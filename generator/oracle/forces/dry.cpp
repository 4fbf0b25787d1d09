// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_dry(const model::Force&, VirtualWork&) {}  // computed with the contacts (State::friction)

}  // namespace

ForceLaw dry() { return {add_dry}; }

}  // namespace eomgen::verify::forces
