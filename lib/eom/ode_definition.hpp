// SPDX-License-Identifier: MIT
// The methods for right-hand sides of any type. Compiled where the code of runs is (eom/compiled.hpp). In, out: as
// ode.hpp.
#pragma once

#include <string_view>
#include <utility>

#include "eom/ode.hpp"

namespace eom::detail {

EOM_RUNTIME_INLINE Result integrate_system(std::string_view method, System system, const InitialValues& values,
                                           ObserverRef observer, AfterStepRef after_step, IntegrationLayout) {
  Result result;
  const auto by = [&]<class T>(T*) {
    if constexpr (explicit_rk::Tableau<T>) {
      return false;
    } else {
      if (!is_method<T>(method, values.options)) return false;
      require_eligible(info_of<T>, system, values.x0.size() - values.options.quadratures);
      if constexpr (requires { T::check(system, values.t0, values.x0, values.options); })
        T::check(system, values.t0, values.x0, values.options);
      result = run<T>(system, values, observer, after_step);
      return true;
    }
  };
  if (!by(static_cast<Automatic*>(nullptr)) && !any_method(by)) throw_unknown(method);
  return result;
}

EOM_RUNTIME_INLINE Result integrate_any_system(std::string_view method, System system, const InitialValues& values,
                                               ObserverRef observer, AfterStepRef after_step, IntegrationLayout) {
  return integrate_by_name(method, system, values, observer, after_step);
}

}  // namespace eom::detail
