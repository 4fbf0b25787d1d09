// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical functions that emitted code includes: templates/kernels/.
#pragma once

#include <string>

namespace eomgen::emit {

/// PREFIXsincos(a, b, sines, cosines) in C for double, or for float if `single`, with PREFIXsincos_near and
/// PREFIXis_near (templates/kernels/sincos). `linkage`: "static inline", "inline"; `standard`: prefix of C library
/// functions, "" or "std::".
std::string sincos_kernel(const std::string& prefix, const std::string& linkage, const std::string& standard,
                          bool single = false);

/// PREFIXsincos_lanes only, for lanes of the width of PREFIXlanes and PREFIXbits.
std::string sincos_lanes(const std::string& prefix, const std::string& linkage, const std::string& standard,
                         bool single = false);

/// eom_sincos of other types than double, by the functions of the type or of std; `mark`: "", or what a device needs
/// before it.
std::string generic_sincos(const std::string& mark);

}  // namespace eomgen::emit
