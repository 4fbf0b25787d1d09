// SPDX-License-Identifier: GPL-3.0-or-later
// Why a state at which equations could be compared is not taken.
#pragma once

#include <stdexcept>

namespace eomgen::verify {

/// A state that is not compared, and why; counted by reason.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The constraints cannot be met there.
struct Unclosed : Rejected {
  using Rejected::Rejected;
};

}  // namespace eomgen::verify
