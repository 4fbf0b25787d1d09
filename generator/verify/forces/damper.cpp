// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/forces/statement.hpp"

namespace eomgen::verify::forces {
namespace {

void act(const model::Force& force, VirtualWork& w) {
  const model::NodeId a = given(force, "a"), b = given(force, "b");
  const Jet length = norm(w.later().vector(b) - w.later().vector(a), w.precision);
  const Jet tension = w.now.scalar(given(force, "coefficient")) * length.slope(w.later().level(), 0);
  const Vector along = w.now.vector(b) - w.now.vector(a);
  w.apply((-tension / norm(along, w.precision)) * along, w.by_q.vector(b) - w.by_q.vector(a));
}

}  // namespace

Statement damper() { return {act}; }

}  // namespace eomgen::verify::forces
