// SPDX-License-Identifier: GPL-3.0-or-later
#include "conservation/conservative.hpp"

#include <algorithm>

#include "mechanics/vanishes.hpp"

namespace eomgen::conservation {
namespace {

using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

class Classifier {
 public:
  Classifier(mechanics::Mechanics& m, std::size_t force)
      : m_(m), dag_(*m.dag), force_(force), Q_(m.force_components[force]) {}

  ForceClassification classify() {
    result_.name = m_.model->forces[force_].name;
    const Ref known = m_.potential_by_force[force_];
    if (!dag_.is_zero(known)) result_.potential = known;
    if (m_.model->forces[force_].dry) {
      result_.conservative = ConservativeVerdict::no;
      append_reason("it is friction");
    } else if (std::all_of(Q_.begin(), Q_.end(), [&](Ref q) { return dag_.is_zero(q); })) {
      result_.conservative = ConservativeVerdict::yes;
      result_.in_energy = true;
      result_.domain = domain_of(m_, {known});
    } else if (depends_on_place_only() && curl_vanishes()) {
      find();
    }
    if (result_.conservative == ConservativeVerdict::yes && depends_on_time(known))
      append_reason("it depends on time, so that it changes the energy all the same");
    return result_;
  }

 private:
  void append_reason(const std::string& sentence) { result_.reason += (result_.reason.empty() ? "" : "; ") + sentence; }

  bool depends_on_place_only() {
    for (const Symbol& symbol : dag_.symbols(Q_)) {
      const bool velocity = symbol.kind == SymbolKind::coordinate && symbol.order > 0;
      const bool state = symbol.kind == SymbolKind::state;
      if (!velocity && !state && symbol.kind != SymbolKind::input) continue;
      result_.conservative = ConservativeVerdict::no;
      append_reason(velocity ? "it depends on velocities"
                    : state  ? "it depends on a state of first order"
                             : "it depends on an input");
      return false;
    }
    return true;
  }

  bool curl_vanishes() {
    std::vector<Ref> curl;
    for (std::uint32_t i = 0; i < Q_.size(); ++i) {
      for (std::uint32_t k = i + 1; k < Q_.size(); ++k) {
        const Ref ik = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, k, 0})(Q_[i]);
        const Ref ki = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0})(Q_[k]);
        curl.push_back(dag_.sub(ik, ki));
      }
    }
    if (mechanics::vanishes(dag_, curl)) return true;
    const bool kinks = dag_.has_kinks(curl);
    result_.conservative = kinks ? ConservativeVerdict::unknown : ConservativeVerdict::no;
    append_reason(kinks ? "its components have kinks (abs, sign, min, max, if)" : "its curl does not vanish");
    return false;
  }

  // The curl vanishes; only work around singular points remains to be tested.
  void find() {
    const std::optional<Potential> potential = find_potential(m_, Q_);
    const Circulation around = circulation(m_, Q_, potential, places());
    if (potential) {
      result_.potential = dag_.add(m_.potential_by_force[force_], potential->U);
      result_.domain = domain_of(m_, {*result_.potential});
    }
    using Answer = Circulation::Answer;
    result_.many_valued = around.answer == Answer::some;
    result_.work = around.work;
    if (around.answer == Answer::some) {
      result_.conservative = ConservativeVerdict::no;
      append_reason("its curl vanishes, but it does work along " + around.path + ": its potential is many-valued");
    } else if (potential && around.answer == Answer::none) {
      result_.conservative = ConservativeVerdict::yes;
    } else if (around.answer == Answer::none) {  // no singular point: every closed field on R^n has a potential
      result_.conservative = ConservativeVerdict::yes;
      append_reason("its potential was not found in closed form");
    } else {
      result_.conservative = ConservativeVerdict::unknown;
      append_reason(potential ? "its curl vanishes, but the work around its singular points was not found"
                              : "its curl vanishes, but no potential was found, and it has singular points");
    }
  }

  // The places where the force acts. A generalised force has none: it depends on coordinates, which count turns.
  std::vector<mechanics::Vec3> places() const {
    std::vector<mechanics::Vec3> result;
    for (const mechanics::Load& load : m_.loads) {
      if (load.name == result_.name) result.push_back(load.at);
    }
    return result;
  }

  bool depends_on_time(Ref known) const {
    std::vector<Ref> all = Q_;
    all.push_back(known);
    const std::vector<Symbol> symbols = dag_.symbols(all);
    return std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) {
      return s.kind == SymbolKind::time || s.kind == SymbolKind::function || s.kind == SymbolKind::integral;
    });
  }

  mechanics::Mechanics& m_;
  symbolic::Dag& dag_;
  std::size_t force_;
  const std::vector<Ref>& Q_;
  ForceClassification result_;
};

}  // namespace

const char* name(ConservativeVerdict verdict) {
  switch (verdict) {
    case ConservativeVerdict::yes: return "yes";
    case ConservativeVerdict::no: return "no";
    case ConservativeVerdict::unknown: break;
  }
  return "unknown";
}

std::vector<ForceClassification> classify_forces(mechanics::Mechanics& m) {
  std::vector<ForceClassification> result;
  for (std::size_t k = 0; k < m.model->forces.size(); ++k) result.push_back(Classifier(m, k).classify());
  return result;
}

}  // namespace eomgen::conservation
