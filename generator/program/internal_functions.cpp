// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/internal_functions.hpp"

#include <algorithm>

namespace eomgen::program {

std::vector<abi::Input> inputs_of(const std::string& function) {
  using enum abi::Input;
  if (const abi::Function* found = abi::find(function)) return found->inputs;
  if (function == "taylor_next") return {time, state, prepared};
  if (function == "start_values" || function == "start_rows") return {time, state, parameters};
  if (function == "to_second" || function == "to_own") return {state};
  return abi::find("rhs")->inputs;  // taylor_start
}

bool takes_inputs(const std::string& function) {
  const abi::Function* found = abi::find(function);
  return found == nullptr || found->has_input(abi::Input::inputs) || !found->has_input(abi::Input::state);
}

std::size_t vector_size(const std::string& function, const Program& program) {
  const abi::Function* found = abi::find(function);
  if (found == nullptr) return 0;
  if (found->has_input(abi::Input::state_vector)) return program.state_count();
  if (found->has_input(abi::Input::state_vectors)) return 2 * program.state_count();
  return found->has_input(abi::Input::accelerations) ? program.free.size() : 0;
}

std::size_t vector_size(const Program& program) {
  std::size_t size = 0;
  for (const Function& function : program.functions) size = std::max(size, vector_size(function.name, program));
  return size;
}

bool may_be_null(const std::string& function, std::size_t result) {
  const abi::Function* found = abi::find(function);
  return found != nullptr && result < found->results.size() && found->results[result].may_be_null;
}

}  // namespace eomgen::program
