// SPDX-License-Identifier: GPL-3.0-or-later
// Texts about all commands and their options: pages of the manual, completions of shells. In: the declared commands and
// a template of templates/cli. Out: the text.
#pragma once

#include <functional>
#include <string>

#include "cli/declaration.hpp"

namespace eomgen::cli {

/// `escape`: applied to values in {{..}}. `selected`: a command, for templates about one.
std::string render_declared(const char* text_template, const Declaration& declared,
                            const std::function<std::string(const std::string&)>& escape,
                            const std::string& selected = "");

}  // namespace eomgen::cli
