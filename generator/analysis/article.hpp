// SPDX-License-Identifier: GPL-3.0-or-later
// The derivation as a document, with everything that the other analyses find of a model.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "model/model.hpp"

namespace eomgen::analysis {

/// What `emit --target` calls it, beside the targets of code.
inline constexpr const char* document_target = "latex";

/// LaTeX. The equations are held against the judge first; throws Error{Fault::check} where they disagree.
std::string article(std::shared_ptr<const model::Model> model, std::uint64_t seed);

}  // namespace eomgen::analysis
