// SPDX-License-Identifier: GPL-3.0-or-later
// The headers of lib/eom that an FMU contains, as text in the program: an installed eomgen needs no data files.
#pragma once

#include <span>

namespace eomgen::emit {

struct RuntimeSource {
  const char *name, *text;  // "eom/ode.hpp"
};

/// In the order of their names; the last one is their LICENSE.
std::span<const RuntimeSource> runtime_sources();

}  // namespace eomgen::emit
