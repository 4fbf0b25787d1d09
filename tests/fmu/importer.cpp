// SPDX-License-Identifier: GPL-3.0-or-later
#include "importer.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <pugixml.hpp>
#include <stdexcept>

namespace eomgen::test {
namespace {

std::uint32_t number(const std::string& bytes, std::size_t at, std::size_t length) {
  if (at + length > bytes.size()) throw std::runtime_error("the archive is too short");
  std::uint32_t value = 0;
  for (std::size_t k = length; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

using Log3 = void (*)(void*, int, const char*, const char*);
void log3(void* into, int, const char*, const char* message) { *static_cast<std::string*>(into) += message; }
void log2(void* into, const char*, int, const char*, const char* message, ...) {
  va_list arguments;
  va_start(arguments, message);
  char text[1000];
  std::vsnprintf(text, sizeof text, message, arguments);
  va_end(arguments);
  *static_cast<std::string*>(into) += text;
}
struct Callbacks2 {
  void (*logger)(void*, const char*, int, const char*, const char*, ...);
  void* (*allocate)(std::size_t, std::size_t);
  void (*release)(void*);
  void (*step_finished)(void*, int);
  void* environment;
};
struct EventInfo2 {
  int again, terminate, nominals, values, has_next;
  double next;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> read_archive(const std::string& bytes) {
  if (bytes.size() < 22) throw std::runtime_error("the archive is too short");
  const std::size_t end = bytes.size() - 22;
  if (bytes.compare(end, 4, "PK\x05\x06") != 0) throw std::runtime_error("the archive has no end record");
  const std::size_t count = number(bytes, end + 10, 2);
  std::size_t at = number(bytes, end + 16, 4);
  if (at + number(bytes, end + 12, 4) != end) throw std::runtime_error("the directory has another length");
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t k = 0; k < count; ++k) {
    if (bytes.compare(at, 4, "PK\x01\x02") != 0) throw std::runtime_error("an entry of the directory is wrong");
    const std::size_t size = number(bytes, at + 24, 4), length = number(bytes, at + 28, 2),
                      local = number(bytes, at + 42, 4);
    const std::string name = bytes.substr(at + 46, length);
    if (bytes.compare(local, 4, "PK\x03\x04") != 0 || bytes.compare(local + 30, length, name) != 0)
      throw std::runtime_error("the header of " + name + " is wrong");
    const std::string text = bytes.substr(local + 30 + length, size);
    const auto checksum = ::crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), text.size());
    if (checksum != number(bytes, at + 16, 4) || number(bytes, at + 16, 4) != number(bytes, local + 14, 4))
      throw std::runtime_error("the checksum of " + name + " is wrong");
    files.emplace_back(name, text);
    at += 46 + length;
  }
  if (at != end) throw std::runtime_error("the directory has another length");
  return files;
}

Importer::Importer(const std::string& archive, const std::string& folder) {
  std::string binary;
  for (const auto& [name, text] : read_archive(archive)) {
    if (name == "modelDescription.xml") description_ = text;
    if (name.starts_with("binaries/")) {
      binary = folder + "/" + std::filesystem::path(name).filename().string();
      std::ofstream(binary, std::ios::binary) << text;
    }
  }
  pugi::xml_document document;
  if (!document.load_string(description_.c_str())) throw std::runtime_error("modelDescription.xml is not valid");
  const pugi::xml_node root = document.child("fmiModelDescription");
  version_ = root.attribute("fmiVersion").value()[0] - '0';
  token_ = root.attribute(version_ == 3 ? "instantiationToken" : "guid").value();
  start_time_ = root.child("DefaultExperiment").attribute("startTime").as_double();
  stop_time_ = root.child("DefaultExperiment").attribute("stopTime").as_double();
  for (const pugi::xml_node variable : root.child("ModelVariables").children()) {
    const pugi::xml_node type = version_ == 3 ? variable : variable.child("Real");
    ScalarVariable v{variable.attribute("valueReference").as_uint(), variable.attribute("causality").value(),
                     variable.attribute("variability").value(), variable.attribute("initial").value(),
                     type.attribute("unit").value()};
    v.has_start = !type.attribute("start").empty();
    v.start = type.attribute("start").as_double();
    if (const auto of = type.attribute("derivative"); !of.empty())
      v.derivative_of = of.as_int() - (version_ == 2 ? 1 : 0);
    states_ += v.derivative_of >= 0 ? 1 : 0;
    variables_[variable.attribute("name").value()] = v;
  }
  if (version_ == 3) {
    for ([[maybe_unused]] const pugi::xml_node indicator : root.child("ModelStructure").children("EventIndicator"))
      ++indicators_;
  } else {
    indicators_ = root.attribute("numberOfEventIndicators").as_uint();
  }
  library_ = dlopen(binary.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library_ == nullptr) throw std::runtime_error(dlerror());
}

Importer::~Importer() {
  free();
  if (library_ != nullptr) dlclose(library_);
}

template <class Function>
Function* Importer::function(const std::string& name) const {
  const std::string full = fmt::format("fmi{}{}", version_, name);
  void* const found = dlsym(library_, full.c_str());
  if (found == nullptr) throw std::runtime_error("there is no function " + full);
  return reinterpret_cast<Function*>(found);
}

void Importer::require(int status, const std::string& what) {
  if (status == 0) return;
  throw std::runtime_error(fmt::format("{}: status {}: {}", what, status, messages_));
}

std::vector<std::uint32_t> Importer::references(const std::vector<std::string>& names) const {
  std::vector<std::uint32_t> result;
  for (const std::string& name : names) result.push_back(variables_.at(name).reference);
  return result;
}

void Importer::free() {
  if (instance_ != nullptr) function<void(void*)>("FreeInstance")(instance_);
  instance_ = nullptr;
}

void Importer::instantiate(bool co_simulation, const std::string& token) {
  free();
  messages_.clear();
  is_simulation_ = co_simulation;
  const std::string given = token.empty() ? token_ : token;
  if (version_ == 2) {
    static const Callbacks2 callbacks{log2, std::calloc, std::free, nullptr, nullptr};
    Callbacks2 mine = callbacks;
    mine.environment = &messages_;
    instance_ = function<void*(const char*, int, const char*, const char*, const Callbacks2*, int, int)>("Instantiate")(
        "test", co_simulation ? 1 : 0, given.c_str(), "", &mine, 0, 0);
  } else if (co_simulation) {
    instance_ = function<void*(const char*, const char*, const char*, bool, bool, bool, bool, const std::uint32_t*,
                               std::size_t, void*, Log3, void*)>("InstantiateCoSimulation")(
        "test", given.c_str(), "", false, false, false, false, nullptr, 0, &messages_, log3, nullptr);
  } else {
    instance_ = function<void*(const char*, const char*, const char*, bool, bool, void*, Log3)>(
        "InstantiateModelExchange")("test", given.c_str(), "", false, false, &messages_, log3);
  }
  if (instance_ == nullptr) throw std::runtime_error("there is no instance: " + messages_);
}

void Importer::enter_initialization(double t0, double tolerance) {
  if (version_ == 2) {
    require(function<int(void*, int, double, double, int, double)>("SetupExperiment")(instance_, tolerance > 0,
                                                                                      tolerance, t0, 0, 0),
            "SetupExperiment");
    require(function<int(void*)>("EnterInitializationMode")(instance_), "EnterInitializationMode");
  } else {
    require(function<int(void*, bool, double, double, bool, double)>("EnterInitializationMode")(
                instance_, tolerance > 0, tolerance, t0, false, 0),
            "EnterInitializationMode");
  }
}

void Importer::exit_initialization() {
  require(function<int(void*)>("ExitInitializationMode")(instance_), "ExitInitializationMode");
}

void Importer::set(const std::string& name, double value) {
  const std::uint32_t reference = variables_.at(name).reference;
  require(version_ == 2 ? function<int(void*, const std::uint32_t*, std::size_t, const double*)>("SetReal")(
                              instance_, &reference, 1, &value)
                        : function<int(void*, const std::uint32_t*, std::size_t, const double*, std::size_t)>(
                              "SetFloat64")(instance_, &reference, 1, &value, 1),
          "set " + name);
}

double Importer::get(const std::string& name) {
  const std::uint32_t reference = variables_.at(name).reference;
  double value = 0;
  require(version_ == 2 ? function<int(void*, const std::uint32_t*, std::size_t, double*)>("GetReal")(
                              instance_, &reference, 1, &value)
                        : function<int(void*, const std::uint32_t*, std::size_t, double*, std::size_t)>("GetFloat64")(
                              instance_, &reference, 1, &value, 1),
          "get " + name);
  return value;
}

std::vector<double> Importer::get_states() {
  std::vector<double> x(states_);
  require(function<int(void*, double*, std::size_t)>("GetContinuousStates")(instance_, x.data(), x.size()),
          "get states");
  return x;
}

void Importer::set_point(double t, const std::vector<double>& x) {
  require(function<int(void*, double)>("SetTime")(instance_, t), "SetTime");
  require(function<int(void*, const double*, std::size_t)>("SetContinuousStates")(instance_, x.data(), x.size()),
          "SetContinuousStates");
}

std::vector<double> Importer::derivatives() {
  std::vector<double> dx(states_);
  const char* const name = version_ == 2 ? "GetDerivatives" : "GetContinuousStateDerivatives";
  require(function<int(void*, double*, std::size_t)>(name)(instance_, dx.data(), dx.size()), name);
  return dx;
}

std::vector<double> Importer::event_indicators() {
  std::vector<double> g(indicators_);
  require(function<int(void*, double*, std::size_t)>("GetEventIndicators")(instance_, g.data(), g.size()),
          "indicators");
  return g;
}

bool Importer::complete_step() {
  if (version_ == 2) {
    int event = 0, terminate = 0;
    require(function<int(void*, int, int*, int*)>("CompletedIntegratorStep")(instance_, 1, &event, &terminate), "step");
    return event != 0;
  }
  bool event = false, terminate = false;
  require(function<int(void*, bool, bool*, bool*)>("CompletedIntegratorStep")(instance_, true, &event, &terminate),
          "step");
  return event;
}

Importer::Update Importer::update() {
  constexpr double never = std::numeric_limits<double>::infinity();
  require(function<int(void*)>("EnterEventMode")(instance_), "EnterEventMode");
  Update result;
  if (version_ == 2) {
    EventInfo2 info{};
    require(function<int(void*, EventInfo2*)>("NewDiscreteStates")(instance_, &info), "NewDiscreteStates");
    result = {info.terminate != 0, info.values != 0, info.has_next != 0 ? info.next : never};
  } else {
    bool again = true, nominals = false, has_next = false;
    while (again) {
      bool changed = false;
      require(function<int(void*, bool*, bool*, bool*, bool*, bool*, double*)>("UpdateDiscreteStates")(
                  instance_, &again, &result.terminate, &nominals, &changed, &has_next, &result.next),
              "UpdateDiscreteStates");
      result.changed = result.changed || changed;
    }
    if (!has_next) result.next = never;
  }
  if (!result.terminate) require(function<int(void*)>("EnterContinuousTimeMode")(instance_), "EnterContinuousTimeMode");
  return result;
}

bool Importer::do_step(double from, double step) {
  if (version_ == 2) {
    const int status = function<int(void*, double, double, int)>("DoStep")(instance_, from, step, 1);
    int terminated = 0;
    if (status == 2) function<int(void*, int, int*)>("GetBooleanStatus")(instance_, 3, &terminated);
    if (terminated == 0) require(status, "DoStep");
    return terminated != 0;
  }
  bool event = false, terminate = false, early = false;
  double reached = 0;
  require(function<int(void*, double, double, bool, bool*, bool*, bool*, double*)>("DoStep")(
              instance_, from, step, true, &event, &terminate, &early, &reached),
          "DoStep");
  return terminate;
}

std::vector<double> Importer::directional(const std::vector<std::string>& unknowns,
                                          const std::vector<std::string>& knowns, const std::vector<double>& seed) {
  const auto u = references(unknowns), k = references(knowns);
  std::vector<double> result(u.size());
  using Refs = const std::uint32_t*;
  require(version_ == 2 ? function<int(void*, Refs, std::size_t, Refs, std::size_t, const double*, double*)>(
                              "GetDirectionalDerivative")(instance_, u.data(), u.size(), k.data(), k.size(),
                                                          seed.data(), result.data())
                        : function<int(void*, Refs, std::size_t, Refs, std::size_t, const double*, std::size_t, double*,
                                       std::size_t)>("GetDirectionalDerivative")(
                              instance_, u.data(), u.size(), k.data(), k.size(), seed.data(), seed.size(),
                              result.data(), result.size()),
          "directional derivative");
  return result;
}

std::vector<double> Importer::adjoint(const std::vector<std::string>& unknowns, const std::vector<std::string>& knowns,
                                      const std::vector<double>& seed) {
  const auto u = references(unknowns), k = references(knowns);
  std::vector<double> result(k.size());
  using Refs = const std::uint32_t*;
  require(function<int(void*, Refs, std::size_t, Refs, std::size_t, const double*, std::size_t, double*, std::size_t)>(
              "GetAdjointDerivative")(instance_, u.data(), u.size(), k.data(), k.size(), seed.data(), seed.size(),
                                      result.data(), result.size()),
          "adjoint derivative");
  return result;
}

std::vector<std::uint8_t> Importer::serialised_state() {
  const std::string state_of = version_ == 2 ? "state" : "State";
  void* state = nullptr;
  std::size_t size = 0;
  require(function<int(void*, void**)>("GetFMU" + state_of)(instance_, &state), "get state");
  require(function<int(void*, void*, std::size_t*)>("SerializedFMU" + state_of + "Size")(instance_, state, &size),
          "size");
  std::vector<std::uint8_t> bytes(size);
  require(function<int(void*, void*, std::uint8_t*, std::size_t)>("SerializeFMU" + state_of)(instance_, state,
                                                                                             bytes.data(), size),
          "serialise");
  require(function<int(void*, void**)>("FreeFMU" + state_of)(instance_, &state), "free state");
  return bytes;
}

void Importer::restore(const std::vector<std::uint8_t>& bytes) {
  const std::string state_of = version_ == 2 ? "state" : "State";
  void* state = nullptr;
  const std::string name = (version_ == 2 ? "DeSerializeFMU" : "DeserializeFMU") + state_of;
  require(function<int(void*, const std::uint8_t*, std::size_t, void**)>(name)(instance_, bytes.data(), bytes.size(),
                                                                               &state),
          "deserialise");
  require(function<int(void*, void*)>("SetFMU" + state_of)(instance_, state), "set state");
  require(function<int(void*, void**)>("FreeFMU" + state_of)(instance_, &state), "free state");
}

double Importer::simulate(double t0, double t_end, double h, const std::function<void(double t)>& inputs) {
  double t = t0;
  if (inputs) inputs(t);
  Update now = update();
  std::vector<double> x = get_states();
  const auto rate = [&](double at, const std::vector<double>& state) {
    set_point(at, state);
    if (inputs) inputs(at);
    return derivatives();
  };
  const auto step = [&](double from, double length, const std::vector<double>& begin) {
    std::vector<double> sum(states_), middle = begin, end = begin;
    std::vector<double> k;
    constexpr double at[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    for (int stage = 0; stage < 4; ++stage) {
      for (std::size_t i = 0; i < states_ && stage > 0; ++i) middle[i] = begin[i] + at[stage] * length * k[i];
      k = rate(from + at[stage] * length, middle);
      for (std::size_t i = 0; i < states_; ++i) sum[i] += weight[stage] * k[i];
    }
    for (std::size_t i = 0; i < states_; ++i) end[i] += length / 6 * sum[i];
    return end;
  };
  const auto indicators_at = [&](double at, const std::vector<double>& state) {
    set_point(at, state);
    if (inputs) inputs(at);
    return event_indicators();
  };
  const auto differ = [](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      if ((a[i] > 0) != (b[i] > 0)) return true;
    return false;
  };
  std::vector<double> g = indicators_at(t, x);
  while (t < t_end && !now.terminate) {
    double length = std::min({h, t_end - t, now.next - t});
    const bool at_event = length == now.next - t;
    bool crossed = false;
    std::vector<double> end = x;
    if (length > 0) {
      end = step(t, length, x);
      if (differ(g, indicators_at(t + length, end))) {
        double left = 0, right = length;
        for (int trial = 0; trial < 50 && right - left > 1e-12 * std::max(1.0, std::abs(t)); ++trial) {
          const double middle = (left + right) / 2;
          (differ(g, indicators_at(t + middle, step(t, middle, x))) ? right : left) = middle;
        }
        crossed = true;
        length = right;
        end = step(t, length, x);
      }
      t = at_event && !crossed ? now.next : t_end - t - length < 1e-14 * std::abs(t_end) ? t_end : t + length;
      set_point(t, end);
      if (inputs) inputs(t);
      x = end;
    }
    const bool wanted = complete_step();
    if (crossed || wanted || (at_event && t == now.next)) {
      now = update();
      x = get_states();
      if (now.terminate) break;
    }
    g = indicators_at(t, x);
  }
  return t;
}

}  // namespace eomgen::test
