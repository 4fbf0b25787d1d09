// SPDX-License-Identifier: GPL-3.0-or-later
// modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml of FMI 3.0.
#pragma once

#include <string>

#include "emit/fmu/variables.hpp"

namespace eomgen::emit {

/// `token`: with which an importer instantiates this FMU and no other.
std::string model_description(const EmissionContext& context, const FmuDescription& description,
                              const FmuVariables& variables, const std::string& token);
std::string build_description(const std::string& name);

}  // namespace eomgen::emit
