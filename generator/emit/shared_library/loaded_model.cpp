// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/shared_library/loaded_model.hpp"

#include <dlfcn.h>

#include <utility>

#include "error.hpp"

namespace eomgen::emit {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error("compile", {}, what, "remove the cache folder (EOMGEN_CACHE_DIR, or ~/.cache/eomgen) and try again",
              ErrorKind::tool);
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
  each([&](const char* function, auto& pointer) { find(handle_, name + "_" + function, pointer); });
  std::string wrong;
  if (abi == nullptr || selftest == nullptr || information == nullptr || defaults == nullptr || rhs == nullptr) {
    wrong = "compiled code lacks functions of the C ABI: " + path;
  } else if (abi() != eomgen::abi::version) {
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
  abi::CompiledFunctions::operator=(other);
  defaults = other.defaults;
  info = std::move(other.info);
  std::swap(handle_, other.handle_);
  return *this;
}

}  // namespace eomgen::emit
