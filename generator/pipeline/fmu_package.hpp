// SPDX-License-Identifier: GPL-3.0-or-later
// The archive of an FMU: its contents (emit/fmu), compiled for this machine and packed. Out: one file, NAME.fmu.
#pragma once

#include <vector>

#include "pipeline/archives.hpp"

namespace eomgen::pipeline {

/// Throws Error{ErrorKind::tool} without a C or C++ compiler, or without Eigen.
std::vector<emit::EmittedFile> make_fmu(const ArchiveContents& contents);

}  // namespace eomgen::pipeline
