// SPDX-License-Identifier: GPL-3.0-or-later
// A temporary folder that is removed with its contents at the end of its scope.
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
