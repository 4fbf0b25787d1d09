// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/lowering.hpp"

#include <algorithm>
#include <stdexcept>

#include "mechanics/domain.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {
namespace {

namespace sym = symbolic;

// Deeper than any handwritten expression; protects the stack from deep recursion.
constexpr int depth_limit = 5000;

}  // namespace

sym::Op op_of(model::Fn fn) {
  switch (fn) {
    case model::Fn::sin: return sym::Op::sin;
    case model::Fn::cos: return sym::Op::cos;
    case model::Fn::tan: return sym::Op::tan;
    case model::Fn::asin: return sym::Op::asin;
    case model::Fn::acos: return sym::Op::acos;
    case model::Fn::atan: return sym::Op::atan;
    case model::Fn::atan2: return sym::Op::atan2;
    case model::Fn::sinh: return sym::Op::sinh;
    case model::Fn::cosh: return sym::Op::cosh;
    case model::Fn::tanh: return sym::Op::tanh;
    case model::Fn::exp: return sym::Op::exp;
    case model::Fn::log: return sym::Op::log;
    case model::Fn::sqrt: return sym::Op::sqrt;
    case model::Fn::abs: return sym::Op::abs;
    case model::Fn::sign: return sym::Op::sign;
    case model::Fn::min: return sym::Op::min;
    case model::Fn::max: return sym::Op::max;
  }
  throw std::logic_error("no function of the model language");
}

Lowering::Lowering(Mechanics& mechanics)
    : m_(mechanics),
      dag_(*mechanics.dag),
      ddt_(sym::total_time_derivative(dag_, mechanics.model->coordinates.size(), mechanics.model->functions.size())),
      explicit_rate_(sym::explicit_time_derivative(dag_, mechanics.model->functions.size())),
      extension_(dag_.zero()),
      slip_(dag_.zero()) {}

Ref Lowering::scalar(model::NodeId id) { return id == model::no_node ? dag_.zero() : value(id).scalar; }

Vec3 Lowering::vector(model::NodeId id) {
  if (id == model::no_node) return {dag_.zero(), dag_.zero(), dag_.zero()};
  return value(id).components;
}

Vec3 Lowering::position(std::uint32_t place) {
  if (place == 0) return {dag_.zero(), dag_.zero(), dag_.zero()};
  return vector(m_.model->places[place].position);
}

void Lowering::set_extension(Ref extension) { extension_ = extension; }
void Lowering::set_slip(Ref speed) { slip_ = speed; }

const Lowering::Value& Lowering::value(model::NodeId id) {
  if (const auto found = memo_.find(id); found != memo_.end()) return found->second;
  const model::Node& node = m_.model->arena[id];
  if (++depth_ > depth_limit) {
    throw Error("mechanics", m_.model->where(node.span), "definitions are nested too deeply here",
                "write the expression with fewer levels");
  }
  Value result = lower(node);
  --depth_;
  return memo_.emplace(id, result).first->second;
}

Lowering::Value Lowering::lower(const model::Node& node) {
  using model::Op;
  switch (node.op) {
    case Op::number:
    case Op::pi:
    case Op::time:
    case Op::parameter:
    case Op::function:
    case Op::input:
    case Op::coordinate:
    case Op::definition:
    case Op::extension:
    case Op::integral:
    case Op::state:
    case Op::reaction:
    case Op::slip:
    case Op::inertia: return lower_leaf(node);
    case Op::add:
    case Op::subtract:
    case Op::negate:
    case Op::multiply:
    case Op::divide:
    case Op::power:
    case Op::call:
    case Op::conditional:
    case Op::dot:
    case Op::norm: return lower_arithmetic(node);
    case Op::total_derivative:
    case Op::partial_derivative: return lower_derivative(node);
    default: return lower_vector(node);
  }
}

Lowering::Value Lowering::lower_leaf(const model::Node& node) {
  using model::Op;
  switch (node.op) {
    case Op::number: return of(dag_.constant(node.value));
    case Op::pi: return of(dag_.pi());
    case Op::time: return of(m_.t);
    case Op::parameter: return of(dag_.symbol({SymbolKind::parameter, node.index, 0}));
    case Op::function: return of(dag_.symbol({SymbolKind::function, node.index, node.order}));
    case Op::input: return of(dag_.symbol({SymbolKind::input, node.index, 0}));
    case Op::coordinate: return of(dag_.symbol({SymbolKind::coordinate, node.index, node.order}));
    case Op::definition: return value(m_.model->definitions[node.index].expression);
    case Op::integral: return of(dag_.symbol({SymbolKind::integral, node.index, 0}));
    case Op::state: return of(dag_.symbol({SymbolKind::state, node.index, 0}));
    case Op::reaction: return of(multiplier(node));
    case Op::slip: return of(slip_);
    case Op::inertia: return of(inertia(node.index, vector(node.args[0])));
    default: return of(extension_);
  }
}

// v . J v, along the axes in which J is known.
Ref Lowering::inertia(std::uint32_t body, const Vec3& v) {
  const BodyRotation& spin = m_.body_rotations.at(body);
  const std::array<Ref, 3> along{dot(v, spin.axes[0]), dot(v, spin.axes[1]), dot(v, spin.axes[2])};
  const std::array<Ref, 3> J = inertia_times(dag_, spin, along);
  Ref sum = dag_.zero();
  for (std::size_t k = 0; k < 3; ++k) sum = dag_.add(sum, dag_.mul(along[k], J[k]));
  return sum;
}

// A component of the reaction of a joint.
Ref Lowering::joint_force(const model::Node& node) {
  const std::uint32_t index = *m_.model->constraints[node.index].joint;
  const JointReaction& joint = m_.joints.at(index);
  if (!joint.determined[node.order]) {
    throw Error("mechanics", m_.model->where(node.span),
                "the motion does not determine this component of the joint '" + m_.model->joints[index].name + "'",
                "`check` lists those that it determines");
  }
  Ref sum = dag_.zero();
  for (std::uint32_t k = 0; k < joint.equations(); ++k) {
    sum =
        dag_.add(sum, dag_.mul(joint.along[node.order][k], dag_.symbol({SymbolKind::multiplier, joint.first + k, 0})));
  }
  return sum;
}

// The multiplier of one equation of a constraint; Mechanics lists the equations of all constraints consecutively.
Ref Lowering::multiplier(const model::Node& node) {
  const model::Constraint& wanted = m_.model->constraints[node.index];
  if (wanted.is_rolling_with_friction()) return rolling_reaction(node);
  if (wanted.joint) return joint_force(node);
  for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
    if (m_.constraints[k].name != wanted.name) continue;
    if (!m_.constraints[k + node.order].determined) {
      throw Error("mechanics", m_.model->where(node.span),
                  "the motion does not determine the force of '" + m_.constraints[k + node.order].label + "'",
                  "`check` lists the constraints of which it does");
    }
    return dag_.symbol({SymbolKind::multiplier, k + node.order, 0});
  }
  throw Error("mechanics", m_.model->where(node.span), "this constraint has no force",
              "name a constraint that is not redundant");
}

// Friction along one of the tangents, 0 if it is omitted; or the multiplier of the normal.
Ref Lowering::rolling_reaction(const model::Node& node) {
  const auto same = [&](const auto& entry) { return entry.name == m_.model->constraints[node.index].name; };
  if (node.order == 2) {
    const auto constraint = std::find_if(m_.constraints.begin(), m_.constraints.end(), same);
    return dag_.symbol({SymbolKind::multiplier, static_cast<std::uint32_t>(constraint - m_.constraints.begin()), 0});
  }
  const Contact& contact = *std::find_if(m_.contacts.begin(), m_.contacts.end(), same);
  return rolling_friction(m_, contact, node.order);
}

Lowering::Value Lowering::lower_arithmetic(const model::Node& node) {
  using model::Op;
  const auto arg = [&](std::size_t i) -> const Value& { return value(node.args[i]); };
  const auto each = [&](auto&& combine) {
    const Vec3 a = arg(0).components, b = arg(1).components;
    return of(Vec3{combine(a[0], b[0]), combine(a[1], b[1]), combine(a[2], b[2])});
  };
  const auto valued = [&](Ref r) {
    require_value(m_, r, node.span, [this](std::uint32_t i) { return parameter_value(i); });
    return of(r);
  };
  switch (node.op) {
    case Op::add:
      if (node.vector) return each([&](Ref a, Ref b) { return dag_.add(a, b); });
      return of(dag_.add(arg(0).scalar, arg(1).scalar));
    case Op::subtract:
      if (node.vector) return of(subtract(arg(0).components, arg(1).components));
      return of(dag_.sub(arg(0).scalar, arg(1).scalar));
    case Op::negate:
      if (node.vector) return of(scale(dag_.integer(-1), arg(0).components));
      return of(dag_.neg(arg(0).scalar));
    case Op::multiply:
      if (!node.vector) return valued(dag_.mul(arg(0).scalar, arg(1).scalar));
      return arg(0).vector ? of(scale(arg(1).scalar, arg(0).components)) : of(scale(arg(0).scalar, arg(1).components));
    case Op::divide:
      require_nonzero_divisor(m_, arg(1).scalar, node.span);
      if (!node.vector) return valued(dag_.div(arg(0).scalar, arg(1).scalar));
      return of(scale(dag_.div(dag_.one(), arg(1).scalar), arg(0).components));
    case Op::power:
      if (dag_.is_constant(arg(1).scalar) && cln::minusp(dag_.value(arg(1).scalar)))
        require_nonzero_divisor(m_, arg(0).scalar, node.span);
      return valued(dag_.pow(arg(0).scalar, arg(1).scalar));
    case Op::conditional:
      if (node.vector) {
        const Vec3 x = arg(2).components, y = arg(3).components;
        const auto pick = [&](std::size_t k) { return dag_.select(arg(0).scalar, arg(1).scalar, x[k], y[k]); };
        return of(Vec3{pick(0), pick(1), pick(2)});
      }
      return of(dag_.select(arg(0).scalar, arg(1).scalar, arg(2).scalar, arg(3).scalar));
    case Op::dot: return of(dot(arg(0).components, arg(1).components));
    case Op::norm: return of(norm(arg(0).components));
    default: break;
  }
  const sym::Op op = op_of(node.fn);
  if (op == sym::Op::atan2 || op == sym::Op::min || op == sym::Op::max) {
    return valued(dag_.call(op, arg(0).scalar, arg(1).scalar));
  }
  return valued(dag_.call(op, arg(0).scalar));
}

Lowering::Value Lowering::lower_vector(const model::Node& node) {
  using model::Op;
  Vec3 result = symbolic::zero_vector(dag_);
  switch (node.op) {
    case Op::fixed_basis: result[node.index] = dag_.one(); break;
    case Op::array:
      for (std::size_t k = 0; k < 3; ++k) result[k] = scalar(node.args[k]);
      break;
    case Op::place: result = position(node.index); break;
    case Op::place_velocity: result = ddt(position(node.index), node.span); break;
    case Op::place_acceleration: result = ddt(ddt(position(node.index), node.span), node.span); break;
    case Op::unit_basis:
    case Op::covariant_basis:
    case Op::contravariant_basis: return basis(node);
    case Op::axis: result = axis(node.index, node.order / 3u, node.order % 3u); break;
    case Op::angular_velocity: result = angular_velocity(node.index); break;
    case Op::cross: result = cross(vector(node.args[0]), vector(node.args[1])); break;
    case Op::unit: {
      const Vec3 a = vector(node.args[0]);
      require_nonzero_length(m_, norm(a), node.span);
      result = scale(dag_.div(dag_.one(), norm(a)), a);
      break;
    }
    default: break;  // zero_vector
  }
  return of(result);
}

Lowering::Value Lowering::lower_derivative(const model::Node& node) {
  const Value argument = value(node.args[0]);
  const auto apply = [&](auto&& derivative) {
    if (!argument.vector) return of(derivative(argument.scalar));
    return of(Vec3{derivative(argument.components[0]), derivative(argument.components[1]),
                   derivative(argument.components[2])});
  };
  if (node.op == model::Op::total_derivative) return apply([&](Ref r) { return ddt(r, node.span); });
  const Ref by = scalar(node.args[1]);
  const Symbol symbol = dag_.symbol_of(by);
  if (symbol.kind == SymbolKind::time) return apply([&](Ref r) { return explicit_rate(r); });
  sym::Derivation derivative = sym::partial_derivative(dag_, symbol);
  return apply([&](Ref r) { return derivative(r); });
}

Lowering::Value Lowering::basis(const model::Node& node) {
  const std::uint32_t coordinate = m_.model->arena[node.args[0]].index;
  if (node.op == model::Op::contravariant_basis) return of(contravariant(node.index, coordinate, node.span));
  const Vec3 a = gradient(position(node.index), coordinate);
  if (node.op == model::Op::covariant_basis) return of(a);
  if (const model::NodeId e = chart_vector(node.index, coordinate); e != model::no_node) return of(vector(e));
  require_nonzero_length(m_, norm(a), node.span);
  return of(scale(dag_.div(dag_.one(), norm(a)), a));
}

// The chart's own unit vector for a coordinate that is one of its entries and occurs in no other; it exists where a_q
// vanishes too.
model::NodeId Lowering::chart_vector(std::uint32_t place, std::uint32_t coordinate) {
  const auto& chart = m_.model->places[place].chart;
  model::NodeId result = model::no_node;
  int entries_with_it = 0;
  for (std::size_t k = 0; chart && k < 3; ++k) {
    if (chart->entries[k] == model::no_node) continue;
    const Ref entry = scalar(chart->entries[k]);
    for (const Symbol& symbol : dag_.symbols({entry})) {
      if (symbol.kind == SymbolKind::coordinate && symbol.index == coordinate) ++entries_with_it;
    }
    const bool bare = entry == dag_.symbol({SymbolKind::coordinate, coordinate, 0});
    if (bare) result = chart->unit_basis[k];
  }
  return entries_with_it == 1 ? result : model::no_node;
}

// a^i = sum_k a^ik a_k with the inverse metric of the chart's own coordinates, eq. (1.22); one to three of them.
Vec3 Lowering::contravariant(std::uint32_t place, std::uint32_t coordinate, const model::Span& span) {
  std::vector<Vec3> a;
  std::size_t wanted = 3;
  const auto& chart = m_.model->places[place].chart;
  for (std::size_t k = 0; chart && k < 3; ++k) {
    if (chart->entries[k] == model::no_node) continue;
    const model::Node& entry = m_.model->arena[chart->entries[k]];
    if (entry.op != model::Op::coordinate) continue;
    if (entry.index == coordinate) wanted = a.size();
    a.push_back(gradient(position(place), entry.index));
  }
  if (wanted >= a.size()) {
    throw Error("mechanics", m_.model->where(span),
                "a contravariant basis vector needs a coordinate of the particle's own chart",
                "use g_ with a coordinate that its position names");
  }
  // Cramer's rule on the Gram matrix, which is at most 3 x 3: a^i = sum_k cofactor_ik/det a_k.
  const std::size_t n = a.size();
  const auto gram = [&](std::size_t i, std::size_t k) { return dot(a[i], a[k]); };
  const auto minor = [&](std::size_t i, std::size_t k) -> Ref {
    std::vector<std::size_t> rows, columns;
    for (std::size_t s = 0; s < n; ++s) {
      if (s != i) rows.push_back(s);
      if (s != k) columns.push_back(s);
    }
    if (rows.empty()) return dag_.one();
    if (rows.size() == 1) return gram(rows[0], columns[0]);
    return dag_.sub(dag_.mul(gram(rows[0], columns[0]), gram(rows[1], columns[1])),
                    dag_.mul(gram(rows[0], columns[1]), gram(rows[1], columns[0])));
  };
  Ref determinant = dag_.zero();
  Vec3 sum = symbolic::zero_vector(dag_);
  for (std::size_t k = 0; k < n; ++k) {
    const Ref cofactor = (wanted + k) % 2 == 0 ? minor(wanted, k) : dag_.neg(minor(wanted, k));
    determinant = dag_.add(determinant, dag_.mul(gram(wanted, k), cofactor));
    const Vec3 term = scale(cofactor, a[k]);
    for (std::size_t c = 0; c < 3; ++c) sum[c] = dag_.add(sum[c], term[c]);
  }
  return scale(dag_.div(dag_.one(), determinant), sum);
}

// In curvilinear coordinates the squares often add up to a square, such as R^2, and no root is needed.
Ref Lowering::norm(const Vec3& a) {
  constexpr std::size_t term_budget = 60;
  const Ref square = dot(a, a);
  sym::Expander expander(dag_, term_budget);
  if (const std::optional<Ref> reduced = expander(square)) {
    const Ref root = dag_.call(sym::Op::sqrt, *reduced);
    if (dag_[root].op != sym::Op::sqrt) return root;
  }
  return dag_.call(sym::Op::sqrt, square);
}

cln::cl_R Lowering::parameter_value(std::uint32_t parameter) {
  if (const auto known = parameter_values_.find(parameter); known != parameter_values_.end()) return known->second;
  const auto other = [this](const sym::Symbol& symbol) { return parameter_value(symbol.index); };
  const Ref formula = scalar(m_.model->parameters[parameter].value);
  return parameter_values_[parameter] = sym::evaluate(dag_, {formula}, other, parameter_digits)[0];
}

Vec3 Lowering::gradient(const Vec3& a, std::uint32_t coordinate) {
  sym::Derivation by = sym::partial_derivative(dag_, {SymbolKind::coordinate, coordinate, 0});
  return {by(a[0]), by(a[1]), by(a[2])};
}

Ref Lowering::ddt(Ref expression, const model::Span& at) {
  for (const Symbol& symbol : dag_.symbols({expression})) {
    if (symbol.kind == SymbolKind::coordinate && symbol.order >= 2) {
      throw Error("mechanics", m_.model->where(at), "this needs the third time derivative of a coordinate",
                  "differentiate accelerations no further");
    }
    if (symbol.kind == SymbolKind::input) {
      throw Error("mechanics", m_.model->where(at), "the time derivative of an input is not known",
                  "make it a function of time in [functions], which has derivatives");
    }
    if (symbol.kind == SymbolKind::function && symbol.order >= 6) {
      throw Error("mechanics", m_.model->where(at), "this needs the seventh time derivative of a function",
                  "write the derivative out in terms of t");
    }
  }
  return ddt_(expression);
}

Vec3 Lowering::ddt(const Vec3& expression, const model::Span& at) {
  return {ddt(expression[0], at), ddt(expression[1], at), ddt(expression[2], at)};
}

Ref Lowering::explicit_rate(Ref expression) { return explicit_rate_(expression); }

}  // namespace eomgen::mechanics
