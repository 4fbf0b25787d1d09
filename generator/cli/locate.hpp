// SPDX-License-Identifier: GPL-3.0-or-later
// Loads the MODEL argument of a command: finds the file, reads it, prints its warnings.
#pragma once

#include <memory>
#include <string>

#include "model/model.hpp"

namespace eomgen::cli {

/// Returns the path of a model. `name`: a path, or the name of a file in models/ (in this folder, a parent folder, or
/// beside the installed program). Throws Error with a suggestion if there is no such model.
std::string locate_model(const std::string& name);

/// Prints the warnings of the model reader to standard error.
void print_warnings(const model::Model& model);

/// Reads a model and prints its warnings. `seconds`, if not nullptr, receives the time taken.
std::shared_ptr<const model::Model> load_model(const std::string& name, double* seconds = nullptr);

/// Returns the path of a page of the documentation: beside the installed program, in the source tree of the build, or
/// otherwise the path relative to a source tree.
std::string documentation_path(const std::string& page);

}  // namespace eomgen::cli
