#include "support/folders.hpp"

namespace eomgen::test {

std::string source_folder() { return EOMGEN_SOURCE_DIR; }
std::string build_folder() { return EOMGEN_BINARY_DIR; }

}  // namespace eomgen::test
