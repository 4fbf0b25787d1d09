// SPDX-License-Identifier: GPL-3.0-or-later
// Forwarding header of the source tree. The installed file of this name is ../results.hpp itself.
#pragma once

#include "../results.hpp"
