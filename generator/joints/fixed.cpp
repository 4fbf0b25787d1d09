// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/kinds.hpp"

namespace eomgen::joints {

Joint fixed() {
  return {"fixed", "no motion of one against the other", AxisLayout::none,
          concatenate({same_point(),
                       {{"dot(f1, g2)", "", "cross(g2, f1)"},
                        {"dot(f2, g3)", "", "cross(g3, f2)"},
                        {"dot(f3, g1)", "", "cross(g1, f3)"}}})};
}

}  // namespace eomgen::joints
