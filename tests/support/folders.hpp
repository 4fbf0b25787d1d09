// Where the source tree and the build folder lie. Functions, not macros: no test's object file then depends on where
// the tree was cloned to, and a compiler cache serves every clone.
#pragma once
#include <string>

namespace eomgen::test {

std::string source_folder();
std::string build_folder();

}  // namespace eomgen::test
