// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/targets.hpp"

#include <fmt/format.h>

#include "error.hpp"
#include "lists.hpp"

namespace eomgen::emit {
namespace {

constexpr TargetEntry registry[] = {
    {"cpp", "C++20 header of templates, and the C sources", emit_cpp, mangled_id},
    {"c", "C11 sources with the C ABI", emit_c, mangled_id},
    {"batch", "C11 sources, and the same functions for any number of states at once", emit_batch, mangled_id},
    {"cuda", "CUDA and HIP, or C++20 as the host form: the functions for threads of a device, and ensembles on it",
     emit_cuda, mangled_id, false, false},
    {"python", "Python module over the C sources: ctypes, numpy where it is there", emit_python, module_name, true},
    {"javascript", "JavaScript, a script and a module, without libraries", emit_javascript, script_name},
    {"casadi", "C11 sources, and functions for CasADi's `external` with their derivatives", emit_casadi, mangled_id},
    {"octave", "Function for Octave and MATLAB that returns the functions and names of the model", emit_octave,
     octave_name},
    {"rust", "Rust module without the standard library and allocation", emit_rust, rust_name},
    {"julia", "Julia module with functions in the form of DifferentialEquations.jl", emit_julia, julia_name},
    {"modelica", "Flat Modelica model with explicit equations", emit_modelica, modelica_name},
};

}  // namespace

std::span<const TargetEntry> targets() { return registry; }

std::vector<std::string> target_names() { return mapped<std::string>(registry, &TargetEntry::name); }

const TargetEntry* find_target(const std::string& name) { return find_named(registry, name); }

std::vector<EmittedFile> emit(const program::Program& program, const EmissionContext& context,
                              const std::string& target) {
  if (const TargetEntry* entry = find_target(target)) return entry->emit(program, context);
  throw Error("emit", {}, fmt::format("there is no target `{}`", target),
              fmt::format("targets: {}", fmt::join(target_names(), ", ")));
}

}  // namespace eomgen::emit
