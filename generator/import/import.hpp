// SPDX-License-Identifier: GPL-3.0-or-later
// Robot files of other programs to model files.
// In: a file and options. Out: the text of a model, and everything that was changed or left out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "import/findings.hpp"

namespace eomgen::import {

enum class Attitude { euler, euler_parameters };
enum class FrictionLaw { smooth, dry, none };
enum class Actuation { transmissions, all, none };

struct ImportOptions {
  bool floating = false;                // the root link moves freely
  Attitude attitude = Attitude::euler;  // of free links
  FrictionLaw friction = FrictionLaw::smooth;
  Actuation actuation = Actuation::transmissions;
  std::vector<std::string> stops;  // joints whose limits become end stops, by their names in the file
  bool parameters = false;         // masses, centres, tensors, damping as parameters
  bool exact_angles = false;       // 1.5708 stays 1.5708
  std::string folder;              // of mesh files; empty: none is read
};

/// A name that is not legal or not unique in a model.
struct Renaming {
  std::string kind, from, to;  // "link", "joint"
};

struct ImportedModel {
  std::string format, robot, text;
  std::size_t links = 0, joints = 0, bodies = 0, constraints = 0;
  std::vector<std::string> coordinates, inputs;
  std::vector<Renaming> renamings;
  Findings findings;
};

struct Robot;
struct Element;

/// From the root element. Throws Error for wrong values; links and joints are not yet compared with one another.
using ReadRobot = Robot(const Element& root, const ImportOptions& options);

/// A format of robot files. Each has one file, and one line in registry.cpp.
struct Format {
  const char* name;
  const char* title;
  const char* root;  // the name of the root element
  ReadRobot* read;
};
ReadRobot read_urdf, read_mjcf;  // the latter throws Error for --floating: the file states which bodies are free
std::span<const Format> formats();

/// Reads a robot file and writes it as a model. The format is that of the root element. Throws Error.
ImportedModel import_file(const std::string& path, const ImportOptions& options);
/// The same of the bytes of a file.
ImportedModel import_text(const std::string& file, const std::string& bytes, const ImportOptions& options);

}  // namespace eomgen::import
