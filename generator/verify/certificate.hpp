// SPDX-License-Identifier: GPL-3.0-or-later
// In: all forms of the equations of motion of one model: the formulations, the display form, the optimised program, the
// compiled code. Out: a certificate. It compares them with the oracle and with one another at random states, and lists
// which pairs share code and which disagree. Method and tolerances: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "oracle/jet.hpp"
#include "system/equation_system.hpp"
#include "work.hpp"

namespace eomgen::verify {

/// Extra digits of the arithmetic: rounding in the comparisons stays below the requested digits.
inline constexpr int guard_digits = 10;

struct Options {
  int digits = 50;  // 10 to 300; a binary64 cannot hold smaller differences
  std::size_t points = 20;
  std::uint64_t seed = 1;
  std::map<std::uint32_t, cln::cl_RA> fixed = {};  // parameters that are constants of the program
  std::optional<int> extra_digits = {};            // required_extra_digits, if it is known
};

/// Expressions that vanish for the true motion, in t, q, qdot, qddot of all coordinates, functions of time, parameters,
/// inputs and the multipliers of all constraints, on the Dag of the Mechanics. A form without residuals (it was too
/// long) is not compared.
struct DisplayForm {
  std::string name;  // "display form I"
  std::vector<symbolic::Ref> residuals;
};

/// Arguments of a function of the C ABI; `order` is that of `taylor`.
struct AbiArguments {
  Real t;
  std::vector<Real> x, p, u;
  std::vector<int> mode = {};  // states of the contacts; empty: all are 0
  int order = 0;
  std::vector<Real> v = {};  // of functions with a vector
};
/// The arrays that a function of the C ABI writes.
using AbiResults = std::vector<std::vector<Real>>;

/// The optimised program in CLN arithmetic: dx = (qdot, qddot) of the free coordinates at (t, x, p, u) in a mode. The
/// result is empty if the program reports that the law of friction has no solution there, or several.
struct ProgramForm {
  std::string name;  // "program"
  std::function<std::vector<Real>(const Real& t, const std::vector<Real>& x, const std::vector<Real>& p,
                                  const std::vector<Real>& u, const std::vector<int>& mode)>
      rhs;
  // Names of the ABI functions that the program has; none if they are not compared.
  std::vector<std::string> functions = {};
  std::function<std::optional<AbiResults>(const std::string& function, const AbiArguments& at, int digits)> call = {};
  /// First-order bounds of the rounding errors in binary64.
  std::function<std::vector<std::vector<double>>(const std::string& function, const AbiArguments& at)> bounds = {};
  std::string formulation = {};  // the formulation of its equations
  system::Approach approach = system::Approach::two;
  std::vector<std::string> outputs = {};  // names of the values of its function `outputs`
  std::vector<Real> default_inputs = {};
};

/// Compiled code in binary64; its functions return nothing for an error code.
struct CompiledForm {
  std::string name;  // "emitted code"
  std::function<std::optional<std::vector<double>>(double t, const std::vector<double>& x, const std::vector<double>& p,
                                                   const std::vector<double>& u, const std::vector<int>& mode)>
      rhs;
  std::function<std::optional<std::vector<std::vector<double>>>(const std::string& function, const AbiArguments& at)>
      call = {};
};

struct Subjects {
  std::vector<work::LeftOut> left_out = {};
  std::vector<system::EquationSystem> systems;
  std::vector<DisplayForm> reading;
  std::vector<ProgramForm> programs;
  std::vector<CompiledForm> compiled;
};

using eomgen::Comparison;

struct Certificate {
  // Defined in the .cpp file, so that they are compiled only once.
  Certificate();
  Certificate(const Certificate&);
  Certificate(Certificate&&) noexcept;
  Certificate& operator=(const Certificate&);
  Certificate& operator=(Certificate&&) noexcept;
  ~Certificate();

  Options options;
  std::vector<Comparison> comparisons;
  std::size_t points = 0;
  std::map<std::string, std::size_t> rejected;  // by reason
  std::vector<work::LeftOut> left_out;          // formulations and forms that were not compared
  bool pass = false;
  bool interrupted = false;  // before all points were compared
  const char* verdict() const { return pass ? "pass" : "fail"; }
  std::size_t rejections() const;
  /// "pass: 20 points, 50 digits, worst 3.1e-49 (jacobian II against d'Alembert)"
  std::string summary() const;
  /// The forms that agree with d'Alembert's principle in all their rows: "lagrange II", "display form I".
  std::vector<std::string> agreeing_forms() const;
};

/// Every formulation of derive::formulations(), by both approaches, that applies within its budget. The others are
/// listed in `left_out`.
std::vector<system::EquationSystem> all_formulations(mechanics::Mechanics& mechanics,
                                                     std::vector<work::LeftOut>* left_out = nullptr);

/// Extra digits for parameters, starts, rates and times far from 1: next to a mass of 1e300 kg all other terms would be
/// lost. 0 for usual values.
int required_extra_digits(const mechanics::Mechanics& mechanics);

/// Compares the subjects at random states. Throws Error{ErrorKind::check} if no states can be found. After an
/// interruption the certificate covers the points that were compared.
Certificate certify(const mechanics::Mechanics& mechanics, const Subjects& subjects, const Options& options = {});

/// Certifies all formulations.
Certificate verify(mechanics::Mechanics& mechanics, const Options& options = {});

}  // namespace eomgen::verify
