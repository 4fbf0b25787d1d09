// SPDX-License-Identifier: GPL-3.0-or-later
// Target `fmu`: the contents of a Functional Mock-up Unit without its binary, as files named by their paths in the
// archive. In: a program with all functions of a run. Out: modelDescription.xml, sources, documentation, icon. The
// pipeline compiles the sources and packs the archive.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emit/context.hpp"
#include "emit/targets.hpp"
#include "program/program.hpp"

namespace eomgen::emit {

/// The powers of m kg s A K mol cd of a unit in SI, and the unit of a rate.
struct UnitDescription {
  std::array<int, 7> powers{};
  std::string rate;
};

/// Content of an FMU in addition to the context of an emission.
struct FmuDescription {
  int version = 3;                                    // of FMI: 2 or 3
  std::vector<std::string> output_units = {};         // per output of the program; empty where unknown
  std::map<std::string, UnitDescription> units = {};  // of all quantities, by their text
  std::size_t jump_surfaces = 0;                      // in the state, at which something may jump
};

/// A variable of an FMU; they are in the order of their value references (lib/eom/fmi/model_code.hpp).
struct FmuVariable {
  std::string name, unit, description;
  std::string causality, variability, initial;  // as FMI names them
  std::optional<double> start = {};
  std::optional<std::size_t> derivative_of = {};  // value reference of the state
  std::optional<double> nominal = {};
  bool is_state = false;      // continuous
  bool is_indicator = false;  // an event indicator

  /// Whether its value at the start is computed.
  bool is_calculated() const { return initial == "calculated"; }
};

struct FmuVariables {
  std::vector<FmuVariable> all;
  std::vector<std::size_t> outputs;          // indices in y, of the outputs that are no states
  std::vector<double> nominals;              // of the continuous states
  std::vector<bool> calculated, from_start;  // per parameter
  std::size_t event_indicators = 0;
};

FmuVariables fmu_variables(const program::Program& program, const EmissionContext& context,
                           const FmuDescription& description);

/// The context must have the run of the default scene and its start.
std::vector<EmittedFile> emit_fmu(const program::Program& program, const EmissionContext& context,
                                  const FmuDescription& description);

inline constexpr const char* fmu_sources = "sources/";

}  // namespace eomgen::emit
