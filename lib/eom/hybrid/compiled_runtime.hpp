// SPDX-License-Identifier: MIT
// Where the code of runs is compiled. Without EOM_COMPILED_RUNTIME each file that includes run.hpp, stepwise_run.hpp or
// external_steps.hpp compiles it (about a minute). With it these headers only declare, and the program links the
// library eomgen_hybrid (CMake: eomgen::hybrid, which defines the macro). In: the types that a program and the library
// share. Out: RuntimeLayout, which a program and a library of other headers do not share.
#pragma once

#include <cstddef>

#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/run_result.hpp"
#include "eom/run_types.hpp"
#include "eom/version.hpp"

#ifdef EOM_COMPILED_RUNTIME
#define EOM_RUNTIME_INLINE
#else
#define EOM_RUNTIME_INLINE inline
#endif

namespace eom::hybrid {

/// Part of the names of compiled functions: a program does not link with a library of another version, or one whose
/// types have other sizes (also those of the standard library).
template <unsigned version, std::size_t... sizes>
struct Layout {};
using RuntimeLayout = Layout<EOM_VERSION, sizeof(Problem), sizeof(Code), sizeof(Contact), sizeof(contacts::Set),
                             sizeof(Signal), sizeof(Sample), sizeof(WatchedEvent), sizeof(expressions::Table),
                             sizeof(expressions::Step), sizeof(RunResult), sizeof(EndErrorEstimate), sizeof(Reason),
                             sizeof(Event), sizeof(MethodChoice), sizeof(Statistics), sizeof(Result)>;

}  // namespace eom::hybrid
