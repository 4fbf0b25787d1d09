// SPDX-License-Identifier: GPL-3.0-or-later
// The table of the functions of emitted code (docs/abi.md). Signatures, headers, documentation and templates are
// generated from it or checked against it; compiled code is loaded and called by it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::abi {

/// The version of the ABI that emitted code states (NAME_abi).
inline constexpr int version = 2;

/// An input of a function. The argument names are t, x, p, w, u, mode, order, to, and v for the last three.
enum class Input : std::uint8_t {
  time,
  state,
  parameters,
  prepared,
  inputs,
  mode,
  order,
  to,
  state_vector,   // one entry per entry of x
  state_vectors,  // two such vectors
  accelerations   // one entry per free coordinate
};
bool is_vector(Input input);  // whether it is called v
const char* name(Input input);

/// When a function is emitted.
enum class Availability : std::uint8_t {
  always,
  when_beneficial,  // if some part is worth computing only once
  on_request,       // emit --with NAME
  with_outputs,     // emit --output NAMES, or --with outputs
  with_charts       // emit --with charts
};

/// An array that a function writes.
struct Result {
  const char* name;
  bool may_be_null = false;  // null: it is not computed
};

struct Function {
  std::string name;  // without NAME_
  std::vector<Input> inputs;
  std::vector<Result> results;
  Availability availability = Availability::always;
  std::string purpose;

  bool has_input(Input input) const;
};

const std::vector<Function>& functions();

/// The function of this name, or nullptr.
const Function* find(std::string_view name);

/// Names of the functions that are emitted on request: --with NAME.
std::vector<std::string> optional_functions();

/// The prototype as printed in docs/abi.md: "int NAME_rhs(double t, const double* x, ...)".
std::string prototype(const Function& function, const std::string& name);

}  // namespace eomgen::abi
