// SPDX-License-Identifier: GPL-3.0-or-later
// A folder under the system's temporary one that is gone, with all in it, at the end.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

namespace eomgen::test {

struct TemporaryFolder {
  std::string path;
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "eomgen-test-XXXXXX").string();
    path = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

}  // namespace eomgen::test
