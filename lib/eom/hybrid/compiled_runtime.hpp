// SPDX-License-Identifier: MIT
// The compiled code of runs (eom/compiled.hpp). In: the types that a program and the library share. Out: RuntimeLayout,
// which a program and a library of other headers do not share.
#pragma once

#include "eom/compiled.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/run_result.hpp"
#include "eom/run_types.hpp"
#include "eom/version.hpp"

namespace eom::hybrid {

using RuntimeLayout =
    eom::detail::Layout<EOM_VERSION, sizeof(Problem), sizeof(Code), sizeof(Contact), sizeof(contacts::Set),
                        sizeof(Signal), sizeof(Sample), sizeof(WatchedEvent), sizeof(expressions::Table),
                        sizeof(expressions::Step), sizeof(RunResult), sizeof(EndErrorEstimate), sizeof(Reason),
                        sizeof(Event), sizeof(MethodChoice), sizeof(Statistics), sizeof(Result)>;

}  // namespace eom::hybrid
