// SPDX-License-Identifier: MIT
// The functions of FMI 3.0 (Functional Mock-up Interface, version 3.0), for model exchange and co-simulation. One
// source file of an FMU includes this header. All variables are of type Float64. In: calls of an importer. Out: those
// of an Instance.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "eom/fmi/calls.hpp"

namespace eom::fmi::fmi3 {

using LogMessage = void (*)(void* environment, int status, const char* category, const char* message);
using IntermediateUpdate = void (*)(void*, double, bool, bool, bool, bool, bool*, double*);

struct Log {
  void* environment = nullptr;
  LogMessage message = nullptr;
  bool debug = false;
  void operator()(int status, const char* category, const char* text) const {
    if (message != nullptr) message(environment, status, category, text);
  }
};
using Handle = Component<Log>;
using ValueReference = std::uint32_t;

template <class Call>
int call(void* handle, Call&& what) {
  return guarded<Log>(handle, std::forward<Call>(what));
}

inline void* instantiate(bool co_simulation, const char* token, bool debug, void* environment, LogMessage message) {
  const Log log{environment, message, debug};
  try {
    if (token == nullptr || std::strcmp(token, model_code().token) != 0)
      throw std::invalid_argument("the instantiation token is that of another FMU");
    return new Handle(co_simulation, log);
  } catch (const std::exception& wrong) {
    log(error, "logStatusError", wrong.what());
    return nullptr;
  }
}

inline int none_of_this_type(void* handle, std::size_t count) {
  return call(handle, [count](Instance&) {
    if (count > 0) throw std::invalid_argument("all variables of this FMU are of type Float64");
  });
}
inline int refuse(void* handle, const char* what) {
  return call(handle, [what](Instance&) { throw std::logic_error(what); });
}
inline void require_exchange(const Instance& instance) {
  if (instance.is_co_simulation() || instance.phase() != Phase::running)
    throw std::logic_error("this call belongs to model exchange after the initialization");
}

}  // namespace eom::fmi::fmi3

#define EOM_FMI3(result) extern "C" __attribute__((visibility("default"))) result
#define EOM_FMI3_OTHER_TYPE(name, type)                                                                            \
  EOM_FMI3(int) fmi3Get##name(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, type*, std::size_t) { \
    return eom::fmi::fmi3::none_of_this_type(c, n);                                                                \
  }                                                                                                                \
  EOM_FMI3(int)                                                                                                    \
  fmi3Set##name(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const type*, std::size_t) {         \
    return eom::fmi::fmi3::none_of_this_type(c, n);                                                                \
  }

EOM_FMI3(const char*) fmi3GetVersion(void) { return "3.0"; }
EOM_FMI3(int) fmi3SetDebugLogging(void* c, bool on, std::size_t, const char* const*) {
  if (c == nullptr) return eom::fmi::error;
  static_cast<eom::fmi::fmi3::Handle*>(c)->log.debug = on;
  return eom::fmi::ok;
}
EOM_FMI3(void*)
fmi3InstantiateModelExchange(const char*, const char* token, const char*, bool, bool debug, void* environment,
                             eom::fmi::fmi3::LogMessage message) {
  return eom::fmi::fmi3::instantiate(false, token, debug, environment, message);
}
EOM_FMI3(void*)
fmi3InstantiateCoSimulation(const char*, const char* token, const char*, bool, bool debug, bool, bool,
                            const eom::fmi::fmi3::ValueReference*, std::size_t, void* environment,
                            eom::fmi::fmi3::LogMessage message, eom::fmi::fmi3::IntermediateUpdate) {
  return eom::fmi::fmi3::instantiate(true, token, debug, environment, message);
}
EOM_FMI3(void*)
fmi3InstantiateScheduledExecution(const char*, const char*, const char*, bool, bool, void*, eom::fmi::fmi3::LogMessage,
                                  void (*)(void*), void (*)(void), void (*)(void)) {
  return nullptr;
}
EOM_FMI3(void) fmi3FreeInstance(void* c) { delete static_cast<eom::fmi::fmi3::Handle*>(c); }
EOM_FMI3(int)
fmi3EnterInitializationMode(void* c, bool has_tolerance, double tolerance, double start, bool has_stop, double stop) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    instance.enter_initialization(has_tolerance ? std::optional(tolerance) : std::nullopt, start,
                                  has_stop ? std::optional(stop) : std::nullopt);
  });
}
EOM_FMI3(int) fmi3ExitInitializationMode(void* c) {
  return eom::fmi::fmi3::call(c, [](eom::fmi::Instance& instance) { instance.exit_initialization(); });
}
EOM_FMI3(int) fmi3EnterEventMode(void* c) {
  return eom::fmi::fmi3::call(c, [](eom::fmi::Instance& instance) { eom::fmi::fmi3::require_exchange(instance); });
}
EOM_FMI3(int) fmi3Terminate(void* c) {
  return eom::fmi::fmi3::call(c, [](eom::fmi::Instance& instance) { instance.terminate(); });
}
EOM_FMI3(int) fmi3Reset(void* c) {
  return eom::fmi::fmi3::call(c, [](eom::fmi::Instance& instance) { instance.reset(); });
}

EOM_FMI3(int)
fmi3GetFloat64(void* c, const eom::fmi::fmi3::ValueReference* references, std::size_t n, double* values,
               std::size_t count) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    if (count != n) throw std::invalid_argument("each variable has one value");
    for (std::size_t i = 0; i < n; ++i) values[i] = instance.get(references[i]);
  });
}
EOM_FMI3(int)
fmi3SetFloat64(void* c, const eom::fmi::fmi3::ValueReference* references, std::size_t n, const double* values,
               std::size_t count) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    if (count != n) throw std::invalid_argument("each variable has one value");
    for (std::size_t i = 0; i < n; ++i) instance.set(references[i], values[i]);
  });
}
EOM_FMI3_OTHER_TYPE(Float32, float)
EOM_FMI3_OTHER_TYPE(Int8, std::int8_t)
EOM_FMI3_OTHER_TYPE(UInt8, std::uint8_t)
EOM_FMI3_OTHER_TYPE(Int16, std::int16_t)
EOM_FMI3_OTHER_TYPE(UInt16, std::uint16_t)
EOM_FMI3_OTHER_TYPE(Int32, std::int32_t)
EOM_FMI3_OTHER_TYPE(UInt32, std::uint32_t)
EOM_FMI3_OTHER_TYPE(Int64, std::int64_t)
EOM_FMI3_OTHER_TYPE(UInt64, std::uint64_t)
EOM_FMI3_OTHER_TYPE(Boolean, bool)
EOM_FMI3_OTHER_TYPE(String, char*)
EOM_FMI3(int)
fmi3GetBinary(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, std::size_t*, const std::uint8_t**,
              std::size_t) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int)
fmi3SetBinary(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const std::size_t*,
              const std::uint8_t* const*, std::size_t) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int) fmi3GetClock(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, bool*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int) fmi3SetClock(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const bool*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}

EOM_FMI3(int) fmi3GetNumberOfVariableDependencies(void* c, eom::fmi::fmi3::ValueReference, std::size_t*) {
  return eom::fmi::fmi3::refuse(c, "dependencies of single elements are not provided");
}
EOM_FMI3(int)
fmi3GetVariableDependencies(void* c, eom::fmi::fmi3::ValueReference, std::size_t*, eom::fmi::fmi3::ValueReference*,
                            std::size_t*, int*, std::size_t) {
  return eom::fmi::fmi3::refuse(c, "dependencies of single elements are not provided");
}

EOM_FMI3(int) fmi3GetFMUState(void* c, void** state) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    auto now = std::make_unique<eom::fmi::Instance::State>(instance.save());
    delete static_cast<eom::fmi::Instance::State*>(*state);  // an earlier one is replaced
    *state = now.release();
  });
}
EOM_FMI3(int) fmi3SetFMUState(void* c, void* state) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    if (state == nullptr) throw std::invalid_argument("there is no state to set");
    instance.restore(*static_cast<eom::fmi::Instance::State*>(state));
  });
}
EOM_FMI3(int) fmi3FreeFMUState(void*, void** state) {
  if (state == nullptr) return eom::fmi::ok;
  delete static_cast<eom::fmi::Instance::State*>(*state);
  *state = nullptr;
  return eom::fmi::ok;
}
EOM_FMI3(int) fmi3SerializedFMUStateSize(void* c, void* state, std::size_t* size) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance&) {
    *size = eom::fmi::Instance::serialise(*static_cast<eom::fmi::Instance::State*>(state)).size();
  });
}
EOM_FMI3(int) fmi3SerializeFMUState(void* c, void* state, std::uint8_t* bytes, std::size_t size) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance&) {
    const auto written = eom::fmi::Instance::serialise(*static_cast<eom::fmi::Instance::State*>(state));
    if (written.size() > size) throw std::invalid_argument("the array for the serialised state is too short");
    std::copy(written.begin(), written.end(), bytes);
  });
}
EOM_FMI3(int) fmi3DeserializeFMUState(void* c, const std::uint8_t* bytes, std::size_t size, void** state) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance&) {
    auto read = std::make_unique<eom::fmi::Instance::State>(eom::fmi::Instance::deserialise({bytes, size}));
    delete static_cast<eom::fmi::Instance::State*>(*state);
    *state = read.release();
  });
}

EOM_FMI3(int)
fmi3GetDirectionalDerivative(void* c, const eom::fmi::fmi3::ValueReference* unknowns, std::size_t n,
                             const eom::fmi::fmi3::ValueReference* knowns, std::size_t m, const double* seed,
                             std::size_t seeds, double* sensitivity, std::size_t sensitivities) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    instance.directional_derivative({unknowns, n}, {knowns, m}, {seed, seeds}, {sensitivity, sensitivities});
  });
}
EOM_FMI3(int)
fmi3GetAdjointDerivative(void* c, const eom::fmi::fmi3::ValueReference* unknowns, std::size_t n,
                         const eom::fmi::fmi3::ValueReference* knowns, std::size_t m, const double* seed,
                         std::size_t seeds, double* sensitivity, std::size_t sensitivities) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    instance.adjoint_derivative({unknowns, n}, {knowns, m}, {seed, seeds}, {sensitivity, sensitivities});
  });
}

EOM_FMI3(int) fmi3EnterConfigurationMode(void* c) {
  return eom::fmi::fmi3::refuse(c, "there are no structural parameters");
}
EOM_FMI3(int) fmi3ExitConfigurationMode(void* c) {
  return eom::fmi::fmi3::refuse(c, "there are no structural parameters");
}
EOM_FMI3(int) fmi3GetIntervalDecimal(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, double*, int*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int)
fmi3GetIntervalFraction(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, std::uint64_t*, std::uint64_t*,
                        int*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int) fmi3GetShiftDecimal(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, double*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int)
fmi3GetShiftFraction(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, std::uint64_t*, std::uint64_t*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int) fmi3SetIntervalDecimal(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const double*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int)
fmi3SetIntervalFraction(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const std::uint64_t*,
                        const std::uint64_t*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int) fmi3SetShiftDecimal(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const double*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int)
fmi3SetShiftFraction(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t n, const std::uint64_t*,
                     const std::uint64_t*) {
  return eom::fmi::fmi3::none_of_this_type(c, n);
}
EOM_FMI3(int) fmi3EvaluateDiscreteStates(void* c) {
  return eom::fmi::fmi3::refuse(c, "fmi3UpdateDiscreteStates evaluates the discrete states");
}
EOM_FMI3(int)
fmi3UpdateDiscreteStates(void* c, bool* again, bool* terminate, bool* nominals, bool* values, bool* has_next,
                         double* next) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi3::require_exchange(instance);
    const auto update = instance.update_discrete_states();
    if (update.ended && update.outcome != eom::Outcome::stopped_by_event)
      throw std::runtime_error("the motion ends: " + std::string(eom::name(update.outcome)) + " " + update.detail);
    *again = *nominals = false;
    *terminate = update.ended;
    *values = update.changed;
    *has_next = std::isfinite(instance.next_event_time());
    *next = *has_next ? instance.next_event_time() : 0;
  });
}

EOM_FMI3(int) fmi3EnterContinuousTimeMode(void* c) {
  return eom::fmi::fmi3::call(c, [](eom::fmi::Instance& instance) { eom::fmi::fmi3::require_exchange(instance); });
}
EOM_FMI3(int) fmi3CompletedIntegratorStep(void* c, bool, bool* event, bool* terminate) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi3::require_exchange(instance);
    *event = instance.complete_step();
    *terminate = false;
  });
}
EOM_FMI3(int) fmi3SetTime(void* c, double t) {
  return eom::fmi::fmi3::call(c, [t](eom::fmi::Instance& instance) {
    eom::fmi::fmi3::require_exchange(instance);
    instance.set_time(t);
  });
}
EOM_FMI3(int) fmi3SetContinuousStates(void* c, const double* x, std::size_t n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi3::require_exchange(instance);
    instance.set_continuous_states({x, n});
  });
}
EOM_FMI3(int) fmi3GetContinuousStateDerivatives(void* c, double* dx, std::size_t n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi3::require_exchange(instance);
    if (n != instance.continuous_states())
      throw std::invalid_argument("the number of continuous states is another one");
    instance.derivatives({dx, n});
  });
}
EOM_FMI3(int) fmi3GetEventIndicators(void* c, double* g, std::size_t n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    eom::fmi::fmi3::require_exchange(instance);
    if (n != instance.model().event_indicators)
      throw std::invalid_argument("the number of event indicators is another one");
    instance.event_indicators({g, n});
  });
}
EOM_FMI3(int) fmi3GetContinuousStates(void* c, double* x, std::size_t n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    if (n != instance.continuous_states())
      throw std::invalid_argument("the number of continuous states is another one");
    const auto values = instance.continuous_states_values();
    std::copy(values.begin(), values.end(), x);
  });
}
EOM_FMI3(int) fmi3GetNominalsOfContinuousStates(void* c, double* nominals, std::size_t n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    if (n != instance.continuous_states())
      throw std::invalid_argument("the number of continuous states is another one");
    std::copy(instance.model().nominals.begin(), instance.model().nominals.end(), nominals);
  });
}
EOM_FMI3(int) fmi3GetNumberOfEventIndicators(void* c, std::size_t* n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) { *n = instance.model().event_indicators; });
}
EOM_FMI3(int) fmi3GetNumberOfContinuousStates(void* c, std::size_t* n) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) { *n = instance.continuous_states(); });
}

EOM_FMI3(int) fmi3EnterStepMode(void* c) { return eom::fmi::fmi3::refuse(c, "co-simulation has no event mode here"); }
EOM_FMI3(int)
fmi3GetOutputDerivatives(void* c, const eom::fmi::fmi3::ValueReference*, std::size_t, const std::int32_t*, double*,
                         std::size_t) {
  return eom::fmi::fmi3::refuse(c, "derivatives of outputs by time are not provided");
}
EOM_FMI3(int)
fmi3DoStep(void* c, double from, double step, bool, bool* event, bool* terminate, bool* early, double* reached) {
  return eom::fmi::fmi3::call(c, [&](eom::fmi::Instance& instance) {
    if (!instance.is_co_simulation() || instance.phase() != eom::fmi::Phase::running)
      throw std::logic_error("this call belongs to co-simulation after the initialization");
    *event = *early = *terminate = false;
    *terminate = instance.do_step(from, step);
    *reached = instance.time();
  });
}
EOM_FMI3(int) fmi3ActivateModelPartition(void* c, eom::fmi::fmi3::ValueReference, double) {
  return eom::fmi::fmi3::refuse(c, "there is no scheduled execution");
}

#undef EOM_FMI3
#undef EOM_FMI3_OTHER_TYPE
