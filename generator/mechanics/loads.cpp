// SPDX-License-Identifier: GPL-3.0-or-later
// Forces: conservative ones go into U, all others become a load at a point or a generalised force.
#include <algorithm>
#include <optional>

#include "mechanics/lowering.hpp"
#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {
namespace {

// The direction of a vector that may pass through 0. In: s(q) w. Out: w, if w provably stays nonzero when s vanishes;
// then w / |w| needs no s / |s|.

constexpr std::size_t term_budget = 60, most_nodes = 64;

bool depends_on_coordinates(const Dag& dag, Ref r) {
  const auto symbols = dag.symbols({r});
  return std::any_of(symbols.begin(), symbols.end(),
                     [](const symbolic::Symbol& s) { return s.kind == SymbolKind::coordinate; });
}

/// Factors of a product; for a sum, the factors common to all its terms.
std::vector<Ref> factors(const Dag& dag, Ref r) {
  const symbolic::Node& node = dag[r];
  const auto of = [&dag](Ref x) { return factors(dag, x); };
  switch (node.op) {
    case Op::neg: return of(node.args[0]);
    case Op::div: return of(node.args[0]);
    case Op::power: {
      std::vector<Ref> result;
      for (const Ref f : of(node.args[0])) result.insert(result.end(), static_cast<std::size_t>(node.payload), f);
      return result;
    }
    case Op::mul: {
      std::vector<Ref> result = of(node.args[0]), more = of(node.args[1]);
      result.insert(result.end(), more.begin(), more.end());
      return result;
    }
    case Op::add:
    case Op::sub: {
      std::vector<Ref> a = of(node.args[0]), b = of(node.args[1]), both;
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
      both.push_back(r);  // the sum itself, if the other components have it too
      return both;
    }
    default: return {r};
  }
}

/// r without one of its factors.
Ref without(Dag& dag, Ref r, Ref factor) {
  if (r == factor) return dag.one();
  const symbolic::Node node = dag[r];
  const auto has = [&](Ref x) {
    const std::vector<Ref> all = factors(dag, x);
    return std::find(all.begin(), all.end(), factor) != all.end();
  };
  const auto strip = [&](Ref x) { return without(dag, x, factor); };
  switch (node.op) {
    case Op::neg: return dag.neg(strip(node.args[0]));
    case Op::div: return dag.div(strip(node.args[0]), node.args[1]);
    case Op::power: return dag.mul(strip(node.args[0]), dag.power(node.args[0], node.payload - 1));
    case Op::mul:
      return has(node.args[0]) ? dag.mul(strip(node.args[0]), node.args[1])
                               : dag.mul(node.args[0], strip(node.args[1]));
    case Op::add: return dag.add(strip(node.args[0]), strip(node.args[1]));
    default: return dag.sub(strip(node.args[0]), strip(node.args[1]));
  }
}

/// For motion along one line: the derivative with respect to a coordinate, if it is constant and the vector is a
/// multiple of it.
std::optional<Vec3> line(Lowering& lower, Dag& dag, std::size_t coordinates, const Vec3& along) {
  for (std::uint32_t k = 0; k < coordinates; ++k) {
    Vec3 slope = lower.gradient(along, k);
    if (symbolic::is_zero(dag, slope)) continue;
    symbolic::Expander expander(dag, term_budget);
    for (Ref& x : slope) x = expander.expand_or_keep(x);
    if (std::any_of(slope.begin(), slope.end(), [&](Ref x) { return depends_on_coordinates(dag, x); }))
      return std::nullopt;
    const Vec3 across = lower.cross(along, slope);
    if (std::all_of(across.begin(), across.end(), [&](Ref x) { return dag.is_zero(expander.expand_or_keep(x)); }))
      return slope;
    return std::nullopt;
  }
  return std::nullopt;
}

/// Empty if no factor s that depends on coordinates is found.
std::optional<Vec3> direction(Lowering& lower, Dag& dag, std::size_t coordinates, const Vec3& along) {
  if (dag.reachable({along[0], along[1], along[2]}).size() > most_nodes) return std::nullopt;
  if (auto found = line(lower, dag, coordinates, along)) return found;
  std::optional<std::vector<Ref>> common;
  for (const Ref x : along) {
    if (dag.is_zero(x)) continue;
    std::vector<Ref> all = factors(dag, x), both;
    std::sort(all.begin(), all.end());
    if (common) std::set_intersection(common->begin(), common->end(), all.begin(), all.end(), std::back_inserter(both));
    common = common ? both : all;
  }
  Vec3 rest = along;
  bool changed = false;
  for (const Ref factor : common.value_or(std::vector<Ref>{})) {
    if (!depends_on_coordinates(dag, factor) || dag.is_positive(factor)) continue;
    // A sum may be listed as a factor besides those of its terms: each is used once, while all components still have
    // it.
    const auto has = [&](Ref x) {
      if (dag.is_zero(x)) return true;
      const std::vector<Ref> all = factors(dag, x);
      return std::find(all.begin(), all.end(), factor) != all.end();
    };
    if (!std::all_of(rest.begin(), rest.end(), has)) continue;
    for (Ref& x : rest) x = dag.is_zero(x) ? x : without(dag, x, factor);
    changed = true;
  }
  return changed ? std::optional(rest) : std::nullopt;
}

class ForceReader {
 public:
  ForceReader(Mechanics& mechanics, Lowering& lower) : m_(mechanics), lower_(lower), dag_(*mechanics.dag) {}

  void read(std::size_t index) {
    force_ = &m_.model->forces[index];
    const std::size_t first_load = m_.loads.size();
    potential_ = dag_.zero();
    generalized_.assign(m_.q.size(), dag_.zero());
    for (const model::Effect& effect : force_->effects) add(effect);
    require_effect(first_load);
    m_.potential_by_force.push_back(potential_);
    m_.potential = dag_.add(m_.potential, potential_);
    m_.force_components.push_back(components(first_load));
  }

 private:
  void add(const model::Effect& effect) {
    using LoadType = model::Effect::LoadType;
    switch (effect.load_type) {
      case LoadType::acceleration: return add_gravity(lower_.vector(effect.value));
      case LoadType::potential: return add_potential(effect);
      case LoadType::force: return load(lower_.vector(effect.value), lower_.vector(effect.at));
      case LoadType::moment: return add_moment(lower_.vector(effect.value), lower_.angular_velocity(effect.index));
      case LoadType::work: return add_work(lower_.scalar(effect.value), lower_.scalar(effect.at));
      case LoadType::damping: return add_damper(effect);
      case LoadType::component:
        generalized_[effect.index] = dag_.add(generalized_[effect.index], lower_.scalar(effect.value));
    }
  }
  void add_gravity(const Vec3& g) {
    require_masses();
    for (const PointMass& mass : m_.masses) {
      potential_ = dag_.sub(potential_, dag_.mul(mass.mass, lower_.dot(g, mass.position)));  // U = -m g.r
    }
  }
  void add_potential(const model::Effect& effect) {
    // The line between the ends comes first: operands of emitted code are in the order of first use.
    if (effect.other != model::no_node) lower_.subtract(lower_.vector(effect.at), lower_.vector(effect.other));
    if (effect.extension != model::no_node) lower_.set_extension(lower_.scalar(effect.extension));
    potential_ = dag_.add(potential_, lower_.scalar(effect.value));
    require_potential();
  }
  void add_damper(const model::Effect& effect) {
    const Vec3 a = lower_.vector(effect.at), b = lower_.vector(effect.other);
    const Vec3 along = lower_.subtract(a, b);
    if (const auto w = direction(lower_, dag_, m_.q.size(), along)) {
      // For points that may coincide, c (w . v)/(w . w) w with the line w between them also has a value there.
      const Ref size = symbolic::expand_or_keep(dag_, lower_.dot(*w, *w)),
                rate = lower_.dot(*w, lower_.ddt(along, force_->span));
      const Ref pull =
          dag_.div(dag_.mul(lower_.scalar(effect.value), symbolic::expand_if_shorter(dag_, rate, 60)), size);
      load(lower_.scale(dag_.neg(pull), *w), a);
      load(lower_.scale(pull, *w), b);
      return;
    }
    const Ref distance = lower_.norm(along);
    const Ref rate = lower_.ddt(distance, force_->span);
    const Ref tension = dag_.mul(lower_.scalar(effect.value), rate);
    const Vec3 pull = lower_.scale(dag_.div(tension, distance), along);
    load(lower_.scale(dag_.integer(-1), pull), a);
    load(pull, b);
  }
  void add_moment(const Vec3& moment, const Vec3& w) {  // Q_i = M . dw/dqdot_i, eq. (9.2)
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1});
      generalized_[i] = dag_.add(generalized_[i], lower_.dot(moment, Vec3{by(w[0]), by(w[1]), by(w[2])}));
    }
  }
  void add_work(Ref force, Ref through) {  // Q_i = S dx/dq_i
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0});
      generalized_[i] = dag_.add(generalized_[i], dag_.mul(force, by(through)));
    }
  }

  void load(const Vec3& force, const Vec3& at) {
    m_.loads.push_back({force_->name, force, at, lower_.ddt(at, force_->span)});
  }
  void require_masses() const {
    if (m_.masses.empty()) {
      fail("this force acts on masses, and the model has none",
           "add a [[particle]] or [[body]], or put the potential into [energy]");
    }
  }
  void require_potential() const {
    for (const symbolic::Symbol& symbol : dag_.symbols({potential_})) {
      if (symbol.kind == SymbolKind::input || (symbol.kind == SymbolKind::coordinate && symbol.order > 0)) {
        fail("the energy of a spring may depend on positions, parameters and time only",
             "write a force that depends on velocities or inputs as force = \"...\"");
      }
    }
  }
  // Q_i = F . dr/dq_i, eq. (3.20)
  std::vector<Ref> components(std::size_t first_load) const {
    std::vector<Ref> Q = generalized_;
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      for (std::size_t k = first_load; k < m_.loads.size(); ++k) {
        Q[i] = dag_.add(Q[i], lower_.dot(m_.loads[k].force, lower_.gradient(m_.loads[k].at, i)));
      }
    }
    return Q;
  }
  // A force that enters no equation is a mistake in the model and must be reported.
  void require_effect(std::size_t first_load) const {
    std::vector<Ref> effect = components(first_load);
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      effect.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0})(potential_));
    }
    if (!force_->dry && vanishes(dag_, effect)) {
      fail("'" + force_->name + "' changes no equation of motion: it does no work in any motion of the coordinates",
           "check its direction and the point it acts on, or remove it");
    }
  }
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error("mechanics", m_.model->where(force_->span), what, remedy);
  }

  Mechanics& m_;
  Lowering& lower_;
  Dag& dag_;
  const model::Force* force_ = nullptr;
  Ref potential_;
  std::vector<Ref> generalized_;
};

}  // namespace

void add_forces(Mechanics& mechanics, Lowering& lower) {
  mechanics.potential = lower.scalar(mechanics.model->energy.potential);
  ForceReader reader(mechanics, lower);
  for (std::size_t i = 0; i < mechanics.model->forces.size(); ++i) reader.read(i);
}

}  // namespace eomgen::mechanics
