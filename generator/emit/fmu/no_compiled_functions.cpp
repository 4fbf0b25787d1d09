// SPDX-License-Identifier: GPL-3.0-or-later
// Programs for systems without shared libraries, such as WebAssembly.
#include "emit/fmu/compiled_functions.hpp"
#include "error.hpp"

namespace eomgen::emit {
namespace {

[[noreturn]] void refuse_fmu() {
  throw Error("emit", {}, "this eomgen makes no FMU, because it was built for a system without shared libraries",
              "use an eomgen for Linux", ErrorKind::tool);
}

}  // namespace

std::string_view compiled_fmi_functions() { refuse_fmu(); }
std::vector<std::string> headers_of_fmi_functions() { refuse_fmu(); }

}  // namespace eomgen::emit
