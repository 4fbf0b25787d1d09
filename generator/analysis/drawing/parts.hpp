// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the drawing of a model, on a page and in a figure. In: its mechanics. Out: vectors (positions, body axes,
// ends of springs, points of joints and contacts, axes of gears, constrained coordinates), both as expressions and as
// outputs for the code of a page; and for each part the indices of its numbers among them. primitives.hpp decides which
// of them are drawn, and how.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mechanics/imposition.hpp"
#include "system/equation_system.hpp"

namespace eomgen::analysis {

using symbolic::Ref;
using symbolic::SymbolKind;

/// Parts of a drawing. They refer to a vector by the index of its first component in the outputs, and to a place by its
/// index in DrawnParts::places. Masses, moments, lengths and ratios are expressions in parameters.
struct DrawnPlace {
  std::string name;
  const char* kind;          // "particle", "body", "point"
  std::optional<long> from;  // start of the line that leads to it: a place, or -1 for the origin; none: no line
  std::size_t at;            // a vector: its position
  bool is_held = false;      // a constraint holds it at a distance from `from`
};
struct DrawnBody {
  std::size_t place;
  std::array<std::size_t, 2> axes;       // vectors: the first two body axes
  symbolic::Ref mass;                    // -1 if it depends on more than parameters; so do the moments
  std::array<symbolic::Ref, 9> inertia;  // 3 x 3, row-major
};
struct DrawnLine {
  std::size_t a, b;  // vectors: its ends
};
struct DrawnJoint {
  std::string name;  // empty: the fixed point of a body that rotates about it
  std::size_t at;
  std::array<std::optional<std::size_t>, 2> of;  // places of its bodies; none: the ground
};
struct DrawnContact {
  std::string name;
  std::size_t of;  // place of the body
  std::size_t at;
  std::optional<std::array<std::size_t, 2>> tangents;  // of a plane
  std::size_t foot;                                    // a vector: projection of the point onto the contact plane
};
/// The surface or curve to which holonomic constraints restrict a particle, or the centre of a body, with two or three
/// coordinates of its own.
struct DrawnSurface {
  std::string name;  // of the constraints
  std::size_t place;
  std::size_t at;                          // a vector: its coordinates
  std::vector<std::uint32_t> coordinates;  // indices in the model of its own coordinates
  std::vector<std::uint32_t> others;       // indices in the model of coordinates that move or reshape the surface
  std::vector<std::size_t> others_at;      // indices of these among the outputs
  std::optional<std::size_t> integrals;    // a vector: the first integrals over time
  bool has_contact = false;                // a contact: with friction, or unilateral
  bool changes_shape = false;              // psi changes with time or with the other coordinates
  bool is_moving = false;                  // reshapes, or moves as a whole
  std::vector<symbolic::Ref> psi;          // functions of all these coordinates, time and parameters
  symbolic::Vec3 position;
};
/// A rod between two places (-1: the origin) whose distance is fixed by coordinates or by a constraint.
struct DrawnRod {
  long a, b;
};
/// A gear or belt between two bodies that rotate about their own axes.
struct DrawnCoupling {
  std::array<std::size_t, 2> of;    // places
  std::array<std::size_t, 2> axes;  // unit vectors
  symbolic::Ref ratio;              // first angular velocity over the second
  bool carried = false;             // both rotate on a third body
};
struct DrawnShape {
  std::size_t place;
  std::string kind;  // as in [draw]
  std::vector<symbolic::Ref> lengths;
  std::size_t axis;
  std::vector<symbolic::Ref> at;                  // empty: at the centre of the body
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
  bool rods_incomplete = false;  // rods were not searched for because there are too many places
};

class Drawing {
 public:
  explicit Drawing(mechanics::Mechanics& mechanics);

  /// Names, in the order of the array of numbers that the drawing reads.
  const std::vector<std::string>& outputs() const { return outputs_; }
  /// Their expressions in coordinates, time and parameters.
  const std::vector<symbolic::Ref>& expressions() const { return expressions_; }
  /// Adds the outputs that a system of equations does not have already.
  void add_outputs(system::EquationSystem& system) const;
  const DrawnParts& parts() const { return parts_; }

 private:
  std::size_t position(std::uint32_t place);
  std::size_t vector(const symbolic::Vec3& value);
  std::size_t vector(model::NodeId value);
  symbolic::Ref in_parameters(model::NodeId value);
  void places();
  void bodies();
  void forces();
  void joints();
  void contacts();
  void couplings();
  void shapes();
  /// A particle or body, with the coordinates of its position relative to its reference place.
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
  DrawnParts parts_;
};

/// Returns the direction of uniform gravity; nullopt if there is none.
std::optional<std::array<double, 3>> gravity_direction(mechanics::Mechanics& mechanics,
                                                       const std::vector<double>& parameters);

/// Whether an expression depends on parameters only.
bool depends_on_parameters_only(const symbolic::Dag& dag, symbolic::Ref expression);

}  // namespace eomgen::analysis
