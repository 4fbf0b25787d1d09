// SPDX-License-Identifier: MIT
// The functions of FMI 2.0 and 3.0 in one object, compiled with the program: every FMU is linked with it.
#include <eom/fmi/fmi2.hpp>
#include <eom/fmi/fmi3.hpp>
