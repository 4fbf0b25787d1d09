// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  w.turn(w.now.vector(given(force, "moment")), argument(force, "on")->index);
}

}  // namespace

Statement moment() { return {act}; }

}  // namespace eomgen::verify::forces
