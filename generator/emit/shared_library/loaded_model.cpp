// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/shared_library/loaded_model.hpp"

#include <dlfcn.h>

#include <utility>

#include "error.hpp"

namespace eomgen::emit {
namespace {

constexpr int abi_version = 1;

[[noreturn]] void fail(const std::string& what) {
  throw Error("compile", {}, what, "remove the cache folder (EOMGEN_CACHE_DIR, or ~/.cache/eomgen) and try again",
              Fault::tool);
}

template <class Pointer>
void find(void* handle, const std::string& symbol, Pointer& function) {
  function = reinterpret_cast<Pointer>(::dlsym(handle, symbol.c_str()));
}

}  // namespace

LoadedModel::LoadedModel(const std::string& path, const std::string& name) {
  handle_ = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle_ == nullptr) {
    const char* reason = ::dlerror();
    fail("cannot load compiled code: " + std::string(reason == nullptr ? "unknown reason" : reason));
  }
  int (*abi)() = nullptr;
  int (*selftest)() = nullptr;
  const char* (*information)() = nullptr;
  find(handle_, name + "_abi", abi);
  find(handle_, name + "_selftest", selftest);
  find(handle_, name + "_info", information);
  find(handle_, name + "_defaults", defaults);
  find(handle_, name + "_rhs", rhs);
  find(handle_, name + "_prepare", prepare);
  find(handle_, name + "_rhs_prepared", rhs_prepared);
  find(handle_, name + "_jac", jac);
  find(handle_, name + "_jac_p", jac_p);
  find(handle_, name + "_taylor", taylor);
  find(handle_, name + "_mass", mass);
  find(handle_, name + "_momenta", momenta);
  find(handle_, name + "_constraints", constraints);
  find(handle_, name + "_reactions", reactions);
  find(handle_, name + "_outputs", outputs);
  find(handle_, name + "_events", events);
  find(handle_, name + "_chart", chart);
  find(handle_, name + "_mass_in", mass_in);
  find(handle_, name + "_constraints_in", constraints_in);
  std::string wrong;
  if (abi == nullptr || selftest == nullptr || information == nullptr || defaults == nullptr || rhs == nullptr) {
    wrong = "compiled code lacks functions of the C ABI: " + path;
  } else if (abi() != abi_version) {
    wrong = "compiled code has another version of the C ABI: " + path;
  } else if (const int vector = selftest(); vector != 0) {
    wrong = "compiled code fails its self test, vector " + std::to_string(vector) + ": " + path;
  }
  if (!wrong.empty()) {
    ::dlclose(handle_);
    fail(wrong);
  }
  info = information();
}

LoadedModel::~LoadedModel() {
  if (handle_ != nullptr) ::dlclose(handle_);
}

LoadedModel::LoadedModel(LoadedModel&& other) noexcept { *this = std::move(other); }

LoadedModel& LoadedModel::operator=(LoadedModel&& other) noexcept {
  rhs = other.rhs;
  prepare = other.prepare;
  rhs_prepared = other.rhs_prepared;
  jac_p = other.jac_p;
  reactions = other.reactions;
  outputs = other.outputs;
  events = other.events;
  jac = other.jac;
  taylor = other.taylor;
  mass = other.mass;
  momenta = other.momenta;
  constraints = other.constraints;
  chart = other.chart;
  mass_in = other.mass_in;
  constraints_in = other.constraints_in;
  defaults = other.defaults;
  info = std::move(other.info);
  std::swap(handle_, other.handle_);
  return *this;
}

}  // namespace eomgen::emit
