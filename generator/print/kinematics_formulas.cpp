// SPDX-License-Identifier: GPL-3.0-or-later
// Kinematics as formulas: r, v, a, omega, alpha, H along the axes of each object and along E1, E2, E3, the Euler bases,
// and the entries of inertia tensors that are not zero.
#include "print/formulas.hpp"
#include "print/letters.hpp"
#include "reading/kinematics.hpp"

namespace eomgen::print {
namespace {

using reading::Axes;
using reading::KinematicAngle;
using reading::Kinematics;
using reading::KinematicTensor;
using reading::KinematicVector;
using reading::Quantity;

class KinematicStatements {
 public:
  KinematicStatements(const Mechanics& m, const char* key, std::vector<Statement>& out) : m_(m), key_(key), out_(out) {}

  void add(const Kinematics& of) {
    for (const KinematicVector& v : of.vectors) vector(of.name, v);
    for (const KinematicTensor& t : of.tensors) tensor(of.name, t);
    if (of.angle) angle(of.name, *of.angle);
    if (!of.scalar) return;
    if (of.scalar->skip_reason.empty())
      out_.push_back({key_, of.name, "", "definition", reading::arrange(of.scalar->value)});
    else
      out_.push_back(left_out(key_, of.name, "definition", of.scalar->skip_reason));
  }

 private:
  /// e_k, with the number of the frame if there are several.
  Formula axis(const char* letter, std::uint32_t k, std::uint32_t frame) const {
    std::vector<Formula> lower{index(k + 1)};
    if (m_.model->frames.size() > 2) lower.push_back(index(frame));
    return mark(letter, std::move(lower));
  }
  std::vector<Formula> letters(const Axes& axes) const {
    std::vector<Formula> result;
    for (std::uint32_t k = 0; k < 3; ++k) {
      switch (axes.kind) {
        case Axes::Kind::fixed: result.push_back(mark("E", {index(k + 1)})); break;
        case Axes::Kind::own: result.push_back(axis("e", k, axes.frame)); break;
        case Axes::Kind::before_last_rotation: result.push_back(axis("e'", k, axes.frame)); break;
        case Axes::Kind::chart:
          result.push_back(axes.coordinates[k] ? mark("e", {print::coordinate(*axes.coordinates[k], 0)})
                                               : mark("E", {index(k + 1)}));
          break;
      }
    }
    return result;
  }
  static std::string description(const Axes& axes) {
    switch (axes.kind) {
      case Axes::Kind::fixed: return "along the fixed axes";
      case Axes::Kind::own: return "along its own axes";
      case Axes::Kind::before_last_rotation: return "along the axes before its last rotation";
      case Axes::Kind::chart: return "along the unit vectors of its coordinates";
    }
    return "";
  }
  std::vector<Formula> number(std::uint32_t of, std::size_t all) const {
    return all > 2 ? std::vector<Formula>{index(of)} : std::vector<Formula>{};
  }
  Formula letter(const KinematicVector& v) const {
    const std::vector<Formula> place = number(v.index, m_.model->places.size()),
                               frame = number(v.index, m_.model->frames.size());
    switch (v.quantity) {
      case Quantity::axis: return axis(v.number < 3 ? "e" : "e'", v.number % 3, v.index);
      case Quantity::position: return mark("r", place);
      case Quantity::velocity: return mark("v", place);
      case Quantity::acceleration: return mark("a", place);
      case Quantity::angular_velocity: return mark("bold omega", frame);
      case Quantity::angular_acceleration: return mark("bold alpha", frame);
      case Quantity::angular_momentum: return mark("bold H", frame);
      case Quantity::tangent: return mark("bold g", {coordinate(v.number, 0)});
      default: return mark("bold g", {}, {coordinate(v.number, 0)});
    }
  }

  void vector(const std::string& name, const KinematicVector& v) {
    const std::string role = reading::name(v.quantity) + (" " + description(v.axes));
    if (!v.skip_reason.empty()) return out_.push_back(left_out(key_, name, role, v.skip_reason));
    Formula value = combination(v.components, letters(v.axes));
    const bool has_letter = v.quantity != Quantity::definition;
    out_.push_back(
        {key_, name, "", role, has_letter ? reading::relation({letter(v), std::move(value)}) : std::move(value)});
  }

  // cos(p) and 2 sin(p) r, or p and r of a constant attitude.
  void angle(const std::string& name, const KinematicAngle& a) {
    const char* const role = "axis r and angle p of its rotation";
    if (!a.skip_reason.empty()) return out_.push_back(left_out(key_, name, role, a.skip_reason));
    const auto call = [](symbolic::Op op, Formula of) {
      Formula result = reading::make_formula(reading::FormulaKind::call, {std::move(of)});
      result.op = op;
      return result;
    };
    const Formula p = mark(free_letter(*m_.model, "p", "Theta")), r = mark("bold r");
    const Formula axis = combination(a.axis, letters({}));
    if (a.angle) {
      out_.push_back({key_, name, "", role, reading::relation({p, reading::arrange(*a.angle)})});
      if (!reading::is_zero(axis)) out_.push_back({key_, name, "", role, reading::relation({r, axis})});
      return;
    }
    out_.push_back({key_, name, "", role, reading::relation({call(symbolic::Op::cos, p), reading::arrange(a.cosine)})});
    out_.push_back({key_, name, "", role,
                    reading::relation({reading::product({reading::number(2), call(symbolic::Op::sin, p), r}), axis})});
  }

  void tensor(const std::string& name, const KinematicTensor& t) {
    const std::string what = t.is_euler_tensor ? "Euler tensor "
                             : t.about == 0    ? "inertia tensor "
                                            : "inertia tensor about it, of '" + m_.model->frames[t.frame].name + "', ";
    const std::string role = what + description(t.axes);
    if (!t.skip_reason.empty()) return out_.push_back(left_out(key_, name, role, t.skip_reason));
    for (std::uint32_t i = 0; i < 3; ++i) {
      for (std::uint32_t k = i; k < 3; ++k) {
        if (t.entries[i][k].is_zero()) continue;
        out_.push_back({key_, name, "", role,
                        reading::relation({mark(t.is_euler_tensor ? "cal E" : "J", {index(i + 1), index(k + 1)}),
                                           reading::arrange(t.entries[i][k])})});
      }
    }
  }

  const Mechanics& m_;
  const char* key_;
  std::vector<Statement>& out_;
};

}  // namespace

void add_kinematics(const Mechanics& m, std::vector<Statement>& out) {
  KinematicStatements statements(m, "kinematics", out);
  for (const Kinematics& of : reading::kinematics(m)) statements.add(of);
}

void add_euler_bases(const Mechanics& m, std::vector<Statement>& out) {
  KinematicStatements statements(m, "basis", out);
  for (const Kinematics& of : reading::euler_bases(m)) statements.add(of);
}

}  // namespace eomgen::print
