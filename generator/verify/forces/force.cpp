// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  w.apply(w.now.vector(given(force, "force")), w.by_q.vector(given(force, "on")));
}

}  // namespace

Statement force() { return {act}; }

}  // namespace eomgen::verify::forces
