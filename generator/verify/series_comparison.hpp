// SPDX-License-Identifier: GPL-3.0-or-later
// The Taylor series of a solution against the differential equation. In: the functions `taylor` and `rhs` of a program,
// arguments. Out: the difference between the rate of the series and the right-hand side a short time later.
#pragma once

#include <functional>
#include <optional>

#include "verify/certificate.hpp"

namespace eomgen::verify {

/// The largest relative difference; nothing if a function has no value. digits: those that are compared.
/// sizes: of the terms of dx, for their rounding; empty if they are unknown.
std::optional<double> series_difference(const ProgramForm& program, const AbiArguments& at, int digits,
                                        const std::function<AbiResults(const AbiResults& rhs)>& sizes);

}  // namespace eomgen::verify
