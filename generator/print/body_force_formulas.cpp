// SPDX-License-Identifier: GPL-3.0-or-later
// Forces and moments of potentials on bodies as formulas, along the dual vectors and along axes.
#include <algorithm>

#include "print/formulas.hpp"
#include "reading/body_forces.hpp"

namespace eomgen::print {
namespace {

using reading::Axes;
using reading::BodyForce;
using reading::PotentialVector;

class BodyForceStatements {
 public:
  BodyForceStatements(const Mechanics& m, std::vector<Statement>& out) : m_(m), out_(out) {}

  void add(const BodyForce& of) {
    if (!of.skip_reason.empty())
      return out_.push_back(left_out("forces", of.force, "on '" + of.body + "'", of.skip_reason));
    if (of.along_fixed)
      show(of, "force", {letter(of, "bold F"), combination(of.force_vector.components, axes({}))}, of.force_vector);
    else
      show(of, "force", {letter(of, "bold F"), along_dual(of.force_vector, "a")}, of.force_vector);
    std::vector<Formula> sides{letter(of, "bold M"), along_dual(of.moment, "bold g")};
    const auto is_zero = [](const Sum& s) { return s.is_zero(); };
    if (!std::all_of(of.moment.components.begin(), of.moment.components.end(), is_zero))
      sides.push_back(combination(of.moment.components, axes(of.moment.axes)));
    show(of, "moment", std::move(sides), of.moment);
  }

 private:
  Formula letter(const BodyForce& of, const char* name) const {
    std::vector<Formula> lower;
    if (m_.model->bodies.size() > 1) lower.push_back(index(of.index + 1));
    return mark(name, std::move(lower));
  }
  std::vector<Formula> axes(const Axes& of) const {
    std::vector<Formula> result;
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::vector<Formula> lower{index(k + 1)};
      if (of.kind == Axes::Kind::fixed) {
        result.push_back(mark("E", std::move(lower)));
        continue;
      }
      if (m_.model->frames.size() > 2) lower.push_back(index(of.frame));
      result.push_back(mark("e", std::move(lower)));
    }
    return result;
  }
  static Formula along_dual(const PotentialVector& vector, const char* name) {
    std::vector<Formula> terms;
    for (const auto& [q, component] : vector.along_dual) {
      const bool minus = reading::has_negative_leading_term(component);
      Formula term =
          reading::product({reading::arrange(minus ? -component : component), mark(name, {}, {coordinate(q, 0)})});
      terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
    }
    return reading::sum(std::move(terms));
  }
  void show(const BodyForce& of, const char* what, std::vector<Formula> sides, const PotentialVector& vector) {
    const auto is_zero = [](const Sum& s) { return s.is_zero(); };
    if (vector.along_dual.empty() && std::all_of(vector.components.begin(), vector.components.end(), is_zero)) return;
    out_.push_back({"forces", of.force, "", what + (" on '" + of.body + "'"), reading::relation(std::move(sides))});
  }

  const Mechanics& m_;
  std::vector<Statement>& out_;
};

}  // namespace

void add_body_forces(const Mechanics& m, std::vector<Statement>& out) {
  BodyForceStatements statements(m, out);
  for (const BodyForce& of : reading::body_forces(m)) statements.add(of);
}

}  // namespace eomgen::print
