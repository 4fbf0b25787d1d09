// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/compiled_functions.hpp"

#include <set>
#include <sstream>

// Its hash: compiler caches see this header and not the object, and compile again when it changes.
#include EOMGEN_FMI_HASH

// CMake defines the two files, and compiles this one again when they change.
__asm__(
    ".section .rodata\n"
    "eomgen_fmi_object: .incbin \"" EOMGEN_FMI_OBJECT
    "\"\n"
    "eomgen_fmi_object_end: .byte 0\n"
    "eomgen_fmi_headers: .incbin \"" EOMGEN_FMI_OBJECT
    ".headers\"\n"
    "eomgen_fmi_headers_end: .byte 0\n"
    ".global eomgen_fmi_object, eomgen_fmi_object_end, eomgen_fmi_headers, eomgen_fmi_headers_end\n"
    ".hidden eomgen_fmi_object, eomgen_fmi_object_end, eomgen_fmi_headers, eomgen_fmi_headers_end\n"
    ".text\n");

extern "C" {
extern const char eomgen_fmi_object[] __attribute__((visibility("hidden")));
extern const char eomgen_fmi_object_end[] __attribute__((visibility("hidden")));
extern const char eomgen_fmi_headers[] __attribute__((visibility("hidden")));
extern const char eomgen_fmi_headers_end[] __attribute__((visibility("hidden")));
}

namespace eomgen::emit {

std::string_view compiled_fmi_functions() {
  return {eomgen_fmi_object, static_cast<std::size_t>(eomgen_fmi_object_end - eomgen_fmi_object)};
}

std::vector<std::string> headers_of_fmi_functions() {
  // A list of dependencies as compilers write it, with absolute paths of the machine that compiled.
  const std::string_view list(eomgen_fmi_headers,
                              static_cast<std::size_t>(eomgen_fmi_headers_end - eomgen_fmi_headers));
  std::istringstream words{std::string(list)};
  std::set<std::string> result;
  for (std::string word; words >> word;) {
    const std::size_t at = word.find("/Eigen/");
    if (at != std::string::npos) result.insert(word.substr(at + 1));
  }
  return {result.begin(), result.end()};
}

}  // namespace eomgen::emit
