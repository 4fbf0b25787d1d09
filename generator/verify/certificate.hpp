// SPDX-License-Identifier: GPL-3.0-or-later
// In: everything that claims to be the equations of motion of one model: the routes, the reading form, the optimised
// program, the compiled code. Out: a certificate that holds them against the judge and against one another at random
// states, says which pairs share code, and names what disagrees. Method and tolerances: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"
#include "verify/jet.hpp"
#include "work.hpp"

namespace eomgen::verify {

/// Beyond the digits asked for, so that rounding in the comparisons themselves stays below them.
inline constexpr int guard_digits = 10;

struct Options {
  int digits = 50;  // 10 to 300: beyond, a binary64 cannot hold a difference
  std::size_t points = 20;
  std::uint64_t seed = 1;
  std::map<std::uint32_t, cln::cl_RA> fixed = {};  // parameters that a program has as numbers
  std::optional<int> range = {};                   // digits_of_range where it is known
};

/// Expressions that vanish for the true motion, in t, q, qdot, qddot of all coordinates, functions of time, parameters,
/// inputs and the multipliers of all constraints, on the Dag of the Mechanics. None of them: the form claims nothing
/// (it was too long to be read) and is left out.
struct ReadingForm {
  std::string name;  // "reading form I"
  std::vector<symbolic::Ref> residuals;
};

/// Arguments of a function of the C ABI; `order` of taylor.
struct At {
  Real t;
  std::vector<Real> x, p, u;
  int mode = 0, order = 0;
};
/// The arrays that it writes.
using Arrays = std::vector<std::vector<Real>>;

/// The optimised program read in CLN arithmetic: dx = (qdot, qddot) of the free coordinates at (t, x, p, u) in a mode;
/// nothing where it says that the law of friction has no solution there, or several.
struct ProgramForm {
  std::string name;  // "program"
  std::function<std::vector<Real>(const Real& t, const std::vector<Real>& x, const std::vector<Real>& p,
                                  const std::vector<Real>& u, int mode)>
      rhs;
  // All functions of the ABI that it has, by name; left out: they are not compared.
  std::vector<std::string> functions = {};
  std::function<std::optional<Arrays>(const std::string& function, const At& at, int digits)> call = {};
  /// How far binary64 may be off, to first order.
  std::function<std::vector<std::vector<double>>(const std::string& function, const At& at)> bounds = {};
  std::string route = {};  // whose equations it is made of
  system::Approach approach = system::Approach::two;
  std::vector<std::string> outputs = {};  // names of those of its function `outputs`
  std::vector<Real> default_inputs = {};
};

/// Compiled code in binary64; nothing where it reports an error code.
struct CompiledForm {
  std::string name;  // "emitted code"
  std::function<std::optional<std::vector<double>>(double t, const std::vector<double>& x, const std::vector<double>& p,
                                                   const std::vector<double>& u, int mode)>
      rhs;
  std::function<std::optional<std::vector<std::vector<double>>>(const std::string& function, const At& at)> call = {};
};

struct Subjects {
  std::vector<work::LeftOut> left_out = {};
  std::vector<system::EquationSystem> systems;
  std::vector<ReadingForm> reading;
  std::vector<ProgramForm> programs;
  std::vector<CompiledForm> compiled;
};

struct Comparison {
  std::string a, b;
  bool shares_code = false;
  double max_relative_difference = 0;
  double tolerance = 0;
  int digits_agreed = 0;  // of those asked for
  bool pass = true;
};

struct Certificate {
  // Defined once: every file that holds one would compile them anew.
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
  std::vector<work::LeftOut> left_out;          // routes and forms that were not compared
  bool pass = false;
  bool interrupted = false;  // before all points were compared
  const char* verdict() const { return pass ? "pass" : "fail"; }
  std::size_t rejections() const;
  /// "pass: 20 points, 50 digits, worst 3.1e-49 (jacobian II against d'Alembert)"
  std::string summary() const;
  /// What agrees with d'Alembert's principle in every row of its own: "lagrange II", "reading form I".
  std::vector<std::string> agreeing() const;
};

/// Every route of derive::routes() by both approaches that applies within its budget; the others are told in
/// `left_out`.
std::vector<system::EquationSystem> all_routes(mechanics::Mechanics& mechanics,
                                               std::vector<work::LeftOut>* left_out = nullptr);

/// Digits beyond those of a comparison that parameters, starts, rates and times far from 1 take: beside a mass of 1e300
/// kg everything else would be lost. 0 for usual ones.
int digits_of_range(const mechanics::Mechanics& mechanics);

/// Throws Error{Fault::check} if no states can be found at which to compare. An interruption leaves the points that
/// were compared.
Certificate certify(const mechanics::Mechanics& mechanics, const Subjects& subjects, const Options& options = {});

/// certify of all routes.
Certificate verify(mechanics::Mechanics& mechanics, const Options& options = {});

}  // namespace eomgen::verify
