// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/operations.hpp"

#include <fmt/format.h>

namespace eomgen::cli {

Json to_json(const program::Operations& o) { return EOMGEN_MEMBERS(o, add, mul, div, sqrt, trig, other); }

std::string to_text(const program::Operations& o) {
  std::string text = fmt::format("{} {} ({} add, {} mul)", o.flops(), o.flops() == 1 ? "flop" : "flops", o.add, o.mul);
  if (o.div > 0) text += fmt::format(", {} div", o.div);
  if (o.sqrt > 0) text += fmt::format(", {} sqrt", o.sqrt);
  if (o.trig > 0) text += fmt::format(", {} trig", o.trig);
  if (o.other > 0) text += fmt::format(", {} other", o.other);
  return text;
}

}  // namespace eomgen::cli
