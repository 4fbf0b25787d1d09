// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/signature.hpp"

#include <fmt/format.h>

#include "emit/text.hpp"

namespace eomgen::emit {

using program::Slot;

std::vector<Argument> arguments(const std::string& function, const FunctionText& text, const ModelNames& names) {
  using Kind = Argument::Kind;
  std::vector<Argument> list;
  if (function == "taylor_next") {
    list = {{Kind::number, Slot::time, names.arguments_t},
            {Kind::input, Slot::state, names.x},
            {Kind::input, Slot::prepared, names.w}};
    for (const std::string& result : text.results) list.push_back({Kind::result, Slot::constant, result});
    return list;
  }
  if (function == "to_second" || function == "to_own") {
    list.push_back({Kind::input, Slot::state, names.x});
    for (const std::string& result : text.results) list.push_back({Kind::result, Slot::constant, result});
    return list;
  }
  const bool of_state = function != "prepare";
  if (of_state) list.push_back({Kind::number, Slot::time, names.arguments_t});
  if (of_state) list.push_back({Kind::input, Slot::state, names.x});
  list.push_back({Kind::input, Slot::parameter, names.p});
  if (function == "rhs_prepared") list.push_back({Kind::input, Slot::prepared, names.w});
  if (of_state && function != "mass" && function != "constraints") {
    list.push_back({Kind::input, Slot::input, names.u});
    list.push_back({Kind::mode, Slot::side, names.mode});
  }
  for (const std::string& result : text.results) list.push_back({Kind::result, Slot::constant, result});
  return list;
}

ModelNames abi_names() {
  ModelNames names;
  names.x = "x";
  names.p = "p";
  names.w = "w";
  names.u = "u";
  names.mode = "mode";
  return names;
}

std::string argument_list(const std::vector<Argument>& arguments, const std::string& real) {
  std::string list;
  for (const Argument& argument : arguments) {
    if (!list.empty()) list += ", ";
    switch (argument.kind) {
      case Argument::Kind::number: list += fmt::format("{} {}", real, argument.name); break;
      case Argument::Kind::input: list += fmt::format("const {}* {}", real, argument.name); break;
      case Argument::Kind::mode: list += fmt::format("int {}", argument.name); break;
      case Argument::Kind::result: list += fmt::format("{}* {}", real, argument.name); break;
    }
  }
  return list;
}

std::string function_head(const std::string& name, const program::Function& function, const FunctionText& text,
                          const ModelNames& names, const std::string& real) {
  return wrapped(fmt::format("int {}({})", name, argument_list(arguments(function.name, text, names), real)),
                 std::string(name.size() + 5, ' '));
}

std::string argument_names(const program::Function& function, const FunctionText& text, const ModelNames& names) {
  std::string list;
  for (const Argument& argument : arguments(function.name, text, names)) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", argument.name);
  }
  return list;
}

}  // namespace eomgen::emit
