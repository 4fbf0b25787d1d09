// SPDX-License-Identifier: MIT
// The functions of FMI 2.0 (Functional Mock-up Interface, version 2.0), for model exchange and co-simulation. One
// source file of an FMU includes this header. All variables are of type Real. In: calls of an importer. Out: those of
// an Instance.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "eom/fmi/calls.hpp"

namespace eom::fmi::fmi2 {

using Logger = void (*)(void* environment, const char* instance, int status, const char* category, const char* message,
                        ...);

struct Callbacks {
  Logger logger;
  void* (*allocate)(std::size_t, std::size_t);
  void (*release)(void*);
  void (*step_finished)(void*, int);
  void* environment;
};

struct EventInfo {
  int new_discrete_states_needed, terminate, nominals_changed, values_changed, has_next;
  double next;
};

/// The logger, and what the experiment was set up with.
struct Log {
  Logger logger = nullptr;
  void* environment = nullptr;
  std::string name = {};
  std::optional<double> tolerance = {}, start = {}, stop = {};
  bool terminated = false;  // an event of the model ended the co-simulation
  void operator()(int status, const char* category, const char* text) const {
    if (logger != nullptr) logger(environment, name.c_str(), status, category, "%s", text);
  }
};
using Handle = Component<Log>;
using ValueReference = unsigned int;
enum StatusKind : int { do_step_status = 0, pending_status = 1, last_successful_time = 2, is_terminated = 3 };

template <class Call>
int call(void* handle, Call&& what) {
  return guarded<Log>(handle, std::forward<Call>(what));
}
inline int none_of_this_type(void* handle, std::size_t count) {
  return call(handle, [count](Instance&) {
    if (count > 0) throw std::invalid_argument("all variables of this FMU are of type Real");
  });
}
inline int refuse(void* handle, const char* what) {
  return call(handle, [what](Instance&) { throw std::logic_error(what); });
}
inline void require_exchange(const Instance& instance) {
  if (instance.is_co_simulation() || instance.phase() != Phase::running)
    throw std::logic_error("this call belongs to model exchange after the initialization");
}

}  // namespace eom::fmi::fmi2

#define EOM_FMI2(result) extern "C" __attribute__((visibility("default"))) result
#define EOM_FMI2_OTHER_TYPE(name, type)                                                                     \
  EOM_FMI2(int) fmi2Get##name(void* c, const eom::fmi::fmi2::ValueReference*, std::size_t n, type*) {       \
    return eom::fmi::fmi2::none_of_this_type(c, n);                                                         \
  }                                                                                                         \
  EOM_FMI2(int) fmi2Set##name(void* c, const eom::fmi::fmi2::ValueReference*, std::size_t n, const type*) { \
    return eom::fmi::fmi2::none_of_this_type(c, n);                                                         \
  }

EOM_FMI2(const char*) fmi2GetTypesPlatform(void) { return "default"; }
EOM_FMI2(const char*) fmi2GetVersion(void) { return "2.0"; }
EOM_FMI2(int) fmi2SetDebugLogging(void* c, int, std::size_t, const char* const*) {
  return c == nullptr ? eom::fmi::error : eom::fmi::ok;
}
EOM_FMI2(void*)
fmi2Instantiate(const char* name, int type, const char* guid, const char*, const eom::fmi::fmi2::Callbacks* callbacks,
                int, int) {
  eom::fmi::fmi2::Log log;
  if (callbacks != nullptr) log.logger = callbacks->logger, log.environment = callbacks->environment;
  log.name = name == nullptr ? "" : name;
  try {
    if (guid == nullptr || std::strcmp(guid, eom::fmi::model_code().token) != 0)
      throw std::invalid_argument("the guid is that of another FMU");
    return new eom::fmi::fmi2::Handle(type == 1, log);
  } catch (const std::exception& wrong) {
    log(eom::fmi::error, "logStatusError", wrong.what());
    return nullptr;
  }
}
EOM_FMI2(void) fmi2FreeInstance(void* c) { delete static_cast<eom::fmi::fmi2::Handle*>(c); }
EOM_FMI2(int)
fmi2SetupExperiment(void* c, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
  if (c == nullptr) return eom::fmi::error;
  auto& log = static_cast<eom::fmi::fmi2::Handle*>(c)->log;
  log.tolerance = has_tolerance != 0 ? std::optional(tolerance) : std::nullopt;
  log.start = start;
  log.stop = has_stop != 0 ? std::optional(stop) : std::nullopt;
  return eom::fmi::ok;
}
EOM_FMI2(int) fmi2EnterInitializationMode(void* c) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    const auto& log = static_cast<eom::fmi::fmi2::Handle*>(c)->log;
    instance.enter_initialization(log.tolerance, log.start.value_or(instance.time()), log.stop);
  });
}
EOM_FMI2(int) fmi2ExitInitializationMode(void* c) {
  return eom::fmi::fmi2::call(c, [](eom::fmi::Instance& instance) { instance.exit_initialization(); });
}
EOM_FMI2(int) fmi2Terminate(void* c) {
  return eom::fmi::fmi2::call(c, [](eom::fmi::Instance& instance) { instance.terminate(); });
}
EOM_FMI2(int) fmi2Reset(void* c) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    auto& log = static_cast<eom::fmi::fmi2::Handle*>(c)->log;
    log.tolerance.reset(), log.start.reset(), log.stop.reset();
    log.terminated = false;
    instance.reset();
  });
}

EOM_FMI2(int)
fmi2GetReal(void* c, const eom::fmi::fmi2::ValueReference* references, std::size_t n, double* values) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    for (std::size_t i = 0; i < n; ++i) values[i] = instance.get(references[i]);
  });
}
EOM_FMI2(int)
fmi2SetReal(void* c, const eom::fmi::fmi2::ValueReference* references, std::size_t n, const double* values) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    for (std::size_t i = 0; i < n; ++i) instance.set(references[i], values[i]);
  });
}
EOM_FMI2_OTHER_TYPE(Integer, int)
EOM_FMI2_OTHER_TYPE(Boolean, int)
EOM_FMI2_OTHER_TYPE(String, char*)

EOM_FMI2(int) fmi2GetFMUstate(void* c, void** state) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    auto now = std::make_unique<eom::fmi::Instance::State>(instance.save());
    delete static_cast<eom::fmi::Instance::State*>(*state);  // an earlier one is replaced
    *state = now.release();
  });
}
EOM_FMI2(int) fmi2SetFMUstate(void* c, void* state) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    if (state == nullptr) throw std::invalid_argument("there is no state to set");
    instance.restore(*static_cast<eom::fmi::Instance::State*>(state));
  });
}
EOM_FMI2(int) fmi2FreeFMUstate(void*, void** state) {
  if (state == nullptr) return eom::fmi::ok;
  delete static_cast<eom::fmi::Instance::State*>(*state);
  *state = nullptr;
  return eom::fmi::ok;
}
EOM_FMI2(int) fmi2SerializedFMUstateSize(void* c, void* state, std::size_t* size) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance&) {
    *size = eom::fmi::Instance::serialise(*static_cast<eom::fmi::Instance::State*>(state)).size();
  });
}
EOM_FMI2(int) fmi2SerializeFMUstate(void* c, void* state, char* bytes, std::size_t size) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance&) {
    const auto written = eom::fmi::Instance::serialise(*static_cast<eom::fmi::Instance::State*>(state));
    if (written.size() > size) throw std::invalid_argument("the array for the serialised state is too short");
    std::memcpy(bytes, written.data(), written.size());
  });
}
EOM_FMI2(int) fmi2DeSerializeFMUstate(void* c, const char* bytes, std::size_t size, void** state) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance&) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes);
    auto read = std::make_unique<eom::fmi::Instance::State>(eom::fmi::Instance::deserialise({first, size}));
    delete static_cast<eom::fmi::Instance::State*>(*state);
    *state = read.release();
  });
}
EOM_FMI2(int)
fmi2GetDirectionalDerivative(void* c, const eom::fmi::fmi2::ValueReference* unknowns, std::size_t n,
                             const eom::fmi::fmi2::ValueReference* knowns, std::size_t m, const double* seed,
                             double* sensitivity) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    instance.directional_derivative({unknowns, n}, {knowns, m}, {seed, m}, {sensitivity, n});
  });
}

EOM_FMI2(int) fmi2EnterEventMode(void* c) {
  return eom::fmi::fmi2::call(c, [](eom::fmi::Instance& instance) { eom::fmi::fmi2::require_exchange(instance); });
}
EOM_FMI2(int) fmi2NewDiscreteStates(void* c, eom::fmi::fmi2::EventInfo* info) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi2::require_exchange(instance);
    const auto update = instance.update_discrete_states();
    if (update.ended && update.outcome != eom::Outcome::stopped_by_event)
      throw std::runtime_error("the motion ends: " + std::string(eom::name(update.outcome)) + " " + update.detail);
    info->new_discrete_states_needed = info->nominals_changed = 0;
    info->terminate = update.ended ? 1 : 0;
    info->values_changed = update.changed ? 1 : 0;
    info->has_next = std::isfinite(instance.next_event_time()) ? 1 : 0;
    info->next = info->has_next != 0 ? instance.next_event_time() : 0;
  });
}
EOM_FMI2(int) fmi2EnterContinuousTimeMode(void* c) {
  return eom::fmi::fmi2::call(c, [](eom::fmi::Instance& instance) { eom::fmi::fmi2::require_exchange(instance); });
}
EOM_FMI2(int) fmi2CompletedIntegratorStep(void* c, int, int* event, int* terminate) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi2::require_exchange(instance);
    *event = instance.complete_step() ? 1 : 0;
    *terminate = 0;
  });
}
EOM_FMI2(int) fmi2SetTime(void* c, double t) {
  return eom::fmi::fmi2::call(c, [t](eom::fmi::Instance& instance) {
    eom::fmi::fmi2::require_exchange(instance);
    instance.set_time(t);
  });
}
EOM_FMI2(int) fmi2SetContinuousStates(void* c, const double* x, std::size_t n) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi2::require_exchange(instance);
    instance.set_continuous_states({x, n});
  });
}
EOM_FMI2(int) fmi2GetDerivatives(void* c, double* dx, std::size_t n) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi2::require_exchange(instance);
    if (n != instance.continuous_states())
      throw std::invalid_argument("the number of continuous states is another one");
    instance.derivatives({dx, n});
  });
}
EOM_FMI2(int) fmi2GetEventIndicators(void* c, double* g, std::size_t n) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi2::require_exchange(instance);
    if (n != instance.model().event_indicators)
      throw std::invalid_argument("the number of event indicators is another one");
    instance.event_indicators({g, n});
  });
}
EOM_FMI2(int) fmi2GetContinuousStates(void* c, double* x, std::size_t n) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    if (n != instance.continuous_states())
      throw std::invalid_argument("the number of continuous states is another one");
    const auto values = instance.continuous_states_values();
    std::copy(values.begin(), values.end(), x);
  });
}
EOM_FMI2(int) fmi2GetNominalsOfContinuousStates(void* c, double* nominals, std::size_t n) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    if (n != instance.continuous_states())
      throw std::invalid_argument("the number of continuous states is another one");
    std::copy(instance.model().nominals.begin(), instance.model().nominals.end(), nominals);
  });
}

EOM_FMI2(int)
fmi2SetRealInputDerivatives(void* c, const eom::fmi::fmi2::ValueReference*, std::size_t, const int*, const double*) {
  return eom::fmi::fmi2::refuse(c, "derivatives of inputs by time are not used");
}
EOM_FMI2(int)
fmi2GetRealOutputDerivatives(void* c, const eom::fmi::fmi2::ValueReference*, std::size_t, const int*, double*) {
  return eom::fmi::fmi2::refuse(c, "derivatives of outputs by time are not provided");
}
EOM_FMI2(int) fmi2DoStep(void* c, double from, double step, int) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    if (!instance.is_co_simulation() || instance.phase() != eom::fmi::Phase::running)
      throw std::logic_error("this call belongs to co-simulation after the initialization");
    auto& terminated = static_cast<eom::fmi::fmi2::Handle*>(c)->log.terminated;
    terminated = instance.do_step(from, step);
    if (terminated) throw eom::fmi::Discard("an event of the model ended the simulation");
  });
}
EOM_FMI2(int) fmi2CancelStep(void* c) { return eom::fmi::fmi2::refuse(c, "steps are not asynchronous"); }
EOM_FMI2(int) fmi2GetStatus(void* c, int, int*) { return eom::fmi::fmi2::refuse(c, "steps are not asynchronous"); }
EOM_FMI2(int) fmi2GetRealStatus(void* c, int kind, double* value) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance& instance) {
    if (kind != eom::fmi::fmi2::last_successful_time) throw std::invalid_argument("this status is no number");
    *value = instance.time();
  });
}
EOM_FMI2(int) fmi2GetIntegerStatus(void* c, int, int*) { return eom::fmi::fmi2::refuse(c, "no status is an integer"); }
EOM_FMI2(int) fmi2GetBooleanStatus(void* c, int kind, int* value) {
  return eom::fmi::fmi2::call(c, [&](eom::fmi::Instance&) {
    if (kind != eom::fmi::fmi2::is_terminated) throw std::invalid_argument("this status is no truth value");
    *value = static_cast<eom::fmi::fmi2::Handle*>(c)->log.terminated ? 1 : 0;
  });
}
EOM_FMI2(int) fmi2GetStringStatus(void* c, int, const char**) {
  return eom::fmi::fmi2::refuse(c, "steps are not asynchronous");
}

#undef EOM_FMI2
#undef EOM_FMI2_OTHER_TYPE
