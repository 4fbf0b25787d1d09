// SPDX-License-Identifier: GPL-3.0-or-later
// What a page draws of a model. In: the model and its mechanics. Out: outputs that the code is to have (positions, axes
// of bodies, ends of springs, points of joints and contacts, axes of gears), and where each part of the drawing finds
// its numbers among them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

/// Parts of a drawing. A vector is where its first component is among the outputs, a length where it is among the
/// sizes, a place counts the places.
struct DrawnPlace {
  std::string name;
  const char* kind;          // "particle", "body", "point"
  std::optional<long> from;  // the place that a line leads to it from, -1: the origin; none: no line
  std::size_t at;
};
struct DrawnBody {
  std::size_t place;
  std::array<std::size_t, 2> axes;  // the first two
  std::size_t mass;
  std::array<std::size_t, 9> inertia;  // by rows
};
struct DrawnLine {
  std::size_t a, b;  // its ends
};
struct DrawnJoint {
  std::string name;
  std::size_t at;
  std::array<std::optional<std::size_t>, 2> of;  // places of its bodies; none: the ground
};
struct DrawnContact {
  std::string name;
  std::size_t at;
  std::optional<std::array<std::size_t, 2>> tangents;  // of a plane
};
/// Two bodies that turn together, about axes of their own.
struct DrawnCoupling {
  std::string name;
  std::array<std::size_t, 2> of;    // places
  std::array<std::size_t, 2> axes;  // unit vectors
  std::size_t ratio;                // a size: the first speed over the second
  bool carried = false;             // both turn on a third body
};
struct DrawnShape {
  std::size_t place;
  std::string kind;                  // as [draw] has it
  std::vector<std::size_t> lengths;  // sizes
  std::size_t axis;
  std::vector<std::size_t> at;  // sizes; none: the middle of the body
};
struct DrawnParts {
  std::vector<DrawnPlace> places;
  std::vector<DrawnBody> bodies;
  std::vector<DrawnLine> springs, dampers;
  std::vector<DrawnJoint> joints;
  std::vector<DrawnContact> contacts;
  std::vector<DrawnCoupling> couplings;
  std::vector<DrawnShape> shapes;
};

class Drawing {
 public:
  /// Adds the outputs that the model has not got by itself to every candidate.
  explicit Drawing(pipeline::Derived& derived);

  /// In the order of the array that the page draws from.
  const std::vector<std::string>& outputs() const { return outputs_; }
  /// Sizes that depend on parameters only: masses and inertias of bodies, lengths of shapes. What depends on more is a
  /// negative number: unknown.
  const std::vector<symbolic::Ref>& sizes() const { return sizes_; }
  const DrawnParts& parts() const { return parts_; }

 private:
  std::size_t vector_of(const std::string& base);  // of outputs that are there: base1 .. base3
  std::size_t vector(pipeline::Derived& derived, const symbolic::Vec3& value);  // of new ones
  std::size_t vector(pipeline::Derived& derived, model::NodeId value);
  std::size_t size(pipeline::Derived& derived, model::NodeId value);
  void places(const model::Model& model);
  void bodies(pipeline::Derived& derived);
  void forces(pipeline::Derived& derived);
  void joints(pipeline::Derived& derived);
  void contacts(pipeline::Derived& derived);
  void couplings(pipeline::Derived& derived);
  void shapes(pipeline::Derived& derived);

  std::vector<std::string> outputs_;
  std::vector<symbolic::Ref> sizes_;
  DrawnParts parts_;
};

/// The sizes of a drawing at the parameters of a run; -1 where one has no value.
std::vector<double> sizes_of(const Drawing& drawing, const pipeline::Simulation& simulation);

/// The direction in which things fall, where gravity is uniform; nothing where there is none.
std::optional<std::array<double, 3>> falling(pipeline::Derived& derived, const std::vector<double>& parameters);

/// Whether parameters are all that an expression depends on.
bool is_of_parameters(const symbolic::Dag& dag, symbolic::Ref expression);

}  // namespace eomgen::analysis
