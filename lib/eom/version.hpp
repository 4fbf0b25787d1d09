// SPDX-License-Identifier: MIT
// The version of the runtime headers. These numbers are the only ones: CMakeLists.txt reads them from here.
#pragma once

#define EOM_VERSION_MAJOR 0
#define EOM_VERSION_MINOR 2
#define EOM_VERSION_PATCH 0
/// One number to compare: 0.2.0 is 200.
#define EOM_VERSION (EOM_VERSION_MAJOR * 10000 + EOM_VERSION_MINOR * 100 + EOM_VERSION_PATCH)
