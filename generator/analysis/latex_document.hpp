// SPDX-License-Identifier: GPL-3.0-or-later
// The derivation as a LaTeX document, with the results of the other analyses.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace eomgen::analysis {

/// Name of the document for `emit --target`, in addition to the targets of code.
inline constexpr const char* latex_document_target = "latex";

/// Returns the LaTeX source. Checks the equations against the independent oracle first; throws Error{ErrorKind::check}
/// if they disagree. `omitted`: names of print::document_parts; throws Error if one is not.
std::string latex_document(std::shared_ptr<const model::Model> model, std::uint64_t seed,
                           const std::vector<std::string>& omitted = {});

}  // namespace eomgen::analysis
