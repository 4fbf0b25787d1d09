// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical functions that emitted code brings along: templates/kernels/.
#pragma once

#include <string>

namespace eomgen::emit {

/// PREFIXsincos(a, b, sines, cosines) for double, or for float where `single`, in C, and PREFIXsincos_near,
/// PREFIXis_near (templates/kernels/sincos). `linkage`: "static inline", "inline"; `standard`: what functions of the C
/// library are called by, "" or "std::".
std::string sincos_kernel(const std::string& prefix, const std::string& linkage, const std::string& standard,
                          bool single = false);

/// PREFIXsincos_lanes alone, for lanes of whatever width PREFIXlanes and PREFIXbits have.
std::string sincos_lanes(const std::string& prefix, const std::string& linkage, const std::string& standard,
                         bool single = false);

}  // namespace eomgen::emit
