// SPDX-License-Identifier: GPL-3.0-or-later
// integrate() of a System, compiled once for all stages (methods.cpp) instead of in each file.
#pragma once

#include <eom/ode.hpp>

namespace eom::detail {

extern template Result integrate_system(std::string_view, System, const InitialValues&, ObserverRef, NoProjection);
extern template Result integrate_system(std::string_view, System, const InitialValues&, ObserverRef, AfterStepRef);
extern template Result integrate_by_name(std::string_view, System&, const InitialValues&, ObserverRef, NoProjection);
extern template Result integrate_by_name(std::string_view, System&, const InitialValues&, ObserverRef, AfterStepRef);

}  // namespace eom::detail
