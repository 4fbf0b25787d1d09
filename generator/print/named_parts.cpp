// SPDX-License-Identifier: GPL-3.0-or-later
// Equations that are too long to write out, in terms of named parts: sum m r_ddot . dr/dq + H_dot . domega/dqdot =
// -dU/dq + Q + lambda dpsi/dq, eqs. (3.20), (9.39), with the definition of each letter. Angular velocities are
// quasi-velocities: their components along the axes of the inertia tensor are named. Long generalised forces are F .
// ds/dq for forces F at points s, and M . domega/dqdot for moments.
#include <algorithm>
#include <optional>

#include "mechanics/dependent_coordinates.hpp"
#include "mechanics/imposition.hpp"
#include "print/formulas.hpp"
#include "print/letters.hpp"
#include "print/named_forces.hpp"

namespace eomgen::print {
namespace {

using symbolic::Symbol;
using symbolic::Vec3;

constexpr std::size_t longest_numerator = 12;  // terms; longer sums are not combined in one fraction
constexpr std::size_t max_part_terms = 100;    // terms of a readable part
constexpr std::size_t longest_energy = 24;     // terms; named forces are shorter than longer energies

/// 0 for a zero vector.
Formula linear_combination(const std::vector<Formula>& components, const std::vector<Formula>& vectors) {
  std::vector<Formula> terms;
  for (std::size_t k = 0; k < components.size(); ++k) {
    if (reading::is_zero(components[k])) continue;
    const bool minus = components[k].kind == FormulaKind::negative;
    Formula term = reading::product({minus ? components[k].args[0] : components[k], vectors[k]});
    terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
  }
  return reading::sum(std::move(terms));
}

class NamedParts {
 public:
  NamedParts(const Mechanics& given, const DisplayForm& form, std::vector<Statement>& out)
      : two_(form.approach == system::Approach::two),
        m_(two_ ? mechanics::eliminate_dependent_coordinates(given) : given),
        form_(form),
        letters_(*m_.model, two_),
        imposed_(two_ ? mechanics::constraint_substitution(m_) : symbolic::Substitution(*m_.dag, {})),
        out_(out),
        forces_(m_, {[this](Ref r) { return read(r); },
                     [this, &given](model::NodeId node, Ref r) {
                       return !two_ || value(r) == r ? reading::as_written(*given.model, node) : std::nullopt;
                     },
                     [this](const std::string& role, const std::string& name, Formula formula) {
                       define(role, name, std::move(formula));
                     }}) {}

  void equations() {
    for (const bool of_motion : {true, false}) {
      for (const Equation& e : form_.equations) {
        if (e.of_motion != of_motion) continue;
        const std::string& name = m_.model->coordinates[e.coordinate].name;
        out_.push_back({"equations", "", name, of_motion ? "motion" : "constraint force", equation(e.coordinate)});
      }
    }
  }

  void definitions() {
    for (const mechanics::PointMass& mass : m_.masses) position(mass);
    for (std::size_t i = 0; i < m_.body_rotations.size(); ++i) rotation(i);
    if (has_given()) {
      const auto written = reading::as_written(*m_.model, m_.model->energy.kinetic);
      if (written && !two_)
        define("kinetic energy", "", reading::relation({mark(letters_.T), *written}));
      else
        define("kinetic energy", "", mark(letters_.T), m_.kinetic_given);
    }
    if (is_used(m_.potential, SymbolKind::coordinate)) potential();
    for (const Equation& e : form_.equations) {
      const Ref Q = generalized_force(e.coordinate);
      if (!m_.dag->is_zero(Q)) force(e.coordinate, Q);
    }
  }

 private:
  bool has_given() { return !m_.dag->is_zero(value(m_.kinetic_given)); }
  /// Imposes the constraints of approach II.
  Ref value(Ref r) { return imposed_(r); }
  bool depends(Ref r, std::uint32_t i, std::uint8_t order) {
    return !m_.dag->is_zero(symbolic::partial_derivative(*m_.dag, {SymbolKind::coordinate, i, order})(value(r)));
  }
  template <class Refs>
  bool any_depends(const Refs& refs, std::uint32_t i, std::uint8_t order) {
    return std::any_of(refs.begin(), refs.end(), [&](Ref r) { return depends(r, i, order); });
  }
  bool is_used(Ref r, SymbolKind kind) {
    const std::vector<Symbol> symbols = m_.dag->symbols({value(r)});
    return std::any_of(symbols.begin(), symbols.end(), [kind](const Symbol& s) { return s.kind == kind; });
  }

  /// A long potential is the sum over forces: springs in terms of the lines between their ends.
  void potential() {
    const Formula letter = mark(letters_.U);
    if (std::optional<Formula> written = read(m_.potential, longest_energy))
      return define("potential energy", "", reading::relation({letter, *std::move(written)}));
    std::vector<Formula> terms;
    Ref rest = m_.potential;
    for (std::uint32_t j = 0; j < m_.potential_by_force.size(); ++j) {
      const Ref energy = m_.potential_by_force[j];
      if (m_.dag->is_zero(energy) || read(energy, longest_energy)) continue;
      std::optional<Formula> spring = forces_.spring_energy(j);
      if (!spring) return define("potential energy", "", letter, m_.potential);
      terms.push_back(*std::move(spring));
      rest = m_.dag->sub(rest, energy);
    }
    const std::optional<Formula> others = read(rest, longest_energy);
    if (!others || terms.empty()) return define("potential energy", "", letter, m_.potential);
    if (!reading::is_zero(*others)) terms.insert(terms.begin(), *others);
    define("potential energy", "", reading::relation({letter, reading::sum(std::move(terms))}));
  }

  std::optional<Formula> read(Ref r, std::size_t most = max_part_terms) {
    try {
      const Sum sum = reading::display_sum(m_, value(r));
      if (sum.size() <= most) return arranged(sum);
      why_ = "it has " + std::to_string(sum.size()) + " terms";
      return std::nullopt;
    } catch (const work::BudgetExceeded& over) {
      why_ = over.what();
      return std::nullopt;
    }
  }

  /// As one fraction if that is shorter, as for rotations in Euler parameters.
  static Formula arranged(const Sum& sum) {
    const bool fractions = std::all_of(sum.terms().begin(), sum.terms().end(), [](const auto& term) {
      return std::any_of(term.first.begin(), term.first.end(),
                         [](const reading::Factor& f) { return cln::minusp(f.exponent); });
    });
    return sum.size() > 1 && sum.size() <= longest_numerator && fractions ? reading::factored(sum)
                                                                          : reading::arrange(sum);
  }

  /// Q_i with friction; in approach II also Q of the eliminated coordinates that depend on this one. `rest`: without
  /// forces that have a vector.
  Ref generalized_force(std::uint32_t i, bool rest = false) {
    symbolic::Dag& dag = *m_.dag;
    const auto along = [&](std::uint32_t k) {
      Ref sum = dag.zero();
      for (std::size_t j = 0; j < m_.force_components.size(); ++j) {
        if (!rest || !NamedForces::has_only_vector_effects(m_.model->forces[j]))
          sum = dag.add(sum, m_.force_components[j][k]);
      }
      for (const mechanics::Contact& contact : m_.contacts) {
        for (std::uint32_t a = 0; a < contact.dimensions(); ++a)
          sum = dag.add(sum, dag.mul(contact.tangents[a][k], dag.symbol({SymbolKind::friction, contact.first + a, 0})));
      }
      return sum;
    };
    Ref sum = along(i);
    if (two_) {
      for (const mechanics::FixedCoordinate& fixed : m_.fixed) {
        const Ref slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 0})(value(fixed.value));
        if (!dag.is_zero(slope)) sum = dag.add(sum, dag.mul(slope, along(fixed.coordinate)));
      }
    }
    return value(sum);
  }

  void force(std::uint32_t i, Ref Q) {
    const std::string& name = m_.model->coordinates[i].name;
    const Formula letter = mark("Q", {coordinate(i, 0)});
    if (std::optional<Formula> written = read(Q))
      return define("generalised force", name, reading::relation({letter, *std::move(written)}));
    const std::string why = why_;
    std::vector<Formula> terms;
    for (std::uint32_t j = 0; j < m_.model->forces.size(); ++j) {
      const model::Force& force = m_.model->forces[j];
      const std::vector<Ref>& components = m_.force_components[j];
      const bool acts = std::any_of(components.begin(), components.end(), [&](Ref r) { return !m_.dag->is_zero(r); });
      if (!acts || !NamedForces::has_only_vector_effects(force)) continue;
      for (std::uint32_t k = 0; k < force.effects.size(); ++k) {
        if (!forces_.add_generalised_force(j, k, i, terms)) {
          out_.push_back(left_out("parts", name, "generalised force", why));
          return;
        }
      }
    }
    const Ref rest = generalized_force(i, true);
    if (!m_.dag->is_zero(rest)) {
      const std::optional<Formula> written = read(rest);
      if (!written) {
        out_.push_back(left_out("parts", name, "generalised force", why));
        return;
      }
      terms.push_back(*written);
    }
    define("generalised force", name, reading::relation({letter, reading::sum(std::move(terms))}));
  }

  Formula equation(std::uint32_t i) {
    std::vector<Formula> left, right;
    const Formula q = coordinate(i, 0), rate = coordinate(i, 1);
    for (const mechanics::PointMass& mass : m_.masses) {
      if (!any_depends(mass.position, i, 0)) continue;
      const Formula r = mark("r", {index(mass.place)});
      left.push_back(reading::product({mass_letter(m_, mass), dot_product(dotted(r, 2), partial(r, q))}));
    }
    for (const mechanics::BodyRotation& spin : m_.body_rotations) {
      if (!any_depends(spin.w, i, 1)) continue;
      left.push_back(dot_product(dotted(mark("bold H", {index(spin.frame)})),
                                 partial(mark("bold omega", {index(spin.frame)}), rate)));
    }
    if (depends(m_.kinetic_given, i, 1))
      left.push_back(reading::make_formula(FormulaKind::rate, {partial(mark(letters_.T), rate)}));
    if (depends(m_.kinetic_given, i, 0)) left.push_back(reading::negative(partial(mark(letters_.T), q)));
    if (depends(m_.potential, i, 0)) right.push_back(reading::negative(partial(mark(letters_.U), q)));
    if (!m_.dag->is_zero(generalized_force(i))) right.push_back(mark("Q", {q}));
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) constraint_force(i, k, right);
    return reading::relation({reading::sum(std::move(left)), reading::sum(std::move(right))});
  }

  void constraint_force(std::uint32_t i, std::uint32_t k, std::vector<Formula>& terms) {
    const mechanics::Constraint& c = m_.constraints[k];
    const auto built_in = [k](const mechanics::FixedCoordinate& f) { return f.constraint == k; };
    if (!m_.is_independent(k) || (two_ && std::any_of(m_.fixed.begin(), m_.fixed.end(), built_in))) return;
    const bool acts = c.holonomic() ? depends(c.psi, i, 0) : depends(m_.velocity_form(c), i, 1);
    if (!acts) return;
    const Formula psi = constraint_letter(letters_, m_, k);
    terms.push_back(
        reading::product({reading::symbol({SymbolKind::multiplier, k, 0}),
                          c.holonomic() ? partial(psi, coordinate(i, 0)) : partial(dotted(psi), coordinate(i, 1))}));
  }

  void define(const std::string& role, const std::string& name, Formula formula) {
    out_.push_back({"parts", name, "", role, std::move(formula)});
  }
  void define(const std::string& role, const std::string& name, Formula left, Ref right) {
    if (std::optional<Formula> written = read(right))
      define(role, name, reading::relation({std::move(left), *std::move(written)}));
    else
      out_.push_back(left_out("parts", name, role, why_));
  }
  /// Components along E1, E2, E3.
  void define(const std::string& role, const std::string& name, Formula left, const Vec3& right,
              std::optional<Formula> beside = {}) {
    std::vector<Formula> components, axes;
    for (std::size_t k = 0; k < 3; ++k) {
      std::optional<Formula> written = read(right[k]);
      if (!written) {
        out_.push_back(left_out("parts", name, role, why_));
        return;
      }
      components.push_back(*std::move(written));
      axes.push_back(mark("E", {index(static_cast<std::uint32_t>(k + 1))}));
    }
    Formula sum = linear_combination(components, axes);
    if (beside) sum = reading::sum({*std::move(beside), std::move(sum)});
    define(role, name, reading::relation({std::move(left), std::move(sum)}));
  }

  /// Relative to the reference particle or body, if there is one.
  void position(const mechanics::PointMass& mass) {
    const Formula letter = mass_letter(m_, mass);
    if (letter.kind != FormulaKind::symbol) define("mass", mass.name, letter, mass.mass);
    const std::uint32_t from = m_.model->places[mass.place].chart ? m_.model->places[mass.place].from : 0;
    const auto base = std::find_if(m_.masses.begin(), m_.masses.end(),
                                   [from](const mechanics::PointMass& other) { return other.place == from; });
    Vec3 r = mass.position;
    std::optional<Formula> beside;
    if (from > 0 && base != m_.masses.end()) {
      for (std::size_t k = 0; k < 3; ++k) r[k] = m_.dag->sub(r[k], base->position[k]);
      beside = mark("r", {index(from)});
    }
    define("position", mass.name, mark("r", {index(mass.place)}), r, std::move(beside));
  }

  void rotation(std::size_t i) {
    const mechanics::BodyRotation& spin = m_.body_rotations[i];
    const std::uint32_t b = spin.frame;
    std::vector<Formula> axes, w, W, H;
    const bool carried = spin.axes_angular_velocity != spin.w;  // the axes rotate differently from the body
    for (std::uint32_t k = 0; k < 3; ++k) {
      axes.push_back(mark("e", {index(k + 1), index(b)}));
      w.push_back(mark("omega", {index(k + 1), index(b)}));
      W.push_back(carried ? mark("Omega", {index(k + 1), index(b)}) : w.back());
      H.push_back(mark("H", {index(k + 1), index(b)}));
    }
    for (std::size_t k = 0; k < 3; ++k) define("axes", spin.name, axes[k], spin.axes[k]);
    for (std::size_t k = 0; k < 3; ++k) define("angular velocity", spin.name, w[k], spin.w[k]);
    define("angular velocity", spin.name,
           reading::relation({mark("bold omega", {index(b)}), linear_combination(w, axes)}));
    if (carried) {
      for (std::size_t k = 0; k < 3; ++k)
        define("angular velocity of the axes", spin.name, W[k], spin.axes_angular_velocity[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<Formula> J;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::optional<Formula> entry = read(spin.J[k][j]);
        J.push_back(entry ? *entry : mark("..."));
      }
      define("angular momentum", spin.name, reading::relation({H[k], linear_combination(J, w)}));
    }
    define("angular momentum", spin.name, reading::relation({mark("bold H", {index(b)}), linear_combination(H, axes)}));
    std::vector<Formula> rate;  // rate of H along the axes: Euler's equations
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t x = (k + 1) % 3, y = (k + 2) % 3;
      rate.push_back(reading::sum(
          {dotted(H[k]), reading::product({W[x], H[y]}), reading::negative(reading::product({W[y], H[x]}))}));
    }
    define("rate of the angular momentum", spin.name,
           reading::relation({dotted(mark("bold H", {index(b)})), linear_combination(rate, axes)}));
  }

  bool two_;
  Mechanics m_;
  const DisplayForm& form_;
  Letters letters_;
  symbolic::Substitution imposed_;
  std::vector<Statement>& out_;
  std::string why_;  // reason of the last omitted part
  NamedForces forces_;
};

}  // namespace

Formula mass_letter(const Mechanics& m, const mechanics::PointMass& mass) {
  const symbolic::Node& node = (*m.dag)[mass.mass];
  return node.op == symbolic::Op::symbol ? reading::symbol(m.dag->symbols({mass.mass}).front())
                                         : mark("m", {index(mass.place)});
}

void add_equations_by_parts(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  NamedParts parts(m, form, out);
  parts.equations();
  parts.definitions();
}

}  // namespace eomgen::print
