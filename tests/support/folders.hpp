// Paths of the source tree and the build folder. They are functions, not macros, so that no test's object file depends
// on the location of the clone, and a compiler cache serves every clone.
#pragma once
#include <string>

namespace eomgen::test {

std::string source_folder();
std::string build_folder();

}  // namespace eomgen::test
