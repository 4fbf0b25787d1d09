// SPDX-License-Identifier: GPL-3.0-or-later
// Target cpp: NAME.hpp, templates over the scalar type in namespace eom::NAME, and the C sources beside it.
#include "abi/functions.hpp"
#include "emit/cpp/templates.hpp"
#include "emit/kernels.hpp"
#include "emit/metadata.hpp"
#include "emit/self_test.hpp"
#include "emit/signature.hpp"
#include "emit/targets.hpp"
#include "emit/taylor.hpp"
#include "emit/text.hpp"
#include "skeletons/cpp_model_hpp.hpp"
#include "skeletons/cpp_prepared.hpp"

namespace eomgen::emit {

std::vector<EmittedFile> emit_cpp(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  const Dialect dialect = template_dialect();
  const std::string name = mangled_id(context.id);
  const ModelNames names = model_names(program, context);
  const auto [functions, packs] = template_functions(program, names, context, dialect, "");
  std::string prepared = program.prepared_count() > 0 ? render_template(skeleton::cpp_prepared, {}, {}) : "";
  if (program.taylor) {
    const TaylorText text = print_taylor(program, names, context, dialect, "");
    prepared += "\n" + text.definition;
  }
  const SelfTestNames test{[](const std::string& f) { return f + "<double>"; }, template_kernel_prefix + "differs",
                           "nullptr"};
  std::vector<EmittedFile> files = {
      {name + ".hpp",
       render_template(
           skeleton::cpp_model_hpp,
           {{"banner", banner(program, context, "// ", "// ", "")},
            {"name", name},
            {"abi", std::to_string(abi::version)},
            {"includes", packs ? "#include <cfloat>\n#include <cmath>\n#include <cstddef>\n#include <cstring>"
                               : "#include <cmath>\n#include <cstddef>"},
            {"kernels", packs ? generic_sincos("") + sincos_kernel(template_kernel_prefix, "inline", "std::") : ""},
            {"enums", index_names(names, program)},
            {"prepared", prepared},
            {"info", string_literal(info_json(program, context), "      ")},
            {"defaults", defaults_body(program, context, dialect)},
            {"comparison", selftest_comparison(context, test, dialect)},
            {"selftest", selftest_body(program, context, test, dialect)}},
           functions)}};
  for (EmittedFile& file : emit_c(program, context)) files.push_back(std::move(file));
  return files;
}

}  // namespace eomgen::emit
