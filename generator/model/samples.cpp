// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/samples.hpp"

#include <cln/rational.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace eomgen::model {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double some_time = 0.37;

using Vector = std::array<double, 3>;
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector combined(double s, const Vector& a, double t, const Vector& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) { return combined(1 / std::sqrt(dot(a, a)), a, 0, a); }

}  // namespace

double Samples::random() {
  state_ = state_ * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state_ >> 11) / 9007199254740992.0;  // 2^53
}

void Samples::next() {
  q_.assign(model_.coordinates.size(), 0);
  known_.clear();
  known_vectors_.clear();
  for (std::size_t k = 0; k < q_.size(); ++k) {
    const Coordinate& c = model_.coordinates[k];
    double low = c.lower == no_node ? none : value(c.lower), high = c.upper == no_node ? none : value(c.upper);
    if (std::isnan(low)) low = std::isnan(high) ? -1.5 : high - 2;
    if (std::isnan(high)) high = c.lower == no_node ? 1.5 : low + 2;
    q_[k] = low + (0.02 + 0.96 * random()) * (high - low);
  }
}

double Samples::value(NodeId id) {
  if (id == no_node) return none;
  if (const auto found = known_.find(id); found != known_.end()) return found->second;
  const double result = fresh(model_.arena[id]);
  known_[id] = result;
  return result;
}

double Samples::value_at_offset(NodeId node, std::uint32_t coordinate, double by) {
  q_[coordinate] += by;
  known_.clear();
  known_vectors_.clear();
  const double result = value(node);
  q_[coordinate] -= by;
  known_.clear();
  known_vectors_.clear();
  return result;
}

double Samples::fresh(const Node& node) {
  const auto arg = [&](std::size_t k) { return value(node.args[k]); };
  if (node.vector) return none;
  switch (node.op) {
    case Op::number: return cln::double_approx(node.value);
    case Op::pi: return std::numbers::pi;
    case Op::time: return some_time;
    case Op::parameter: return value(model_.parameters[node.index].value);
    case Op::function: return node.order == 0 ? value(model_.functions[node.index].expression) : none;
    case Op::coordinate: return node.order == 0 && node.index < q_.size() ? q_[node.index] : none;
    case Op::definition: return value(model_.definitions[node.index].expression);
    case Op::add: return arg(0) + arg(1);
    case Op::subtract: return arg(0) - arg(1);
    case Op::negate: return -arg(0);
    case Op::multiply: return arg(0) * arg(1);
    case Op::divide: return arg(0) / arg(1);
    case Op::power: return std::pow(arg(0), arg(1));
    case Op::conditional: return arg(0) < arg(1) ? arg(2) : arg(3);
    case Op::call: return value_of(node.fn, arg(0), arg(1));
    case Op::dot: return dot(vector(node.args[0]), vector(node.args[1]));
    case Op::norm: return std::sqrt(dot(vector(node.args[0]), vector(node.args[0])));
    default: return none;
  }
}

std::array<double, 3> Samples::vector(NodeId id) {
  if (id == no_node) return {none, none, none};
  if (const auto found = known_vectors_.find(id); found != known_vectors_.end()) return found->second;
  const Vector result = fresh_vector(model_.arena[id]);
  known_vectors_[id] = result;
  return result;
}

std::array<double, 3> Samples::fresh_vector(const Node& node) {
  const auto arg = [&](std::size_t k) { return vector(node.args[k]); };
  const auto is_vector = [&](std::size_t k) { return model_.arena[node.args[k]].vector; };
  switch (node.op) {
    case Op::zero_vector: return {0, 0, 0};
    case Op::fixed_basis: {
      Vector result{};
      result[node.index] = 1;
      return result;
    }
    case Op::array: return {value(node.args[0]), value(node.args[1]), value(node.args[2])};
    case Op::place: return node.index == 0 ? Vector{} : vector(model_.places[node.index].position);
    case Op::axis: return vector(model_.frames[node.index].stages[node.order / 3u].e[node.order % 3u]);
    case Op::definition: return vector(model_.definitions[node.index].expression);
    case Op::add: return combined(1, arg(0), 1, arg(1));
    case Op::subtract: return combined(1, arg(0), -1, arg(1));
    case Op::negate: return combined(-1, arg(0), 0, arg(0));
    case Op::multiply: {
      const std::size_t v = is_vector(0) ? 0 : 1;
      return combined(value(node.args[1 - v]), arg(v), 0, arg(v));
    }
    case Op::divide: return combined(1 / value(node.args[1]), arg(0), 0, arg(0));
    case Op::conditional: return value(node.args[0]) < value(node.args[1]) ? arg(2) : arg(3);
    case Op::cross: return cross(arg(0), arg(1));
    case Op::unit: return unit(arg(0));
    case Op::unit_basis: return unit(covariant(node));
    case Op::covariant_basis: return covariant(node);
    default: return {none, none, none};
  }
}

/// Central differences of the position by the coordinate.
std::array<double, 3> Samples::covariant(const Node& node) {
  constexpr double step = 1e-5;
  const std::uint32_t coordinate = model_.arena[node.args[0]].index;
  if (coordinate >= q_.size()) return {none, none, none};
  const double before = q_[coordinate];
  std::array<Vector, 2> at;
  for (std::size_t side = 0; side < 2; ++side) {
    q_[coordinate] = before + (side == 0 ? -step : step);
    known_.clear();
    known_vectors_.clear();
    at[side] = vector(model_.places[node.index].position);
  }
  q_[coordinate] = before;
  known_.clear();
  known_vectors_.clear();
  return combined(1 / (2 * step), at[1], -1 / (2 * step), at[0]);
}

double value_of(Fn fn, double x, double y) {
  switch (fn) {
    case Fn::sin: return std::sin(x);
    case Fn::cos: return std::cos(x);
    case Fn::tan: return std::tan(x);
    case Fn::asin: return std::asin(x);
    case Fn::acos: return std::acos(x);
    case Fn::atan: return std::atan(x);
    case Fn::atan2: return std::atan2(x, y);
    case Fn::sinh: return std::sinh(x);
    case Fn::cosh: return std::cosh(x);
    case Fn::tanh: return std::tanh(x);
    case Fn::exp: return std::exp(x);
    case Fn::log: return std::log(x);
    case Fn::sqrt: return std::sqrt(x);
    case Fn::abs: return std::abs(x);
    case Fn::sign: return x > 0 ? 1 : x < 0 ? -1 : 0;
    case Fn::min: return std::min(x, y);
    case Fn::max: return std::max(x, y);
  }
  return none;
}

double Samples::gram_determinant(const std::array<NodeId, 3>& x, const std::vector<std::uint32_t>& coordinates) {
  constexpr double step = 1e-5;  // of central differences: 1e-10 of rounding and of truncation
  std::vector<Vector> a;
  for (const std::uint32_t k : coordinates) {
    Vector tangent;
    for (std::size_t c = 0; c < 3; ++c)
      tangent[c] = (value_at_offset(x[c], k, step) - value_at_offset(x[c], k, -step)) / (2 * step);
    const double length = std::sqrt(dot(tangent, tangent));
    if (length < 1e-8) return 0;
    for (double& component : tangent) component /= length;
    a.push_back(tangent);
  }
  const auto g = [&](std::size_t i, std::size_t k) { return dot(a[i], a[k]); };
  switch (a.size()) {
    case 2: return 1 - g(0, 1) * g(0, 1);
    case 3: return 1 + 2 * g(0, 1) * g(1, 2) * g(0, 2) - g(0, 1) * g(0, 1) - g(1, 2) * g(1, 2) - g(0, 2) * g(0, 2);
    default: return 1;
  }
}

}  // namespace eomgen::model
