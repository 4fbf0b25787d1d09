// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/signature.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "abi/functions.hpp"
#include "emit/text.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::emit {

namespace {

Argument argument(abi::Input input, const ModelNames& names) {
  using Kind = Argument::Kind;
  switch (input) {
    case abi::Input::time: return {Kind::number, Slot::time, names.time};
    case abi::Input::state: return {Kind::input, Slot::state, names.x};
    case abi::Input::parameters: return {Kind::input, Slot::parameter, names.p};
    case abi::Input::prepared: return {Kind::input, Slot::prepared, names.w};
    case abi::Input::inputs: return {Kind::input, Slot::input, names.u};
    case abi::Input::mode: return {Kind::mode, Slot::side, names.mode};
    case abi::Input::state_vector:
    case abi::Input::state_vectors:
    case abi::Input::accelerations: return {Kind::input, Slot::vector, names.v};
    case abi::Input::to: return {Kind::mode, Slot::constant, abi::name(input)};
    case abi::Input::order: break;
  }
  return {Kind::integer, Slot::constant, abi::name(input)};
}

}  // namespace

std::vector<Argument> arguments(const std::string& function, const FunctionText& text, const ModelNames& names) {
  std::vector<Argument> list;
  for (const abi::Input input : program::inputs_of(function)) list.push_back(argument(input, names));
  for (const std::string& result : text.results) list.push_back({Argument::Kind::result, Slot::constant, result});
  return list;
}

std::vector<Argument> abi_arguments(const std::string& function) {
  FunctionText text;
  for (const abi::Result& result : abi::find(function)->results) text.results.emplace_back(result.name);
  return arguments(function, text, abi_names());
}

ModelNames abi_names() {
  ModelNames names;
  names.x = abi::name(abi::Input::state);
  names.p = abi::name(abi::Input::parameters);
  names.w = abi::name(abi::Input::prepared);
  names.u = abi::name(abi::Input::inputs);
  names.mode = abi::name(abi::Input::mode);
  return names;
}

std::string argument_list(const std::vector<Argument>& arguments, const std::string& real) {
  std::string list;
  for (const Argument& argument : arguments) {
    if (!list.empty()) list += ", ";
    switch (argument.kind) {
      case Argument::Kind::number: list += fmt::format("{} {}", real, argument.name); break;
      case Argument::Kind::input: list += fmt::format("const {}* {}", real, argument.name); break;
      case Argument::Kind::mode: list += fmt::format("const int* {}", argument.name); break;
      case Argument::Kind::integer: list += fmt::format("int {}", argument.name); break;
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

std::vector<std::string> unread_arguments(const program::Function& function, const FunctionText& text,
                                          const ModelNames& names, const Leaves& leaves) {
  const auto is_read = [&](Slot slot) {
    return slot != Slot::constant &&
           std::any_of(leaves.begin(), leaves.end(), [slot](const auto& leaf) { return leaf.first == slot; });
  };
  std::vector<std::string> result;
  for (const Argument& argument : arguments(function.name, text, names)) {
    const bool read = is_read(argument.slot) || (argument.kind == Argument::Kind::mode && is_read(Slot::contact));
    if (argument.kind != Argument::Kind::result && !read) result.push_back(argument.name);
  }
  for (std::size_t r = 0; r < text.results.size(); ++r) {
    if (function.results[r].entries.empty()) result.push_back(text.results[r]);
  }
  return result;
}

std::string void_casts(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) result += fmt::format("{}(void){};", result.empty() ? "  " : " ", name);
  return result.empty() ? "" : result + "\n";
}

}  // namespace eomgen::emit
