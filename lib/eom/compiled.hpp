// SPDX-License-Identifier: MIT
// Where code that needs no types of a program is compiled. Without EOM_COMPILED_RUNTIME each file that includes
// ode.hpp, hybrid/run.hpp, hybrid/stepwise_run.hpp or hybrid/external_steps.hpp compiles what it uses (up to a minute).
// With it these headers only declare, and the program links the library eomgen_hybrid (CMake: eomgen::hybrid, which
// defines the macro).
#pragma once

#include <cstddef>

#ifdef EOM_COMPILED_RUNTIME
#define EOM_RUNTIME_INLINE
#else
#define EOM_RUNTIME_INLINE inline
#endif

namespace eom::detail {

/// Part of the names of compiled functions: a program does not link with a library of another version, or one whose
/// types have other sizes (also those of the standard library).
template <unsigned version, std::size_t... sizes>
struct Layout {};

}  // namespace eom::detail
