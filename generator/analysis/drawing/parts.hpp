// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn of a model, on a page and in a figure. In: its mechanics. Out: vectors (positions, axes of bodies, ends
// of springs, points of joints and contacts, axes of gears, coordinates that constraints bind) as outputs, which the
// code of a page is to have, and as expressions; and where each part of the drawing finds its numbers among them.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mechanics/imposition.hpp"
#include "system/equation_system.hpp"

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
  std::string name;  // empty: of a body whose position turns with it
  std::size_t at;
  std::array<std::optional<std::size_t>, 2> of;  // places of its bodies; none: the ground
};
struct DrawnContact {
  std::string name;
  std::size_t at;
  std::optional<std::array<std::size_t, 2>> tangents;  // of a plane
  std::size_t foot;  // the same point moved onto the plane: what is not touched yet is above it
};
/// What holonomic constraints leave to a particle or to the centre of a body with two or three coordinates of its own.
struct DrawnSurface {
  std::string name;  // of the constraints
  std::size_t place;
  std::size_t at;                          // a vector: its coordinates
  std::vector<std::uint32_t> coordinates;  // of the model: its own, relative to what it is measured from
  std::vector<std::uint32_t> others;       // of the model: they carry the surface along, or its shape depends on them
  std::vector<std::size_t> others_at;      // where each is among the outputs
  std::optional<std::size_t> integrals;    // a vector: the first integrals over time
  bool touched = false;                    // with friction, or one side only
  bool reshapes = false;                   // psi changes with time or with the others
  bool moves = false;                      // that, or it is carried along
  std::vector<symbolic::Ref> psi;          // of all these coordinates, time and parameters
  symbolic::Vec3 position;
};
/// Two places, -1 the origin, at a distance that coordinates or a constraint hold.
struct DrawnRod {
  long a, b;
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
  std::vector<std::size_t> at;                    // sizes; none: the middle of the body
  std::vector<std::vector<std::uint32_t>> faces;  // of a mesh
};
struct DrawnParts {
  std::vector<DrawnPlace> places;
  std::vector<DrawnBody> bodies;
  std::vector<DrawnLine> springs, dampers;
  std::vector<DrawnJoint> joints;
  std::vector<DrawnContact> contacts;
  std::vector<DrawnCoupling> couplings;
  std::vector<DrawnShape> shapes;
  std::vector<DrawnSurface> surfaces;
  std::vector<DrawnRod> rods;
  bool untried_rods = false;  // there are more places than are tried
};

class Drawing {
 public:
  explicit Drawing(mechanics::Mechanics& mechanics);

  /// In the order of the array that is drawn from.
  const std::vector<std::string>& outputs() const { return outputs_; }
  /// What they are: of coordinates, time and parameters.
  const std::vector<symbolic::Ref>& expressions() const { return expressions_; }
  /// The outputs that no system of equations has got by itself.
  void add_outputs(system::EquationSystem& system) const;
  /// Sizes that depend on parameters only: masses and inertias of bodies, lengths of shapes. What depends on more is a
  /// negative number: unknown.
  const std::vector<symbolic::Ref>& sizes() const { return sizes_; }
  const DrawnParts& parts() const { return parts_; }

 private:
  std::size_t position(std::uint32_t place);
  std::size_t vector(const symbolic::Vec3& value);
  std::size_t vector(model::NodeId value);
  std::size_t size(model::NodeId value);
  void places();
  void bodies();
  void forces();
  void joints();
  void contacts();
  void couplings();
  void shapes();
  /// A particle or body, and the coordinates that its position has against what it is measured from.
  struct Bound {
    std::uint32_t place;
    std::set<std::uint32_t> own;
  };
  void surfaces();
  void surface(const Bound& one, const std::vector<Bound>& all_places);
  std::set<std::uint32_t> coordinates_of_place(std::uint32_t place) const;
  bool is_bound(const Bound& one, const std::vector<Bound>& all, std::uint32_t constraint);
  bool is_radial(const Bound& one, std::uint32_t constraint);
  std::vector<std::size_t> values_of(const std::vector<std::uint32_t>& coordinates);
  void rods();
  bool is_rod(std::uint32_t constraint, std::uint32_t a, std::uint32_t b);
  bool is_rigid(std::uint32_t a, std::uint32_t b);
  void pivots();

  mechanics::Mechanics& mechanics_;
  const model::Model& model_;
  symbolic::Substitution imposed_, written_;
  std::vector<std::string> outputs_;
  std::vector<symbolic::Ref> expressions_;
  std::vector<system::Output> own_;
  std::vector<symbolic::Ref> sizes_;
  DrawnParts parts_;
};

/// The sizes of a drawing at parameters; -1 where one has no value.
std::vector<double> sizes_of(const Drawing& drawing, const symbolic::Dag& dag, const std::vector<double>& parameters);

/// The direction in which things fall, where gravity is uniform; nothing where there is none.
std::optional<std::array<double, 3>> falling(mechanics::Mechanics& mechanics, const std::vector<double>& parameters);

/// Whether parameters are all that an expression depends on.
bool is_of_parameters(const symbolic::Dag& dag, symbolic::Ref expression);

}  // namespace eomgen::analysis
