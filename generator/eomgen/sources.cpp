// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/targets.hpp"
#include "eomgen/call.hpp"
#include "eomgen/model.hpp"
#include "eomgen/validation.hpp"
#include "pipeline/archives.hpp"
#include "pipeline/emission.hpp"
#include "pipeline/verification.hpp"

namespace eomgen {

Certificate Model::verify(const VerifyOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_lock(control, [&](CallListener&) {
    const verify::Certificate found =
        pipeline::verify_model(read_, {options.digits, options.points, options.seed, options.compile});
    Certificate result;
    result.pass = found.pass;
    result.points = found.points;
    result.digits = found.options.digits;
    result.comparisons = found.comparisons;
    result.left_out = found.left_out;
    result.summary = found.summary();
    result.interrupted = found.interrupted;
    return result;
  });
}

Sources Model::emit(const EmitOptions& options, const CallControl& control) const {
  if (options.real_type != "double" && options.real_type != "float")
    throw Error("library", {}, "code computes in `double` or in `float`", "choose one of them");
  return with_lock(control, [&](CallListener&) {
    pipeline::EmissionRequest request{options.target,
                                      approach_choice(options.approach),
                                      pipeline::parse_form(options.form),
                                      options.extra_functions,
                                      options.outputs,
                                      options.fixed_parameters,
                                      options.seed,
                                      options.real_type == "float"};
    const pipeline::Emission emission = pipeline::emit_model(read_, request);
    Sources result;
    result.files = emission.files;
    result.formulation = emission.program.formulation;
    result.approach = system::name(emission.program.approach);
    result.form = system::name(emission.program.form);
    result.flops = emission.program.functions.front().operations.flops();
    result.certificate = emission.certificate.summary();
    result.single_precision_error = emission.single_error.value_or(0);
    return result;
  });
}

std::vector<std::string> targets() { return pipeline::target_names(); }

}  // namespace eomgen
