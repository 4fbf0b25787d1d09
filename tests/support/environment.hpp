// SPDX-License-Identifier: GPL-3.0-or-later
// Environment variables of tests.
#pragma once

#include <cstdlib>
#include <string>

namespace eomgen::test {

/// Sets an environment variable within a scope.
struct ScopedEnvironmentVariable {
  std::string name, before;
  bool had;
  ScopedEnvironmentVariable(const std::string& variable, const std::string& value) : name(variable) {
    const char* old = ::getenv(name.c_str());
    had = old != nullptr;
    if (had) before = old;
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~ScopedEnvironmentVariable() {
    if (had)
      ::setenv(name.c_str(), before.c_str(), 1);
    else
      ::unsetenv(name.c_str());
  }
  ScopedEnvironmentVariable(const ScopedEnvironmentVariable&) = delete;
  ScopedEnvironmentVariable& operator=(const ScopedEnvironmentVariable&) = delete;
};

}  // namespace eomgen::test
