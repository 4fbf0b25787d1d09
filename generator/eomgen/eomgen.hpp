// SPDX-License-Identifier: GPL-3.0-or-later
// Includes the whole library (docs/library.md).
#pragma once

#include "eomgen/fixed_step.hpp"
#include "eomgen/model.hpp"
#include "eomgen/robot.hpp"
