// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/eigenvalues.hpp"

#include <fmt/format.h>

#include <cmath>

namespace eomgen::cli {

using linear::Precise;

Json eigenvalue_json(const linear::Eigenvalue& e) {
  Json result{{"re", e.re}, {"im", e.im}};
  if (!e.is_reliable()) result["error"] = e.error;
  if (!e.is_in_binary64) result["in_binary64"] = false;
  return result;
}

std::string eigenvalue_text(const linear::Spectrum& spectrum, std::size_t i) {
  const linear::Eigenvalue& e = spectrum.values[i];
  const std::string doubt = e.is_reliable()    ? ""
                            : e.is_in_binary64 ? fmt::format("   (good to {:.1g} only)", e.error)
                                               : "   (not confirmed by binary64)";
  if (e.im == 0) return fmt::format("{:.10g}{}", e.re, doubt);
  return fmt::format("{:.10g} {} {:.10g}i{}", e.re, e.im < 0 ? "-" : "+", std::abs(e.im), doubt);
}

}  // namespace eomgen::cli
