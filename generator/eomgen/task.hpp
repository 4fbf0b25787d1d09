// SPDX-License-Identifier: GPL-3.0-or-later
// What a caller may ask of a long call, and hear from it.
#pragma once

#include <exception>
#include <functional>
#include <stop_token>
#include <string>

namespace eomgen {

/// Of one call; the default asks for nothing. The functions are called from the thread of the call.
struct Task {
  /// Ends the call within a fraction of a second: a run, a search and a verification give what they have and say so,
  /// everything else throws Interrupted.
  std::stop_token stop = {};
  std::function<void(const std::string& stage)> begins = {};   // "deriving the equations"
  std::function<void(double fraction)> progress = {};          // of a run's time span, of the starts of a search
  std::function<void(const std::string& warning)> warns = {};  // what to know beside the result
};

class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace eomgen
