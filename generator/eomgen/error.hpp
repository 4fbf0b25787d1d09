// SPDX-License-Identifier: GPL-3.0-or-later
// In the source tree; what is installed under this name is the file itself.
#pragma once

#include "../error.hpp"
