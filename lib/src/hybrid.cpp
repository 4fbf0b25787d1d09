// SPDX-License-Identifier: MIT
// The library eomgen_hybrid: the code of runs, compiled once (eom/compiled.hpp).
#include <stdexcept>
#include <string>

namespace eom::hybrid {
namespace {

[[noreturn]] void report_precondition(const char* condition) {
  throw std::logic_error(std::string("a precondition of Eigen is violated: ") + condition);
}

}  // namespace
}  // namespace eom::hybrid

// An error in this library ends the run and not the program, which may be the host of an FMU.
#define eigen_assert(condition) \
  static_cast<void>((condition) ? static_cast<void>(0) : eom::hybrid::report_precondition(#condition))

#include <eom/hybrid/external_steps_definition.hpp>
#include <eom/hybrid/integration_definition.hpp>
#include <eom/hybrid/momentum_jump_definition.hpp>
#include <eom/hybrid/run_definition.hpp>
#include <eom/hybrid/stepwise_integration.hpp>
#include <eom/ode_definition.hpp>
