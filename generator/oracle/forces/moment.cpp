// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_moment(const model::Force& force, VirtualWork& w) {
  w.apply_moment(w.now.vector(argument_expression(force, "moment")), argument(force, "on")->index);
}

}  // namespace

ForceLaw moment() { return {add_moment}; }

}  // namespace eomgen::verify::forces
