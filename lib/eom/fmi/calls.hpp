// SPDX-License-Identifier: MIT
// Parts that the functions of both versions of FMI share: an instance with its logger, and the translation of
// exceptions to a status. In: a call. Out: its status; the reason of a failure goes to the importer's logger.
#pragma once

#include <exception>
#include <string>

#include "eom/fmi/instance.hpp"

namespace eom::fmi {

/// The numbers of fmi2Status and fmi3Status.
enum Status : int { ok = 0, warning = 1, discard = 2, error = 3, fatal = 4 };

/// `Log`: a callable (status, category, message).
template <class Log>
struct Component {
  Component(bool co_simulation, Log logger) : log(std::move(logger)), instance(model_code(), co_simulation) {}
  Log log;
  Instance instance;
};

/// Calls f(component), which may throw.
template <class Log, class Call>
int guarded(void* handle, Call&& call) {
  if (handle == nullptr) return error;
  auto& component = *static_cast<Component<Log>*>(handle);
  try {
    call(component.instance);
    return ok;
  } catch (const Discard& none) {
    component.log(discard, "logStatusDiscard", none.what());
    return discard;
  } catch (const std::exception& wrong) {
    component.log(error, "logStatusError", wrong.what());
    return error;
  }
}

}  // namespace eom::fmi
