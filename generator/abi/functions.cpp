// SPDX-License-Identifier: GPL-3.0-or-later
#include "abi/functions.hpp"

#include <algorithm>

namespace eomgen::abi {
namespace {

std::vector<Function> all() {
  using enum Input;
  using enum Availability;
#define INPUTS(...) \
  std::vector<Input> { __VA_ARGS__ }
#define RESULTS(...) \
  std::vector<Result> { __VA_ARGS__ }
#define ABI_FUNCTION(name, takes, gives, comes, purpose) {#name, takes, gives, comes, purpose},
  return {
#include "abi/functions.inc"
  };
#undef ABI_FUNCTION
#undef RESULTS
#undef INPUTS
}

}  // namespace

const char* name(Input input) {
  switch (input) {
    case Input::time: return "t";
    case Input::state: return "x";
    case Input::parameters: return "p";
    case Input::prepared: return "w";
    case Input::inputs: return "u";
    case Input::mode: return "mode";
    case Input::order: return "order";
    case Input::state_vector:
    case Input::state_vectors:
    case Input::accelerations: return "v";
    case Input::to: break;
  }
  return "to";
}

bool Function::has_input(Input input) const { return std::find(inputs.begin(), inputs.end(), input) != inputs.end(); }

bool is_vector(Input input) {
  return input == Input::state_vector || input == Input::state_vectors || input == Input::accelerations;
}

const std::vector<Function>& functions() {
  static const std::vector<Function> table = all();
  return table;
}

const Function* find(std::string_view name) {
  const std::vector<Function>& all = functions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Function& f) { return f.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> optional_functions() {
  std::vector<std::string> names;
  for (const Function& function : functions()) {
    if (function.availability == Availability::on_request || function.availability == Availability::with_outputs)
      names.push_back(function.name);
  }
  return names;
}

std::string prototype(const Function& function, const std::string& name) {
  std::string list;
  const auto add = [&list](const char* type, const char* argument) {
    list += (list.empty() ? "" : ", ") + std::string(type) + argument;
  };
  for (const Input input : function.inputs) {
    switch (input) {
      case Input::time: add("double ", abi::name(input)); break;
      case Input::order: add("int ", abi::name(input)); break;
      case Input::mode:
      case Input::to: add("const int* ", abi::name(input)); break;
      default: add("const double* ", abi::name(input));
    }
  }
  for (const Result& result : function.results) add("double* ", result.name);
  return "int " + name + "_" + function.name + "(" + list + ")";
}

}  // namespace eomgen::abi
