// SPDX-License-Identifier: GPL-3.0-or-later
// Target `fmu`: the contents of a Functional Mock-up Unit without its binary, as files named by their paths in the
// archive. In: a program with all functions of a run. Out: modelDescription.xml, sources, documentation, icon. The
// pipeline compiles the sources and packs the archive.
#pragma once

#include "emit/fmu/variables.hpp"
#include "emit/targets.hpp"

namespace eomgen::emit {

/// The context must have the run of the default scene and its start.
std::vector<EmittedFile> emit_fmu(const program::Program& program, const EmissionContext& context,
                                  const FmuDescription& description);

inline constexpr const char* fmu_sources = "sources/";

}  // namespace eomgen::emit
