// SPDX-License-Identifier: GPL-3.0-or-later
// Stop request and callbacks of one call of the library.
#pragma once

#include <exception>
#include <functional>
#include <stop_token>
#include <string>

namespace eomgen {

/// Controls one call. By default the call cannot be stopped and reports nothing. The thread that made the call also
/// runs the callbacks.
struct CallControl {
  /// Stops the call within a fraction of a second. A run, a search and a verification then return partial results that
  /// are marked as interrupted. All other calls throw Interrupted.
  std::stop_token stop = {};
  std::function<void(const std::string& stage)> on_stage = {};      // start of a stage: "deriving the equations"
  std::function<void(double fraction)> on_progress = {};            // in [0, 1], of a time span or of a search
  std::function<void(const std::string& warning)> on_warning = {};  // a warning about the result
};

/// Thrown by a call that was stopped and has no partial result.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace eomgen
