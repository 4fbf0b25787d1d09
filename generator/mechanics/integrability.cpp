// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/integrability.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/closure.hpp"
#include "mechanics/integrating_factor.hpp"
#include "mechanics/involution.hpp"
#include "mechanics/pfaffian.hpp"
#include "symbolic/antiderivative.hpp"

namespace eomgen::mechanics {
namespace {

using symbolic::Substitution;

// Part of a row outside the span of others, in 50 digits.
cln::cl_R independent_part() { return cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 20)); }

constexpr std::uint32_t first_constant = 0x20000000u;  // of SymbolKind::auxiliary: constants of known integrals

/// A surface psi = c on which further integrals are sought: one variable is a function of the others.
struct Leaf {
  std::size_t variable;
  Ref value;
};

class Classifier {
 public:
  explicit Classifier(Mechanics& m) : m_(m), dag_(*m.dag), space_(m) {
    for (const std::uint32_t k : m.active) {
      if (m.constraints[k].holonomic()) {
        holonomic_.push_back(space_.one_form(m.constraints[k]));
        eliminate(space_.impose_and_expand(m.constraints[k].psi), dag_.zero());
      } else {
        velocity_.push_back(k);
        forms_.push_back(space_.one_form(m.constraints[k]));
      }
    }
  }

  void run() {
    std::vector<ZeroTestResult> alone;
    for (std::size_t k = 0; k < forms_.size(); ++k) alone.push_back(integrable_alone(k));
    for (std::size_t point = 0; point < space_.points() && !orbit_; ++point) {
      orbit_ = orbit(space_, system(forms_), point);
      if (orbit_) orbit_point_ = point;
    }
    for (std::size_t k = 0; k < forms_.size(); ++k) {
      if (alone[k] == ZeroTestResult::proven || alone[k] == ZeroTestResult::numerical)
        seek_integral(forms_[k], velocity_[k]);
    }
    // If the numerical test finds the integrals complete, no combinations are needed.
    const bool more = !orbit_ || orbit_->integrable_count() > holonomic_.size() + m_.integrals.size();
    const Echelon terminal = more ? last_derived(system(forms_)) : Echelon{};
    for (std::size_t k = 0; k < forms_.size(); ++k) {
      m_.classification[velocity_[k]] = verdict(k, alone[k], terminal);
    }
    seek_joint_integrals(terminal);
    for (std::size_t k = 0; k < forms_.size(); ++k) note_integral(velocity_[k]);
  }

 private:
  std::vector<OneForm> system(std::vector<OneForm> forms) const {
    forms.insert(forms.begin(), holonomic_.begin(), holonomic_.end());
    return forms;
  }

  ZeroTestResult all_vanish(const std::vector<OneForm>& forms) {
    bool proven = true;
    for (const OneForm& form : forms) {
      for (const Ref entry : form) {
        const ZeroTestResult zero = space_.vanishing(entry);
        if (zero == ZeroTestResult::no || zero == ZeroTestResult::unknown) return zero;
        proven = proven && zero == ZeroTestResult::proven;
      }
    }
    return proven ? ZeroTestResult::proven : ZeroTestResult::numerical;
  }

  // Refuted numerically, or proven.
  ZeroTestResult integrable_alone(std::size_t k) {
    const std::vector<OneForm> forms = system({forms_[k]});
    for (std::size_t point = 0; point < space_.points(); ++point) {
      if (fails_frobenius(space_, forms, point).value_or(false)) return ZeroTestResult::no;
    }
    return frobenius(forms);
  }

  ZeroTestResult frobenius(std::vector<OneForm> forms) {
    const Echelon rows = space_.echelon(std::move(forms));
    const ZeroTestResult result = all_vanish(space_.curvature(rows));
    return result == ZeroTestResult::proven && !rows.exact ? ZeroTestResult::numerical : result;
  }

  /// The largest integrable system among the combinations of the forms: the end of the derived flag, whose curvature
  /// vanishes. No rows if the effort is used up.
  Echelon last_derived(std::vector<OneForm> forms) {
    while (true) {
      Echelon rows = space_.echelon(std::move(forms));
      if (space_.is_effort_spent()) return {};
      const std::vector<OneForm> curvature = space_.curvature(rows);
      const std::size_t count = rows.rows.size();
      std::vector<OneForm> conditions;  // on the coefficients of a combination
      for (std::size_t pair = 0; !curvature.empty() && pair < curvature[0].size(); ++pair) {
        conditions.emplace_back();
        for (std::size_t k = 0; k < count; ++k) conditions.back().push_back(curvature[k][pair]);
      }
      const Echelon bound = space_.echelon(std::move(conditions));
      if (space_.is_effort_spent()) return {};
      rows.exact = rows.exact && bound.exact;
      if (bound.rows.empty()) return rows;
      forms.clear();
      for (std::size_t k = 0; k < count; ++k) {
        if (std::find(bound.pivots.begin(), bound.pivots.end(), k) != bound.pivots.end()) continue;
        OneForm sum = rows.rows[k];
        for (std::size_t row = 0; row < bound.rows.size(); ++row) {
          for (std::size_t i = 0; i < sum.size(); ++i) {
            const Ref part = dag_.mul(bound.rows[row][k], rows.rows[bound.pivots[row]][i]);
            sum[i] = dag_.sub(sum[i], part);
          }
        }
        forms.push_back(std::move(sum));
      }
    }
  }

  bool within(std::size_t k, const Echelon& rows) {
    if (orbit_) return orbit_->is_integrable(space_.values(forms_[k], orbit_point_));
    const OneForm& form = forms_[k];
    const ZeroTestResult rest = all_vanish({space_.reduce(form, rows)});
    return rest == ZeroTestResult::proven || rest == ZeroTestResult::numerical;
  }

  std::string others_in(std::size_t k, const Echelon& terminal) {
    std::string text;
    for (std::size_t j = 0; j < forms_.size(); ++j) {
      if (j == k || !within(j, terminal)) continue;
      text += (text.empty() ? "'" : ", '") + m_.constraints[velocity_[j]].label + "'";
    }
    return text;
  }

  ConstraintClassification verdict(std::size_t k, ZeroTestResult alone, const Echelon& terminal) {
    switch (alone) {
      case ZeroTestResult::proven: return {Integrability::yes, "Frobenius' condition holds"};
      case ZeroTestResult::numerical:
        return {Integrability::unknown,
                "Frobenius' condition holds at random points to 30 digits, but no proof was found"};
      case ZeroTestResult::unknown:
        return {Integrability::unknown, "its coefficients have no value at the points that were tried"};
      case ZeroTestResult::no: break;
    }
    const std::string why = "Frobenius' condition fails: omega ^ d omega is not zero, with t as a coordinate";
    if (forms_.size() > 1 && within(k, terminal)) {
      const std::string others = others_in(k, terminal);
      if (terminal.exact && !terminal.rows.empty())
        return {Integrability::yes, "not by itself, but together with " + others};
      return {Integrability::unknown,
              "not by itself; together with " + others + " at random points, but no proof was found"};
    }
    const std::size_t integrable = orbit_ ? orbit_->integrable_count() : terminal.rows.size();
    if (integrable > holonomic_.size() + within_count(terminal)) {
      return {Integrability::no, why + "; a combination of constraints is integrable"};
    }
    return {Integrability::no, why};
  }

  std::size_t within_count(const Echelon& terminal) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < forms_.size(); ++k) count += within(k, terminal) ? 1 : 0;
    return count;
  }

  // ---- integrals

  /// Imposes psi = c, if it can be solved for one of its variables.
  void eliminate(Ref psi, Ref c) {
    for (const bool constant_slope : {true, false}) {
      for (std::size_t i = 0; i + 1 < space_.variables().size(); ++i) {
        const Symbol x = space_.variables()[i];
        const Ref slope = symbolic::partial_derivative(dag_, x)(psi);
        if (dag_.is_zero(slope) || symbolic::depends_on(dag_, slope, x)) continue;
        const std::vector<Symbol> symbols = dag_.symbols({slope});
        const auto moves = [](const Symbol& s) { return s.kind != SymbolKind::parameter; };
        if (constant_slope && std::any_of(symbols.begin(), symbols.end(), moves)) continue;
        const Ref rest = Substitution(dag_, {{x, dag_.zero()}})(psi);
        leaves_.push_back({i, space_.simpler(dag_.div(dag_.sub(c, rest), slope))});
        return;
      }
    }
  }

  OneForm on_leaves(OneForm form) {
    for (const Leaf& leaf : leaves_) {
      Substitution substitute(dag_, {{space_.variables()[leaf.variable], leaf.value}});
      const Ref along = substitute(form[leaf.variable]);
      for (std::size_t i = 0; i < form.size(); ++i) {
        if (i == leaf.variable) {
          form[i] = dag_.zero();
          continue;
        }
        const Ref slope = space_.derivative(leaf.value, i);
        form[i] = space_.simpler(dag_.add(substitute(form[i]), dag_.mul(along, slope)));
      }
    }
    for (Ref& entry : form) {
      if (space_.vanishing(entry) == ZeroTestResult::proven) entry = dag_.zero();
    }
    return form;
  }

  Ref with_constants_written(Ref psi) {
    std::map<Symbol, Ref> values;
    for (std::uint32_t j = 0; j < m_.integrals.size(); ++j) values[constant(j)] = m_.integrals[j].psi;
    return Substitution(dag_, values)(psi);
  }

  static Symbol constant(std::size_t j) {
    return {SymbolKind::auxiliary, first_constant + static_cast<std::uint32_t>(j), 0};
  }

  bool seek_integral(const OneForm& form, std::uint32_t constraint) {
    const OneForm restricted = on_leaves(form);
    if (std::all_of(restricted.begin(), restricted.end(), [&](Ref r) { return dag_.is_zero(r); })) return false;
    const std::optional<Ref> on_leaf = find_integral(space_, restricted);
    if (!on_leaf) return false;
    const Ref psi = space_.simpler(with_constants_written(*on_leaf));
    const Echelon all = space_.echelon(system(forms_));
    const OneForm slope = space_.differential(psi);
    if (all_vanish({space_.reduce(slope, all)}) != ZeroTestResult::proven || !is_new_integral(slope)) return false;
    eliminate(*on_leaf, dag_.symbol(constant(m_.integrals.size())));
    m_.integrals.push_back({m_.constraints[constraint].label, parts_of(psi), psi});
    return true;
  }

  /// Whether a differential is independent of those of holonomic constraints and of known integrals.
  bool is_new_integral(const OneForm& slope) {
    std::vector<OneForm> forms = holonomic_;
    for (const ConstraintIntegral& known : m_.integrals) forms.push_back(space_.differential(known.psi));
    forms.push_back(slope);
    for (std::size_t point = 0; point < space_.points(); ++point) {
      try {
        std::vector<Row> rows;
        for (const OneForm& form : forms) rows.push_back(space_.values(form, point));
        const RowSelection independent =
            select_independent(rows, std::vector<RowPriority>(rows.size(), RowPriority::last), independent_part());
        if (independent.rest.empty()) return true;
      } catch (const std::domain_error&) {  // no value at this point
      }
    }
    return false;
  }

  void seek_joint_integrals(const Echelon& terminal) {
    for (bool found = true; found;) {
      found = false;
      for (const OneForm& row : terminal.rows) {
        if (m_.integrals.size() + holonomic_.size() >= terminal.rows.size()) return;
        const std::optional<std::uint32_t> label = unlabelled(terminal);
        if (label && seek_integral(row, *label)) found = true;
      }
    }
  }

  /// The first constraint of the system that no integral replaces.
  std::optional<std::uint32_t> unlabelled(const Echelon& terminal) {
    const auto has_integral = [&](std::uint32_t k) {
      return std::any_of(m_.integrals.begin(), m_.integrals.end(),
                         [&](const ConstraintIntegral& i) { return i.label == m_.constraints[k].label; });
    };
    for (const bool inside : {true, false}) {
      for (std::size_t k = 0; k < forms_.size(); ++k) {
        if (!has_integral(velocity_[k]) && (!inside || within(k, terminal))) return velocity_[k];
      }
    }
    return std::nullopt;
  }

  /// The constraints of which d psi is a combination, numerically.
  std::vector<std::uint32_t> parts_of(Ref psi) {
    std::vector<OneForm> rows = system(forms_);
    rows.push_back(space_.differential(psi));
    const std::size_t width = rows[0].size(), count = rows.size() - 1;
    std::vector<Ref> entries;
    for (const OneForm& row : rows) entries.insert(entries.end(), row.begin(), row.end());
    std::vector<std::uint32_t> result;
    try {
      const std::vector<cln::cl_R> v = space_.values(entries, 0);
      const auto dot = [&](std::size_t a, std::size_t b) {
        cln::cl_R sum = 0;
        for (std::size_t i = 0; i < width; ++i) sum = sum + v[a * width + i] * v[b * width + i];
        return sum;
      };
      std::vector<std::vector<cln::cl_R>> gram(count, std::vector<cln::cl_R>(count));
      std::vector<cln::cl_R> right, factor;
      for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b < count; ++b) gram[a][b] = dot(a, b);
        right.push_back(dot(a, count));
      }
      if (!solve_small(gram, right, factor)) return velocity_;
      for (std::size_t k = 0; k < forms_.size(); ++k) {
        if (std::abs(cln::double_approx(factor[holonomic_.size() + k])) > 1e-20) result.push_back(velocity_[k]);
      }
    } catch (const std::domain_error&) {
      return velocity_;
    }
    return result;
  }

  void note_integral(std::uint32_t constraint) {
    ConstraintClassification& found = m_.classification[constraint];
    const auto its = std::find_if(m_.integrals.begin(), m_.integrals.end(), [&](const ConstraintIntegral& i) {
      return i.label == m_.constraints[constraint].label;
    });
    if (its != m_.integrals.end()) {
      // An integral whose differential is proven to be the constraint's completes the missing proof.
      if (found.integrable == Integrability::unknown && its->constraints == std::vector<std::uint32_t>{constraint}) {
        found = {Integrability::yes, "an integral was found"};
      }
      return;
    }
    if (found.integrable == Integrability::yes) found.reason += "; no integral was found";
  }

  Mechanics& m_;
  Dag& dag_;
  OneFormSpace space_;
  std::vector<std::uint32_t> velocity_;  // active constraints on velocities, ascending
  std::vector<OneForm> forms_, holonomic_;
  std::optional<Orbit> orbit_;
  std::size_t orbit_point_ = 0;
  std::vector<Leaf> leaves_;
};

}  // namespace

const char* name(Integrability verdict) {
  switch (verdict) {
    case Integrability::yes: return "yes";
    case Integrability::no: return "no";
    case Integrability::unknown: break;
  }
  return "unknown";
}

void classify_constraints(Mechanics& m) {
  m.classification.assign(m.constraints.size(), {});
  const bool velocities =
      std::any_of(m.constraints.begin(), m.constraints.end(), [](const Constraint& c) { return !c.holonomic(); });
  if (velocities) Classifier(m).run();
}

}  // namespace eomgen::mechanics
