// SPDX-License-Identifier: GPL-3.0-or-later
// Comparison of functions of a program with the oracle and with differences, for tests of one or two functions.
#pragma once

#include "program/abi_values.hpp"
#include "verify/certificate.hpp"

namespace eomgen::test {

/// The certificate at three states. `functions`: with rhs.
inline verify::Certificate certify_program(const mechanics::Mechanics& mechanics,
                                           const std::vector<system::EquationSystem>& systems,
                                           const program::Program& program, std::vector<std::string> functions) {
  const auto arguments = [](const verify::AbiArguments& at) {
    return program::AbiArguments{{at.t, at.x, at.p, at.u, {}, {}, at.mode, at.v}, {}, at.order};
  };
  verify::ProgramForm form;
  form.name = "program";
  form.functions = std::move(functions);
  form.formulation = program.formulation;
  form.approach = program.approach;
  form.call = [&program, arguments](const std::string& function, const verify::AbiArguments& at, int digits) {
    return program::abi_values(program, function, arguments(at), digits);
  };
  form.bounds = [&program, arguments](const std::string& function, const verify::AbiArguments& at) {
    return program::abi_error_bounds(program, function, arguments(at));
  };
  form.rhs = [call = form.call](const verify::Real& t, const std::vector<verify::Real>& x,
                                const std::vector<verify::Real>& p, const std::vector<verify::Real>& u,
                                const std::vector<int>& mode) {
    const auto values = call("rhs", {t, x, p, u, mode}, 60);
    return values ? values->front() : std::vector<verify::Real>{};
  };
  verify::Subjects subjects;
  subjects.systems = systems;
  subjects.programs.push_back(std::move(form));
  return verify::certify(mechanics, subjects, {50, 3, 1});
}

}  // namespace eomgen::test
