// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/methods.hpp"

namespace eom::detail {

template Result integrate_system(std::string_view, System, const InitialValues&, ObserverRef, NoProjection);
template Result integrate_system(std::string_view, System, const InitialValues&, ObserverRef, AfterStepRef);
template Result integrate_by_name(std::string_view, System&, const InitialValues&, ObserverRef, NoProjection);
template Result integrate_by_name(std::string_view, System&, const InitialValues&, ObserverRef, AfterStepRef);

}  // namespace eom::detail
