// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/verification.hpp"

#include "abi/functions.hpp"
#include "error.hpp"
#include "pipeline/code.hpp"

namespace eomgen::pipeline {
namespace {

/// Every function that `emit` offers, except Taylor series and Jacobian matrices of all outputs if they are too large.
program::Program with_every_function(DerivedModel& derived) {
  program::Request request;
  request.with = abi::optional_functions();
  std::erase(request.with, "outputs");  // outputs are requested by name
  const system::EquationSystem& system = derived.candidates.front();
  if (system.contacts_with_inputs.empty()) std::erase(request.with, "rhs_open");  // it is rhs
  for (const system::Output& output : system.outputs) request.outputs.push_back(output.name);
  // `emit` writes few outputs, and all of their derivatives.
  constexpr std::size_t most_derivatives = 4000;
  for (const auto& [function, columns] : {std::pair{"outputs_jac", system.layout().size()},
                                          {"outputs_jac_p", derived.model.parameters.size()},
                                          {"outputs_jac_u", derived.model.inputs.size()}})
    if (columns * request.outputs.size() > most_derivatives) std::erase(request.with, function);
  try {
    return make_program(derived, request);
  } catch (const Error&) {
    std::erase(request.with, "taylor");
    return make_program(derived, request);
  }
}

/// For a model whose coordinates are all eliminated, which has no code: compares the formulations and the display forms
/// with the oracle, above all their constraint forces.
std::optional<verify::Certificate> certify_prescribed(const std::shared_ptr<const model::Model>& model,
                                                      const VerificationRequest& request) {
  std::size_t equations = 0;
  for (const model::Constraint& constraint : model->constraints) equations += constraint.psi.size();
  if (equations < model->coordinates.size()) return std::nullopt;
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  if (!mechanics.free.empty() && mechanics.degrees_of_freedom() >= 0) return std::nullopt;
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(mechanics, &subjects.left_out);
  add_display_forms(mechanics, subjects);
  return verify::certify(mechanics, subjects, {request.digits, request.points, request.seed, {}});
}

}  // namespace

verify::Certificate verify_model(std::shared_ptr<const model::Model> model, const VerificationRequest& request) {
  if (const auto prescribed = certify_prescribed(model, request)) return *prescribed;
  const std::unique_ptr<DerivedModel> derived = derive_model(std::move(model), ApproachChoice::automatic);
  const program::Program program = with_every_function(*derived);
  Verification verification{request.digits, request.points, request.seed, nullptr};
  verification.reductions = true;
  verification.partial = true;
  verification.use_cache = false;
  std::optional<CompiledCode> code;
  verify::CompiledForm compiled;
  if (request.compile) {
    code.emplace(compile_for_verification(*derived, program));
    compiled = code->form();
    verification.compiled = &compiled;
    verification.default_inputs = default_inputs(*derived);
  }
  return certify(*derived, program, verification);
}

}  // namespace eomgen::pipeline
