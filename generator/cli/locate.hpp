// SPDX-License-Identifier: GPL-3.0-or-later
// From what the user typed as MODEL to a Model, with its warnings told.
#pragma once

#include <memory>
#include <string>

#include "model/model.hpp"

namespace eomgen::cli {

/// A path, or the name of a file in models/ (here, above, or beside the installed program). Throws Error with
/// did-you-mean where there is no such model.
std::string locate_model(const std::string& name);

/// Prints what the reader warned of to standard error.
void tell_warnings(const model::Model& model);

/// Reads it and tells its warnings; `seconds`: that it took.
std::shared_ptr<const model::Model> load_model(const std::string& name, double* seconds = nullptr);

/// Where a page of the documentation is: beside the installed program, in the source tree that the program was built
/// in, or else its name in that tree.
std::string documentation(const std::string& page);

}  // namespace eomgen::cli
