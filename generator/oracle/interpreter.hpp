// SPDX-License-Identifier: GPL-3.0-or-later
// In: the expressions of a Model and an environment (time, coordinates and their rates, parameters, inputs as jets).
// Out: values as jets. ddt(e) evaluates e again with time on a new level, q -> q + qdot eps, qdot -> qdot + qddot eps.
// diff(e, x) and the basis vectors a_i = dr/dq_i (1.20) evaluate their argument with x on a new level. No formula is
// differentiated. The interpreter shares no code with mechanics, derive or the display form.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "model/model.hpp"
#include "oracle/jet.hpp"

namespace eomgen::verify {

using Vector = std::array<Jet, 3>;

Vector operator+(const Vector& a, const Vector& b);
Vector operator-(const Vector& a, const Vector& b);
Vector operator*(const Jet& s, const Vector& v);
Jet dot(const Vector& a, const Vector& b);
Vector cross(const Vector& a, const Vector& b);
Jet norm(const Vector& a, const Precision& p);
/// The slopes of the components in direction i of a level.
Vector slope(const Vector& v, unsigned level, std::size_t i);

struct Environment {
  Jet t;
  std::vector<std::vector<Jet>> coordinates;  // [coordinate][order], up to the highest known order
  std::vector<std::vector<Jet>> functions;    // [function][order]
  std::vector<std::vector<Jet>> states;  // [state]: its value and rate; of an integral also the derivatives of its rate
  std::vector<Jet> parameters, inputs;
  unsigned level = 0;  // the highest level in use
};

/// The least relative distance of a state from a kink (abs, sign, min, max, if) so far.
struct KinkMargin {
  double kink = 1;
  std::uint32_t line = 0;  // of the nearest kink in the file; 0: of none

  void add(const KinkMargin& other) {
    if (other.kink < kink) *this = other;
  }
};

class Interpreter {
 public:
  Interpreter(const model::Model& model, Environment environment, Precision precision, KinkMargin* margin = nullptr,
              const model::Force* spring = nullptr);

  Jet scalar(model::NodeId id);
  Vector vector(model::NodeId id);
  Vector place(std::uint32_t index);                // position of Model::places[index]
  Vector axis(std::uint32_t frame, std::size_t k);  // e_(k+1) of Model::frames[frame]
  /// Axial vector of dQ Q^T, eq. (5.26): the rotation of the axes of a frame along the path, or with a coordinate
  /// (with_coordinate_slopes(false)).
  Vector angular_velocity(std::uint32_t frame);
  Vector virtual_rotation(std::uint32_t frame, std::size_t coordinate);
  /// |b - a| - length of the spring, the value of Op::extension.
  Jet extension(const model::Force& spring);

  const Environment& environment() const { return environment_; }
  unsigned level() const { return environment_.level; }

  /// An interpreter with time on a new level: d/dt of its values is slope(level(), 0).
  Interpreter& with_time_slope();
  /// An interpreter with every coordinate (and, if `rates`, every velocity) on a new level: d/dq_i is
  /// slope(level(), i), d/dqdot_i is slope(level(), n + i).
  Interpreter& with_coordinate_slopes(bool rates);
  /// An interpreter with the velocities alone on a new level: d/dqdot_i is slope(level(), i).
  Interpreter& with_rate_slopes();
  /// The same environment; Op::extension is the extension of `spring`.
  Interpreter with_spring(const model::Force& spring) const;

 private:
  using Leaf = std::tuple<model::Op, std::uint32_t, std::uint8_t>;
  Interpreter& by_leaf(const model::Node& leaf);
  Jet read(const model::Node& node);
  Jet leaf(const model::Node& node);
  Jet derivative(const model::Node& node);
  Jet call(const model::Node& node);
  Jet conditional(const model::Node& node);
  Vector read_vector(const model::Node& node);
  Vector axial_vector(std::uint32_t frame, Interpreter& varied, std::size_t direction);
  Vector read_basis(const model::Node& node);
  bool names(std::uint32_t place, const model::Node& coordinate) const;
  Vector tangent(std::uint32_t place, const model::Node& coordinate, bool relative);  // dr/dq
  Vector dual(std::uint32_t place, const model::Node& coordinate);                    // grad q
  bool is_constant(model::NodeId root) const;
  void observe_kink(const model::Node& node, double distance);
  bool less(const model::Node& node);  // args[0] < args[1]
  [[noreturn]] void refuse(const model::Node& node, const char* what) const;
  std::unique_ptr<Interpreter> child(Environment environment) const;

  const model::Model& model_;
  Environment environment_;
  Precision precision_;
  KinkMargin* margin_;
  const model::Force* spring_;
  std::unordered_map<model::NodeId, Jet> scalars_;
  std::unordered_map<model::NodeId, Vector> vectors_;
  std::unique_ptr<Interpreter> later_, by_q_, by_q_and_rates_, by_rates_;
  std::map<Leaf, std::unique_ptr<Interpreter>> by_leaf_;
};

/// The position of a node in the file. The oracle shares no code with the reader.
SourceLocation place_of(const model::Model& model, const model::Node& node);

}  // namespace eomgen::verify
