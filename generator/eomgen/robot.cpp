// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/robot.hpp"

#include "import/import.hpp"
#include "import/option_words.hpp"

namespace eomgen {

RobotModel import_robot(const std::string& path, const RobotOptions& options) {
  import::ImportedModel found = import::import_file(path, import::import_options(options));
  RobotModel result{found.robot, found.text, found.coordinates, found.inputs, {}};
  for (const import::Finding& finding : found.findings.entries())
    result.left_out.push_back({finding.what, finding.why, finding.count, static_cast<std::size_t>(finding.first.line)});
  return result;
}

}  // namespace eomgen
