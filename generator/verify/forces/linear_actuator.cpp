// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  const Vector d = w.by_q.vector(given(force, "b")) - w.by_q.vector(given(force, "a"));
  w.work(w.now.scalar(given(force, "force")), norm(d, w.precision));  // along the distance
}

}  // namespace

Statement linear_actuator() { return {act}; }

}  // namespace eomgen::verify::forces
