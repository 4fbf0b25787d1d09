// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force&, VirtualWork&) {}  // computed with the contacts (State::friction)

}  // namespace

Statement dry() { return {act}; }

}  // namespace eomgen::verify::forces
