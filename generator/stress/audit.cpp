// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress/audit.hpp"

#include <cln/dfloat.h>
#include <cln/exception.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lists.hpp"
#include "mechanics/mechanics.hpp"
#include "numeric/dense.hpp"
#include "numeric/numbers.hpp"
#include "program/interpret.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::stress {

using program::Function;
using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

namespace {

/// The denominators of a function, as text.
struct Divisor {
  program::Operand operand;
  std::string expression, zero, test;
};

constexpr std::size_t longest = 160;  // letters; longer expressions are reported by their size

class Text {
 public:
  Text(const Function& function, const program::Program& program, const mechanics::Mechanics& mechanics)
      : function_(function), program_(program), model_(*mechanics.model), known_(function.code.size()) {}

  std::string of(const Operand& operand) {
    const std::string size = magnitude(operand);
    return operand.negated ? "-" + in_brackets(size) : size;
  }

  std::string zero(const Operand& operand) {
    if (operand.slot == Slot::value) {
      const Instruction& i = function_.code[operand.index];
      if (i.op == Op::sin) return of(i.operands[0]) + " = k pi";
      if (i.op == Op::cos) return of(i.operands[0]) + " = pi/2 + k pi";
    }
    return magnitude(operand) + " = 0";
  }

  std::string magnitude(const Operand& operand) {
    switch (operand.slot) {
      case Slot::constant: return number(function_.constants[operand.index]);
      case Slot::pi: return "pi";
      case Slot::time: return "t";
      case Slot::state: return state(operand.index);
      case Slot::parameter: return model_.parameters[operand.index].name;
      case Slot::input: return model_.inputs[operand.index].name;
      case Slot::prepared: return fmt::format("w[{}]", operand.index);
      case Slot::vector: return fmt::format("v[{}]", operand.index);
      case Slot::side: return fmt::format("side[{}]", operand.index);
      case Slot::contact: return fmt::format("mode[{}]", operand.index);
      case Slot::value: break;
    }
    std::string& text = known_[operand.index];
    if (text.empty()) {
      text = call(function_.code[operand.index]);
      if (text.size() > longest) {
        const std::string& name = function_.code[operand.index].name;
        text = name.empty() || name.find('{') != std::string::npos ? fmt::format("<value {}>", operand.index)
                                                                   : fmt::format("<{}>", name);
      }
    }
    return text;
  }

 private:
  static std::string number(const symbolic::Rational& value) {
    return cln::denominator(value) == 1 ? fmt::format("{:.17g}", cln::double_approx(value))
                                        : fmt::format("{:.17g}/{:.17g}", cln::double_approx(cln::numerator(value)),
                                                      cln::double_approx(cln::denominator(value)));
  }

  std::string state(std::uint32_t i) const {
    const std::size_t n = program_.free.size(), others = program_.layout().first_order_begin();
    if (i >= others) return model_.states[program_.states[i - others].index].name;
    const std::string& name = model_.coordinates[program_.free[i % n]].name;
    return i < n ? name : name + "_dot";
  }

  static bool is_plain(const std::string& text) { return text.find_first_of("+- ") == std::string::npos; }
  static std::string in_brackets(const std::string& text) { return is_plain(text) ? text : "(" + text + ")"; }

  std::string call(const Instruction& i) {
    std::string text;
    switch (i.op) {
      case Op::add:
        for (const Operand& o : i.operands)
          text += (text.empty() ? (o.negated ? "-" : "")
                   : o.negated  ? " - "
                                : " + ") +
                  (o.negated ? in_brackets(magnitude(o)) : magnitude(o));
        return text;
      case Op::mul:
        for (const Operand& o : i.operands) text += (text.empty() ? "" : "*") + in_brackets(of(o));
        return text;
      case Op::div: {
        const std::string below = of(i.operands[1]);
        const bool plain = below.find_first_of("+-*/ ") == std::string::npos;
        return in_brackets(of(i.operands[0])) + "/" + (plain ? below : "(" + below + ")");
      }
      case Op::power: return in_brackets(of(i.operands[0])) + fmt::format("^{}", i.exponent);
      case Op::pow: return in_brackets(of(i.operands[0])) + "^" + in_brackets(of(i.operands[1]));
      default: break;
    }
    for (const Operand& o : i.operands) text += (text.empty() ? "" : ", ") + of(o);
    return symbolic::function_of(i.op).name + ("(" + text + ")");
  }

  const Function& function_;
  const program::Program& program_;
  const model::Model& model_;
  std::vector<std::string> known_;
};

/// Lists the operands whose zeros make the function undefined: factors of a product, arguments of a root or a power.
void factors(const Function& function, const Operand& operand, std::vector<Operand>& list) {
  if (operand.slot == Slot::value) {
    const Instruction& i = function.code[operand.index];
    if (i.op == Op::mul) {
      for (const Operand& o : i.operands) factors(function, o, list);
      return;
    }
    if ((i.op == Op::power && i.exponent > 0) || i.op == Op::sqrt) return factors(function, i.operands[0], list);
  }
  if (operand.slot != Slot::constant && operand.slot != Slot::pi) list.push_back(operand);
}

bool same(const Operand& a, const Operand& b) { return a.slot == b.slot && a.index == b.index; }

/// The message of the emitted code for a zero of this denominator.
std::string test_of(const Function& function, const Operand& denominator) {
  for (const program::PivotTest& test : function.pivots) {
    if (!same(test.pivot, denominator)) continue;
    const bool absolute = test.scale.slot == Slot::constant && cln::zerop(function.constants[test.scale.index]);
    return absolute ? "code 1 where it is 0"
                    : fmt::format("code 1 below {:g} of what it is left of", program::pivot_tolerance);
  }
  return "code 5, since the accelerations are not finite";
}

/// Factors of all denominators and pivots, each once, in the order of the code.
std::vector<Divisor> list_divisors(const Function& function, const program::Program& program,
                                   const mechanics::Mechanics& mechanics) {
  std::vector<Operand> whole;
  for (const Instruction& i : function.code) {
    if (i.op == Op::div) whole.push_back(i.operands[1]);
    if (i.op == Op::power && i.exponent < 0) whole.push_back(i.operands[0]);
  }
  for (const program::PivotTest& test : function.pivots) whole.push_back(test.pivot);
  Text text(function, program, mechanics);
  std::vector<Divisor> list;
  for (const Operand& denominator : whole) {
    std::vector<Operand> parts;
    factors(function, denominator, parts);
    for (Operand part : parts) {
      part.negated = false;
      const std::string expression = text.magnitude(part);
      if (std::any_of(list.begin(), list.end(), [&](const Divisor& d) { return d.expression == expression; })) continue;
      list.push_back({part, expression, text.zero(part), test_of(function, parts.size() > 1 ? denominator : part)});
    }
  }
  return list;
}

constexpr int digits = 60;
constexpr std::array<std::size_t, 3> places{0, 12, 32};  // of the samples of a motion
constexpr std::size_t most_work = 20000;                 // instructions in many digits per case
constexpr double smallest_scale =
    1e-9;  // of the largest acceleration: smaller ones are 0 up to rounding, and have no digits
constexpr double all_digits = 15.65;  // -log10 of the last one
constexpr double last_digit = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

void raise(Extreme& extreme, double value, const std::string& at) {
  if (!std::isnan(value) && value > extreme.value) extreme = {value, at};
}

std::vector<cln::cl_R> exact(const std::vector<double>& list) { return mapped<cln::cl_R>(list, numeric::exact); }

std::vector<double> inputs(const run::Scene& scene, double t) {
  return mapped(scene.inputs, [&](const run::Signal& signal) { return signal(t, t); });
}

double condition(const Eigen::MatrixXd& M) {
  if (M.size() == 0 || !M.allFinite()) return infinity;
  const Eigen::VectorXd values = numeric::symmetric_eigenvalues(M);
  const double smallest = values.minCoeff(), largest = values.maxCoeff();
  return smallest > 0 ? largest / smallest : infinity;
}

bool all_finite(const std::vector<double>& list) {
  return std::all_of(list.begin(), list.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

Auditor::Auditor(const mechanics::Mechanics& mechanics, const program::Program& program)
    : rhs_(program.functions.front()), divided_(rhs_) {
  divided_.results = {{"denominators", {}}};
  divided_.result_indices.clear();
  for (const Divisor& d : list_divisors(rhs_, program, mechanics)) {
    divided_.results.front().entries.push_back(d.operand);
    audit_.denominators.push_back({d.expression, d.zero, d.test});
  }
}

void Auditor::add_motion(const std::string& test, const run::Scene& scene, const run::Code& code,
                         const std::vector<Sample>& samples) {
  std::vector<const Sample*> taken;
  for (const std::size_t place : places) {
    if (place < samples.size() && all_finite(samples[place].x)) taken.push_back(&samples[place]);
  }
  if (!all_finite(scene.parameters)) return;
  for (const Sample* sample : taken) {
    ++audit_.states;
    audit_mass(test, scene, code, *sample);
    audit_denominators(test, scene, *sample, inputs(scene, sample->t));
  }
  while (!taken.empty() && taken.size() * rhs_.code.size() > most_work) taken.pop_back();
  audit_digits(test, scene, code, taken);
}

/// The condition on the null space of the constraints: M alone may be singular (Euler parameters).
void Auditor::audit_mass(const std::string& test, const run::Scene& scene, const run::Code& code,
                         const Sample& sample) {
  if (code.mass == nullptr) return;
  const auto n = static_cast<Eigen::Index>(code.free.size()), m = static_cast<Eigen::Index>(code.active_constraints);
  Eigen::MatrixXd M(n, n);
  Eigen::VectorXd h(n);
  if (code.mass(sample.t, sample.x.data(), scene.parameters.data(), M.data(), h.data()) != 0 || !M.allFinite()) return;
  if (m > 0 && code.constraints != nullptr) {
    Eigen::MatrixXd A(m, n);
    Eigen::VectorXd psi(m), b(m);
    if (code.constraints(sample.t, sample.x.data(), scene.parameters.data(), psi.data(), A.data(), b.data()) != 0 ||
        !A.allFinite())
      return;
    const numeric::Kernel free = numeric::kernel(A);
    if (free.rank == n) return;
    M = free.basis.transpose() * M * free.basis;
  }
  raise(audit_.mass_condition, condition(M), test);
  const Eigen::VectorXd d = M.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  if (d.allFinite()) raise(audit_.scaled_mass_condition, condition(d.asDiagonal() * M * d.asDiagonal()), test);
}

void Auditor::audit_denominators(const std::string& test, const run::Scene& scene, const Sample& sample,
                                 const std::vector<double>& u) {
  const program::Values<double> values =
      program::interpret(divided_, {sample.t, sample.x, scene.parameters, u, {}, {}, sample.mode});
  for (std::size_t i = 0; i < audit_.denominators.size(); ++i) {
    const double value = std::abs(values.results[0][i]);
    Denominator& d = audit_.denominators[i];
    if (!std::isfinite(value)) continue;
    d.largest = std::max(d.largest, value);
    if (d.smallest != no_value && value >= d.smallest) continue;
    d.smallest = value;
    d.at = test;
  }
  for (const auto& [pivot, scale] : values.pivots) {
    if (scale != 0 && std::isfinite(pivot) && std::isfinite(scale)) raise(audit_.pivot, std::abs(scale / pivot), test);
  }
}

/// The digits lost of each acceleration, relative to its largest value in the motion.
void Auditor::audit_digits(const std::string& test, const run::Scene& scene, const run::Code& code,
                           const std::vector<const Sample*>& samples) {
  const std::size_t n = code.free.size();
  std::vector<double> scale(n, 0.0), off(n, 0.0);
  for (const Sample* sample : samples) {
    const std::vector<double> u = inputs(scene, sample->t);
    std::vector<double> dx(sample->x.size());
    if (code.rhs(sample->t, sample->x.data(), scene.parameters.data(), u.data(), sample->mode.data(), dx.data()) != 0)
      continue;
    try {
      const program::Values<cln::cl_R> values = program::interpret(
          rhs_, {numeric::exact(sample->t), exact(sample->x), exact(scene.parameters), exact(u), {}, {}, sample->mode},
          digits);
      for (std::size_t i = 0; i < n; ++i) {
        const cln::cl_R& right = values.results.front().at(n + i);
        off[i] = std::max(off[i], std::abs(cln::double_approx(right - numeric::exact(dx[n + i]))));
        scale[i] = std::max(scale[i], std::abs(cln::double_approx(right)));
      }
    } catch (const std::domain_error&) {
      ++audit_.without_digits;
    } catch (const cln::runtime_exception&) {
      ++audit_.without_digits;
    }
  }
  double largest = 0;
  for (const double s : scale) largest = std::max(largest, s);
  for (std::size_t i = 0; i < n && largest > 0 && std::isfinite(largest); ++i) {
    if (scale[i] < smallest_scale * largest) continue;
    const double relative = off[i] / scale[i];
    raise(audit_.digits_lost, relative > last_digit ? std::min(all_digits, std::log10(relative / last_digit)) : 0,
          test);
  }
}

}  // namespace eomgen::stress
