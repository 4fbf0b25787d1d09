// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of FMI, compiled when this program was: they are the same for all models, and take a compiler a minute.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace eomgen::emit {

/// The bytes of an object file with the functions of FMI 2.0 and 3.0, without those of a model.
std::string_view compiled_fmi_functions();

/// The headers of Eigen that it includes, relative to Eigen's folder and sorted: "Eigen/src/Core/Matrix.h".
std::vector<std::string> headers_of_fmi_functions();

}  // namespace eomgen::emit
