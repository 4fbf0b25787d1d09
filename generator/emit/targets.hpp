// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of targets: one folder and one line per target (docs/adding-a-target.md).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"
#include "results.hpp"

namespace eomgen::emit {

using EmittedFile = SourceFile;

/// The sources of one target. Throws Error for features of the program or of the context that the target lacks.
using EmitTarget = std::vector<EmittedFile>(const program::Program& program, const EmissionContext& context);

EmitTarget emit_c;           // NAME.c and NAME.h, the C ABI of docs/abi.md in a C11 subset that C++ compiles too
EmitTarget emit_cpp;         // NAME.hpp, templates over the scalar type in namespace eom::NAME, and the C sources
EmitTarget emit_batch;       // the C sources, NAME_batch.c and NAME_batch.h: many states in the lanes of SIMD registers
EmitTarget emit_cuda;        // NAME.cuh, device functions; NAME_ensemble.cu and .h integrate many states
EmitTarget emit_python;      // NAME.py, which compiles the C sources on import, and the integrator NAME_simulate.c
EmitTarget emit_javascript;  // NAME.js, a script for pages and a module for Node
EmitTarget emit_casadi;      // the C sources, and NAME_casadi.c with functions that CasADi loads by `external`
EmitTarget emit_octave;      // NAME.m, a function that returns the functions and names of the model
EmitTarget emit_rust;        // NAME.rs, a module that needs neither the standard library nor allocation
EmitTarget emit_julia;       // NAME.jl, a module with functions in the form of DifferentialEquations.jl
EmitTarget emit_modelica;    // NAME.mo, a flat model: parameters, inputs, states and their explicit equations

// NAME of languages that reserve words: such a name gets an underscore at its end.
std::string octave_name(const std::string& id);  // a hash ends names of more than 63 characters, MATLAB's limit
std::string rust_name(const std::string& id);
std::string julia_name(const std::string& id);
std::string modelica_name(const std::string& id);

struct TargetEntry {
  const char* name;
  const char* title;
  EmitTarget* emit;
  std::string (*mangle)(const std::string& id);  // NAME of files and symbols, from the model's id
  bool integrates = false;     // its files set starts and integrate: they need start, events and resets
  bool can_set_starts = true;  // whether --with start has a form in it
};

std::span<const TargetEntry> targets();
std::vector<std::string> target_names();
/// nullptr if there is no target of this name, as for archives.
const TargetEntry* find_target(const std::string& name);

/// Emits the sources for `target`. Throws Error with the list of known targets if it is unknown.
std::vector<EmittedFile> emit(const program::Program& program, const EmissionContext& context,
                              const std::string& target = "cpp");

}  // namespace eomgen::emit
