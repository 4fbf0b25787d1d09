// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/interpreter.hpp"

#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "oracle/argument.hpp"

namespace eomgen::verify {

using model::Node;
using model::NodeId;
using model::Op;

Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator*(const Jet& s, const Vector& v) { return {s * v[0], s * v[1], s * v[2]}; }
Jet dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Jet norm(const Vector& a, const Precision& p) { return sqrt(dot(a, a), p); }
Vector slope(const Vector& v, unsigned level, std::size_t i) {
  return {v[0].slope(level, i), v[1].slope(level, i), v[2].slope(level, i)};
}

Interpreter::Interpreter(const model::Model& model, Environment environment, Precision precision, KinkMargin* margin,
                         const model::Force* spring)
    : model_(model), environment_(std::move(environment)), precision_(precision), margin_(margin), spring_(spring) {}

std::unique_ptr<Interpreter> Interpreter::child(Environment environment) const {
  return std::make_unique<Interpreter>(model_, std::move(environment), precision_, margin_, spring_);
}

Interpreter Interpreter::with_spring(const model::Force& spring) const {
  return Interpreter(model_, environment_, precision_, margin_, &spring);
}

// ---- environments with one variable on a new level

Interpreter& Interpreter::with_time_slope() {
  if (later_) return *later_;
  Environment later = environment_;
  const unsigned level = ++later.level;
  later.t = Jet::variable(level, later.t, 0);
  for (auto* group : {&later.coordinates, &later.functions, &later.states})
    for (std::vector<Jet>& orders : *group) {
      for (std::size_t k = 0; k + 1 < orders.size(); ++k) orders[k] = Jet::on_level(level, orders[k], {orders[k + 1]});
      if (!orders.empty()) orders.pop_back();
    }
  later_ = child(std::move(later));
  return *later_;
}

Interpreter& Interpreter::with_coordinate_slopes(bool rates) {
  std::unique_ptr<Interpreter>& kept = rates ? by_q_and_rates_ : by_q_;
  if (kept) return *kept;
  Environment seeded = environment_;
  const unsigned level = ++seeded.level;
  const std::size_t n = seeded.coordinates.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Jet>& orders = seeded.coordinates[i];
    orders[0] = Jet::variable(level, orders[0], i);
    if (rates) orders[1] = Jet::variable(level, orders[1], n + i);
  }
  kept = child(std::move(seeded));
  return *kept;
}

Interpreter& Interpreter::with_rate_slopes() {
  if (by_rates_) return *by_rates_;
  Environment seeded = environment_;
  const unsigned level = ++seeded.level;
  for (std::size_t i = 0; i < seeded.coordinates.size(); ++i) {
    Jet& rate = seeded.coordinates[i][1];
    rate = Jet::variable(level, rate, i);
  }
  by_rates_ = child(std::move(seeded));
  return *by_rates_;
}

Interpreter& Interpreter::by_leaf(const Node& node) {
  std::unique_ptr<Interpreter>& kept = by_leaf_[{node.op, node.index, node.order}];
  if (kept) return *kept;
  Environment seeded = environment_;
  const unsigned level = ++seeded.level;
  const auto vary = [&](Jet& value) { value = Jet::variable(level, value, 0); };
  const auto vary_order = [&](std::vector<Jet>& orders) {
    if (node.order >= orders.size()) refuse(node, "this derivative is of too high an order");
    vary(orders[node.order]);
  };
  switch (node.op) {
    case Op::coordinate: vary_order(seeded.coordinates[node.index]); break;
    case Op::function: vary_order(seeded.functions[node.index]); break;
    case Op::parameter: vary(seeded.parameters[node.index]); break;
    case Op::input: vary(seeded.inputs[node.index]); break;
    case Op::state: vary_order(seeded.states[node.index]); break;
    case Op::time: {  // at fixed coordinates and declared states; functions of time vary
      vary(seeded.t);
      const auto vary_in_time = [&](std::vector<Jet>& orders) {
        for (std::size_t k = 0; k + 1 < orders.size(); ++k)
          orders[k] = Jet::on_level(level, orders[k], {orders[k + 1]});
        if (!orders.empty()) orders.pop_back();  // the function whose own formula is evaluated has none yet
      };
      for (std::vector<Jet>& orders : seeded.functions) vary_in_time(orders);
      for (std::size_t i = 0; i < seeded.states.size(); ++i) {
        if (model_.states[i].integral) vary_in_time(seeded.states[i]);
      }
      break;
    }
    default: refuse(node, "diff is by a coordinate, a function, a parameter, an input, a state or t");
  }
  kept = child(std::move(seeded));
  return *kept;
}

// ---- scalars

Jet Interpreter::scalar(NodeId id) {
  if (id == model::no_node) return Jet();
  if (const auto found = scalars_.find(id); found != scalars_.end()) return found->second;
  Jet value = read(model_.arena[id]);
  scalars_.emplace(id, value);
  return value;
}

Jet Interpreter::read(const Node& node) {
  const auto arg = [&](std::size_t i) { return scalar(node.args[i]); };
  switch (node.op) {
    case Op::add: return arg(0) + arg(1);
    case Op::subtract: return arg(0) - arg(1);
    case Op::negate: return -arg(0);
    case Op::multiply: return arg(0) * arg(1);
    case Op::divide: return arg(0) / arg(1);
    case Op::power: return power(arg(0), arg(1), precision_);
    case Op::call: return call(node);
    case Op::conditional: return conditional(node);
    case Op::dot: return dot(vector(node.args[0]), vector(node.args[1]));
    case Op::norm: return norm(vector(node.args[0]), precision_);
    case Op::total_derivative:
    case Op::partial_derivative: return derivative(node);
    default: return leaf(node);
  }
}

Jet Interpreter::leaf(const Node& node) {
  const auto of_order = [&](const std::vector<Jet>& orders) {
    if (node.order >= orders.size()) refuse(node, "a time derivative beyond the acceleration is needed here");
    return orders[node.order];
  };
  switch (node.op) {
    case Op::number: return Jet(Real(node.value));
    case Op::pi: return Jet(Real(cln::pi(precision_.format)));
    case Op::time: return environment_.t;
    case Op::parameter: return environment_.parameters[node.index];
    case Op::input: return environment_.inputs[node.index];
    case Op::coordinate: return of_order(environment_.coordinates[node.index]);
    case Op::function: return of_order(environment_.functions[node.index]);
    case Op::definition: return scalar(model_.definitions[node.index].expression);
    case Op::integral:
    case Op::state: return of_order(environment_.states[node.index]);
    case Op::extension:
      if (spring_ != nullptr) return extension(*spring_);
      break;
    default: break;
  }
  refuse(node, "not a scalar expression");
}

Jet Interpreter::derivative(const Node& node) {
  const bool total = node.op == Op::total_derivative;
  Interpreter& near = total ? with_time_slope() : by_leaf(model_.arena[node.args[1]]);
  return near.scalar(node.args[0]).slope(near.level(), 0);
}

/// Whether a node has the same value in every state, as the start of a joint has.
bool Interpreter::is_constant(NodeId root) const {
  std::set<NodeId> seen;
  std::vector<NodeId> open{root};
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (id == model::no_node || !seen.insert(id).second) continue;
    const Node& node = model_.arena[id];
    switch (node.op) {
      case Op::number:
      case Op::pi: break;
      case Op::definition: open.push_back(model_.definitions[node.index].expression); break;
      case Op::add:
      case Op::subtract:
      case Op::negate:
      case Op::multiply:
      case Op::divide:
      case Op::power:
      case Op::conditional:
      case Op::call: open.insert(open.end(), node.args.begin(), node.args.end()); break;
      default: return false;
    }
  }
  return true;
}

void Interpreter::observe_kink(const Node& node, double distance) {
  if (margin_ == nullptr || !(distance < margin_->kink)) return;
  const bool compares = node.op == Op::conditional || node.fn == model::Fn::min || node.fn == model::Fn::max;
  if (is_constant(node.args[0]) && (!compares || is_constant(node.args[1]))) return;
  *margin_ = {distance, node.span.line};
}

bool Interpreter::less(const Node& node) {
  const Jet a = scalar(node.args[0]), b = scalar(node.args[1]);
  const double x = cln::double_approx(a.real()), y = cln::double_approx(b.real());
  observe_kink(node, std::fabs(x - y) / std::max({std::fabs(x), std::fabs(y), 1e-300}));
  return a.real() < b.real();
}

Jet Interpreter::conditional(const Node& node) { return less(node) ? scalar(node.args[2]) : scalar(node.args[3]); }

Jet Interpreter::call(const Node& node) {
  using model::Fn;
  const Jet x = scalar(node.args[0]);
  const auto sign = [&]() -> int {
    observe_kink(node, std::fabs(cln::double_approx(x.real())));
    return cln::zerop(x.real()) ? 0 : cln::minusp(x.real()) ? -1 : 1;
  };
  switch (node.fn) {
    case Fn::sin: return sin_cos(x, precision_).first;
    case Fn::cos: return sin_cos(x, precision_).second;
    case Fn::tan: return tan(x, precision_);
    case Fn::asin: return asin(x, precision_);
    case Fn::acos: return acos(x, precision_);
    case Fn::atan: return atan(x, precision_);
    case Fn::atan2: return atan2(x, scalar(node.args[1]), precision_);
    case Fn::sinh: return sinh_cosh(x, precision_).first;
    case Fn::cosh: return sinh_cosh(x, precision_).second;
    case Fn::tanh: return tanh(x, precision_);
    case Fn::exp: return exp(x, precision_);
    case Fn::log: return log(x, precision_);
    case Fn::sqrt: return sqrt(x, precision_);
    case Fn::abs: return Jet(sign()) * x;
    case Fn::sign: return Jet(sign());
    case Fn::min:
    case Fn::max: break;
  }
  const Jet y = scalar(node.args[1]);
  return less(node) == (node.fn == Fn::min) ? x : y;
}

Jet Interpreter::extension(const model::Force& spring) {
  return norm(vector(argument_expression(spring, "b")) - vector(argument_expression(spring, "a")), precision_) -
         scalar(argument_expression(spring, "length"));
}

void Interpreter::refuse(const Node& node, const char* what) const {
  throw Error("verify", place_of(model_, node), what, "use values, velocities and accelerations only");
}

SourceLocation place_of(const model::Model& model, const model::Node& node) {
  SourceLocation where{model.file, node.span.line, node.span.column, node.span.length, ""};
  if (node.span.line >= 1 && node.span.line <= model.lines.size()) where.text = model.lines[node.span.line - 1];
  return where;
}

}  // namespace eomgen::verify
