// SPDX-License-Identifier: GPL-3.0-or-later
// Forwarding header of the source tree. The installed file of this name is ../error.hpp itself.
#pragma once

#include "../error.hpp"
