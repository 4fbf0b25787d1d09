// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/python/python.hpp"

#include "emit/c/c.hpp"
#include "emit/metadata.hpp"
#include "error.hpp"
#include "skeletons/python_model_py.hpp"
#include "skeletons/python_simulate_c.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_python(const program::Program& program, const EmissionContext& context) {
  if (!program.contacts.empty()) {
    throw Error("emit", {}, "the Python target does not know modes of friction yet", "use the target c or cpp");
  }
  if (!program.charts.empty()) {
    throw Error("emit", {}, "the Python target does not know charts yet",
                "use the target c or cpp, or leave --with charts out");
  }
  std::vector<EmittedFile> files = emit_c(program, context);
  const std::string name = mangled_id(context.id);
  files.push_back({name + "_simulate.c", rendered(skeleton::python_simulate_c, {{"name", name}}, {})});
  files.push_back({module_name(context.id) + ".py",
                   rendered(skeleton::python_model_py,
                            {{"banner", banner(program, context, "# ", "# ", "")}, {"name", name}}, {})});
  return files;
}

}  // namespace eomgen::emit
