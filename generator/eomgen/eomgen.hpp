// SPDX-License-Identifier: GPL-3.0-or-later
// All of the library (docs/library.md).
#pragma once

#include "eomgen/model.hpp"
