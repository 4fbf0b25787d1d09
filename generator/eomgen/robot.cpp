// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/robot.hpp"

#include "import/import.hpp"
#include "import/option_words.hpp"

namespace eomgen {

RobotModel import_robot(const std::string& path, const RobotOptions& options) {
  import::ImportOptions asked;
  asked.floating = options.floating;
  asked.attitude = import::attitude_named("attitude", options.attitude);
  asked.friction = import::friction_named("friction", options.friction);
  asked.actuation = import::actuation_named("actuators", options.actuators);
  asked.stops = options.stops;
  asked.parameters = options.parameters;
  asked.exact_angles = options.exact_angles;
  import::ImportedModel found = import::import_file(path, asked);
  RobotModel result{found.robot, found.text, found.coordinates, found.inputs, {}};
  for (const import::Finding& finding : found.findings.entries())
    result.left_out.push_back({finding.what, finding.why, finding.count, static_cast<std::size_t>(finding.first.line)});
  return result;
}

}  // namespace eomgen
