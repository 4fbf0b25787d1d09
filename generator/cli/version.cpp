// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/version.hpp"

#include "cli/commit.hpp"

namespace eomgen::cli {

std::string version_text() {
  const std::string commit = source_commit;
  return commit.empty() ? EOMGEN_VERSION : EOMGEN_VERSION " (commit " + commit + ")";
}

}  // namespace eomgen::cli
