// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/compiled.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "derive/formulations/lagrange.hpp"
#include "program/build.hpp"
#include "program/interpret.hpp"

namespace eomgen::test {

RoughProgram::RoughProgram(const std::string& text, const std::vector<double>& parameters)
    : model_(model::read_model_text(text, "rough")), mechanics_(mechanics::build_mechanics(model_)) {
  std::vector<system::EquationSystem> systems{derive::lagrange(mechanics_, system::Approach::one)};
  program::Request request;
  request.with = {"events"};
  for (const auto& output : systems[0].outputs) {
    if (output.name.find("friction.") == 0 || output.name.find("reaction.") == 0)
      request.outputs.push_back(output.name);
  }
  outputs_ = request.outputs;
  program_ = program::build_program(systems, request);
  p_ = parameters;
}

int RoughProgram::rhs(double t, const double* x, int mode, double* dx) const {
  const auto values = program::interpret(program_.functions[0], arguments(t, x, mode)).results;
  std::copy(values[0].begin(), values[0].end(), dx);
  for (std::size_t i = 1; i < values.size(); ++i) {
    for (const double code : values[i]) {
      if (code < 0) return program_.functions[0].results[i].code;
    }
  }
  return 0;
}

int RoughProgram::contacts(double t, const double* x, int mode, double* g) const {
  const auto values = program::interpret(program_.functions[1], arguments(t, x, mode)).results[0];
  std::copy(values.begin(), values.end(), g);
  return 0;
}

std::vector<eom::Contact> RoughProgram::contact_list() const {
  std::vector<eom::Contact> result;
  for (const program::ContactInfo& contact : program_.contacts) result.push_back({contact, contact.name, 0});
  return result;
}

double RoughProgram::output(const std::string& name, double t, const double* x, int mode) const {
  const auto values = program::interpret(program_.functions[2], arguments(t, x, mode)).results[0];
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (outputs_[i] == name) return values[i];
  }
  throw std::logic_error("no output " + name);
}

}  // namespace eomgen::test
