// SPDX-License-Identifier: GPL-3.0-or-later
// The derivation as a document, with everything that the other commands find of a model.
#pragma once

#include <cstdint>
#include <string>

namespace eomgen::cli {

struct ArticleText {
  std::string id;    // of the model
  std::string file;  // that it was read from
  std::string text;  // LaTeX
};

/// `model`: a file or a name. The equations are held against the judge first; throws Error{Fault::check} where they
/// disagree.
ArticleText article(const std::string& model, std::uint64_t seed);

}  // namespace eomgen::cli
