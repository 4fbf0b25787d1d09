// SPDX-License-Identifier: GPL-3.0-or-later
// Target cuda: NAME.cuh contains the functions of the ABI as device functions; NAME_ensemble.cu and .h integrate many
// states on the device. The same text compiles as HIP, and with a plain C++20 compiler.
#include "emit/cpp/templates.hpp"
#include "emit/kernels.hpp"
#include "emit/metadata.hpp"
#include "emit/targets.hpp"
#include "error.hpp"
#include "skeletons/cuda_model_cuh.hpp"
#include "skeletons/cuda_model_ensemble_cu.hpp"
#include "skeletons/cuda_model_ensemble_h.hpp"

namespace eomgen::emit {
namespace {

const std::string mark = "EOM_DEVICE inline ";

/// Features that an integration without events and projection ignores, as lines of a comment.
std::string passed_over(const program::Program& program) {
  std::string text;
  if (program.active_constraints > 0)
    text +=
        " * Constraints with multipliers hold at the start and drift within the tolerances: there is no "
        "projection.\n";
  if (!program.kinks.empty())
    text += " * Kinks (abs, sign, min, max, if) are not located: only the error estimate responds to them.\n";
  if (!program.events.empty()) text += " * Events are ignored.\n";
  return text;
}

}  // namespace

std::vector<EmittedFile> emit_cuda(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  if (!program.charts.empty())
    throw Error("emit", {}, "the target cuda does not support charts yet",
                "use the target c or cpp, or leave --with charts out");
  if (program.taylor)
    throw Error("emit", {}, "the target cuda does not support Taylor series",
                "leave taylor out of --with, or use the target c or cpp");
  if (context.has_resets())
    throw Error("emit", {},
                "the target cuda integrates without events, and events or samples of the model change the state",
                "use the target cpp with --with run");
  if (!program.contacts.empty() || !program.contact_set.empty()) {
    throw Error("emit", {}, "the target cuda integrates without events, which contacts need for their changes of mode",
                "use the target c or cpp with eom::integrate_modes, or take the contacts out");
  }
  if (context.jumps_in_time)
    throw Error(
        "emit", {},
        "the target cuda integrates without impulses, and a prescribed motion has a kink in time, where velocities "
        "may jump",
        "use the target cpp with --with run, or make the motion smooth");
  const Dialect dialect = template_dialect();
  const std::string name = mangled_id(context.id);
  const ModelNames names = model_names(program, context);
  const auto [functions, packs] = template_functions(program, names, context, dialect, mark);
  const std::string about = banner(program, context, "// ", "// ", "");
  const std::vector<std::pair<std::string, std::string>> values = {
      {"banner", about},
      {"name", name},
      {"enums", index_names(names, program)},
      {"kernels", packs ? generic_sincos(mark) : ""},  // GPU compilers merge the two functions of an angle
      {"defaults", defaults_body(program, context, dialect)}};
  const std::vector<std::pair<std::string, std::string>> of_header = {
      {"banner", banner(program, context, "/* ", " * ", " */")}, {"name", name}, {"passed_over", passed_over(program)}};
  return {{name + ".cuh", render_template(skeleton::cuda_model_cuh, values, functions)},
          {name + "_ensemble.cu", render_template(skeleton::cuda_model_ensemble_cu, values, {})},
          {name + "_ensemble.h", render_template(skeleton::cuda_model_ensemble_h, of_header, {})}};
}

}  // namespace eomgen::emit
