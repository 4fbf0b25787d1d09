// SPDX-License-Identifier: GPL-3.0-or-later
// Typesets documents with pdflatex, if it is installed.
#pragma once

#include <string>
#include <vector>

namespace eomgen::test {

/// Whether pdflatex is installed; prints a message if it is not.
bool is_pdflatex_installed();

struct Typeset {
  bool done = false;
  std::vector<std::string> overruns;  // over the margin by more than 5 pt: what stands there, by the comment before it
};

/// Lines that begin with "% ITEM " in `text` name the item that follows. The PDF is stored in the build folder as
/// `name`.
Typeset typeset(const std::string& text, const std::string& name);

/// Fails the test for each overrun.
void check_fits(const Typeset& set);

}  // namespace eomgen::test
