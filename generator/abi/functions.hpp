// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of emitted code (docs/abi.md) as one table: their signatures, headers, documentation and templates are
// made of it or held against it, compiled code is loaded and called by it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::abi {

/// What a function takes. The name of the argument: t, x, p, w, u, mode, order, to.
enum class Input : std::uint8_t { time, state, parameters, prepared, inputs, mode, order, to };
const char* name(Input input);

/// With what a function comes.
enum class Comes : std::uint8_t {
  always,
  where_it_saves,  // where something is worth computing once
  with,            // emit --with NAME
  with_outputs,    // emit --output NAMES, or --with outputs
  with_charts      // emit --with charts
};

/// An array that a function writes.
struct Result {
  const char* name;
  bool may_be_null = false;  // it is left out then
};

struct Function {
  std::string name;  // without NAME_
  std::vector<Input> inputs;
  std::vector<Result> results;
  Comes comes = Comes::always;
  std::string purpose;

  bool takes(Input input) const;
};

const std::vector<Function>& functions();

/// Of this name, or none.
const Function* find(std::string_view name);

/// Names of those that are asked for: --with NAME.
std::vector<std::string> asked_for();

/// "int NAME_rhs(double t, const double* x, ...)", as docs/abi.md has it.
std::string prototype(const Function& function, const std::string& name);

}  // namespace eomgen::abi
