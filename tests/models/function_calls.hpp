// SPDX-License-Identifier: GPL-3.0-or-later
// The values of compiled C code at the states of its self test, with which tests compare other languages.
#pragma once

#include <string>
#include <vector>

#include "program/internal_functions.hpp"
#include "support/simulation.hpp"

namespace eomgen::test {

struct FunctionCall {
  std::string name;
  const emit::TestVector* at = nullptr;
  std::vector<double> v;  // the argument v, if the function takes it
  int code = 0;
  std::vector<std::vector<double>> results;
};

/// A model with the functions that the tests of languages compare, and the values of its C code.
struct ComparedModel {
  std::shared_ptr<pipeline::DerivedModel> derived;
  program::Program program;
  emit::EmissionContext context;
  std::vector<FunctionCall> calls;
};

inline ComparedModel compared_model(const std::string& name, const std::vector<std::string>& functions,
                                    const std::vector<std::string>& outputs) {
  ComparedModel model;
  model.derived = pipeline::derive_model(test::model_at(model_path(name)), pipeline::ApproachChoice::automatic);
  program::Request request;
  request.with = functions;
  request.outputs = outputs;
  model.program = pipeline::make_program(*model.derived, request);
  const run::Scene scene = run::resolve_scene(model.derived->mechanics, model.derived->candidates.front(),
                                              model.derived->model.scene("default"), {});
  model.context = pipeline::emission_context(*model.derived, model.program, scene, {});
  return model;
}

/// Fills in `calls`, whose states are those of `context`.
inline void call_c(ComparedModel& model) {
  const pipeline::CompiledCode code = pipeline::compile(model.program, model.context);
  for (const emit::TestVector& at : model.context.tests) {
    for (const program::Function& function : model.program.functions) {
      if (function.name == "prepare" || function.name == "rhs_prepared") continue;
      FunctionCall call{function.name, &at, at.v, 0, {}};
      call.v.resize(program::vector_size(function.name, model.program));
      for (const program::Result& result : function.results) {
        if (!result.is_test()) call.results.emplace_back(result.entries.size());
      }
      abi::CallArguments arguments;
      arguments.t = at.t;
      arguments.x = at.x.data();
      arguments.p = at.p.data();
      arguments.u = at.u.empty() ? nullptr : at.u.data();
      arguments.v = call.v.data();
      arguments.mode = at.mode.empty() ? nullptr : at.mode.data();
      for (std::size_t r = 0; r < call.results.size(); ++r) arguments.results.at(r) = call.results[r].data();
      call.code = code.functions().call(function.name, arguments);
      model.calls.push_back(std::move(call));
    }
  }
}

}  // namespace eomgen::test
