// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/run_text.hpp"

#include "support/folders.hpp"

namespace eomgen::test {

FinishedRun run_text(const std::string& name, const std::string& sections,
                     const std::function<void(pipeline::SimulationRequest&)>& adjust) {
  const std::string path = build_folder() + "/" + name + ".toml";
  write_text(path, "format = 1\n" + sections);
  return run_model(path, adjust);
}

}  // namespace eomgen::test
