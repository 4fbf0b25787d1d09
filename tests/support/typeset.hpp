// SPDX-License-Identifier: GPL-3.0-or-later
// Documents set by pdflatex, where it is installed.
#pragma once

#include <string>
#include <vector>

namespace eomgen::test {

/// Says so where it is not.
bool is_pdflatex_installed();

struct Typeset {
  bool done = false;
  std::vector<std::string> overruns;  // over the margin by more than 5 pt: what stands there, by the comment before it
};

/// Lines that begin with "% ITEM " in `text` name what follows them. The PDF stays in the build folder, under `name`.
Typeset typeset(const std::string& text, const std::string& name);

/// Fails the test for each overrun.
void check_fits(const Typeset& set);

}  // namespace eomgen::test
