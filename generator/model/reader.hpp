// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a model section by section. First every name of the file is declared, then expressions are resolved; a name
// that is needed is resolved on the way, so that the order of the file does not matter.
// In: the Value tree. Out: Model. Format: docs/model-format.md.
#pragma once

#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "coordinates/coordinate_system.hpp"
#include "joints/joint.hpp"
#include "model/at_start.hpp"
#include "model/resolver.hpp"
#include "rotations/rotation.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_places = 1000;
inline constexpr std::size_t max_coordinates = 1000;
inline constexpr std::size_t max_scenes = 100;
inline constexpr long max_chain = 64;

/// The keys of one kind of table: those that exist, and those that a later version brings.
struct Keys {
  std::string what;  // "[[particle]]"
  std::vector<std::string_view> known;
  std::vector<std::string_view> later;
};

class Reader {
 public:
  Reader(const Source& source, const Value& root);
  Model read();
  bool units_stated() const { return resolver_.units_stated(); }

 private:
  // keys.cpp
  void check_keys(const Value& table, const Keys& keys) const;
  const Value& needed(const Value& table, std::string_view key, const std::string& what,
                      const std::string& remedy) const;
  const Value& as(Value::Kind kind, const Value& value, const std::string& what, const std::string& remedy) const;
  const Value* section(std::string_view name) const;                // [name], checked to be a table
  std::vector<const Value*> sections(std::string_view name) const;  // [[name]]
  std::string text_of_key(const Value& table, std::string_view key, const std::string& what) const;
  Span key_span(const Value& table, std::string_view key) const;
  [[noreturn]] void not_yet(Span span, const std::string& what) const;
  std::string tex_of(const Value& table, const std::string& what) const;
  /// A unit that values are given in: SI without a factor.
  Unit si_unit(const Value& value, const std::string& what) const;
  MeasuredUnit any_unit(const Value& value, const std::string& what) const;

  // read_names.cpp: [parameters] [functions] [inputs] [coordinates] [definitions]
  void declare_names();
  void declare_coordinates();
  std::uint32_t declare_coordinate(const std::string& name, Span span, const Entry* entry);
  Typed define(Symbol& symbol);
  Typed define_parameter(Symbol& symbol);
  Typed define_function(Symbol& symbol);
  Typed define_input(Symbol& symbol);
  Typed define_definition(Symbol& symbol);
  void read_coordinate(const Entry& entry);
  void read_ranges();
  void warn_misspelt(const std::string& name, Span span);
  void warn_unused();

  // read_places.cpp: [[particle]] [[point]]; read_positions.cpp, read_custom.cpp: positions; chain.cpp: [[chain]]
  struct PlaceSource {
    const Value* table = nullptr;
    bool particle = false;
    bool body = false;
    std::uint32_t chain = 0;  // index + 1 into chains_, for links
    long link = 0;            // from 1
  };
  struct Chain {
    const Value* table = nullptr;
    std::string name;
    long n = 0;
    bool relative = false;
    std::vector<std::uint32_t> coordinates, places;
  };
  /// A position in a chart, from where the chart measures.
  struct Spelt {
    Chart chart;
    std::array<Typed, 3> x;
  };
  void declare_places();
  // read_bodies.cpp: [[body]] [[frame]]; read_inertia.cpp
  /// A direction that is fixed in a frame and in space: components of its unit vector along the axes of the frame, and
  /// in proportion to them numbers, where it is made of numbers.
  struct FixedDirection {
    std::array<Typed, 3> unit;
    std::optional<std::array<cln::cl_RA, 3>> numbers;
  };
  struct FrameSource {
    const Value* table = nullptr;
    std::uint32_t place = 0;                  // of a body
    bool still = false;                       // it keeps its attitude; the ground does
    std::optional<FixedDirection> axis = {};  // about which it turns, if that is a fixed one
    bool upright =
        false;  // it turns about that axis alone, from E1, E2, E3 on: the axis has the same components in space
  };
  void declare_frame(const Value& table, std::uint32_t place, Symbol& symbol);
  void declare_angles(const Value& table);
  Typed define_axes(Symbol& symbol);
  const Entry& rotation_entry(const Value& rotation) const;
  void read_rotation(Frame& frame, std::uint32_t index, const Value& rotation);
  std::vector<const Value*> rotation_entries(Frame& frame, const rotations::Rotation& found, const Entry& entry,
                                             const Value& rotation);
  std::optional<std::array<cln::cl_RA, 3>> numbers_of(NodeId vector) const;
  void turn_about(Frame& frame, std::uint32_t index, const Value& rotation, std::map<std::string, Typed>& local);
  void add_stage(std::uint32_t index, const rotations::Step& step, const std::map<std::string, Typed>& local,
                 Span span);
  std::uint32_t frame_named(const Value& value, const std::string& what);
  void declare_units();
  void read_units();
  void complete_parameters(Scene& scene);
  bool read_initial_rotation(Scene& scene, const Entry& entry, bool guess);
  void check_initial_rotations(const Scene& scene) const;
  void read_bodies();
  void read_inertia(Body& body, const Value& table);
  void read_scalar_inertia(Body& body, const Value& value);
  std::array<NodeId, 3> shape_moments(const Body& body, const Entry& shape);
  Typed point_on_body(const Value& table, const std::string& what);
  std::uint32_t declare_place(const std::string& name, Span span, PlaceSource where);
  void declare_chain(const Value& table);
  void declare_entries(const Value& position);
  void declare_entry(const Value& entry, std::string_view unit);
  Typed define_place(Symbol& symbol);
  Typed chart_position(std::uint32_t place, const Value& table);
  const Entry& system_entry(const Value& table) const;
  Spelt spelt_position(const Value& table, const Entry& entry);
  Spelt custom_position(const Value& table, const Entry& entry);
  std::array<Typed, 3> solved_position(const Value& names, const Value& q, const Context& context);
  void check_inverse(const Spelt& spelt, const Value& q, bool both);
  void check_independent(const Spelt& spelt, const Entry& entry, Span constant);
  std::array<Typed, 3> chart_entries(const coordinates::CoordinateSystem& system, const Value& entries);
  Typed chain_position(const PlaceSource& where);
  Typed chain_entry(const Value& table, std::string_view key, long link, const Context& context);
  void read_particles();
  std::uint32_t place_named(const Value& value, const std::string& what);

  // read_forces.cpp: [[force]]
  void declare_forces();
  void read_forces();
  Force read_force(const Value& table, const std::string& name);
  AppliedForce read_applied(const Value& table, const std::string& what);
  CentralGravity read_central_gravity(const Value& table, const std::string& what);
  Spring read_spring(const Value& table, const std::string& what);
  Damper read_damper(const Value& table, const std::string& what);
  Torsion read_torsion(const Value& table, const std::string& what);
  Moment read_moment(const Value& table, const std::string& what);
  Magnus read_magnus(const Value& table, const std::string& what);
  Drag read_drag(const Value& table, const std::string& what);
  Generalized read_generalized(const Value& table, const std::string& what);
  std::array<NodeId, 2> read_between(const Value& table, const std::string& what);
  NodeId read_scalar(const Value& table, std::string_view key, const std::string& what, std::string_view unit,
                     Facts allowed);
  NodeId read_point(const Value& value, const std::string& what);

  // read_constraints.cpp: [[constraint]], [energy]
  void declare_constraints();
  void read_constraints();
  bool read_contact(Constraint& constraint, const Value& table);
  // read_rolling.cpp
  void read_rolling(Constraint& constraint, const Value& table, bool rolling, bool rough);
  std::map<std::string, Typed> plane_of_contact(const Value& on);
  void tangent_of_contact(const Value& table, std::map<std::string, Typed>& local);
  void name_motion(std::uint32_t frame, const std::string& ending, Span span, std::map<std::string, Typed>& local);
  void read_touch(Constraint& constraint, const Value& table, const std::map<std::string, Typed>& local);
  Typed contact_arm(const Value& table, std::map<std::string, Typed> local);
  // read_contact_bodies.cpp
  bool touches_body(const Value& on);
  /// psi, where it is not that of two points and a normal.
  std::optional<std::string> between_bodies(Touch& touch, const Value& table, std::map<std::string, Typed>& local);
  void spheres_in_contact(const Value& table, std::map<std::string, Typed>& local);
  void points_in_contact(const Value& table, std::map<std::string, Typed>& local);
  void read_equations(Constraint& constraint, const Value& value);
  // read_friction.cpp
  void read_friction(Constraint& constraint, const Value& value);
  void read_holds(Constraint& constraint, const Value& table);  // read_constraints.cpp
  Friction read_coefficients(const Value& table, const std::string& what, std::optional<Dimension> speed);
  Dry read_dry(const Value& table, const std::string& what);
  void read_energy();

  // read_joints.cpp: [[joint]]
  struct JointEnd {
    std::uint32_t frame = 0;
    std::string name;
    Typed point;
    std::array<Typed, 3> axis;  // a, a1, a2, fixed in this body
  };
  void declare_joints();
  void read_joints();
  void read_joint(Joint& joint, const Value& table);
  std::array<JointEnd, 2> joint_ends(const Value& table, const std::string& what);
  void joint_points(Joint& joint, std::array<JointEnd, 2>& ends, const Value& at, const std::string& what);
  void joint_axes(const joints::Joint& kind, std::array<JointEnd, 2>& ends, const Value& table,
                  const std::string& what);
  std::array<Typed, 3> triad_about(const Value& axis, const JointEnd& end, const std::string& what);
  void axis_at_start(const Typed& direction, std::array<JointEnd, 2>& ends, AtStart& start, Span span,
                     const std::string& what);
  AtStart at_start(std::uint32_t constraint);
  Typed carried(const Typed& direction, std::uint32_t frame, AtStart& start, Span span, bool attitude = false);

  // read_events.cpp: [[event]], `stop` of a scene
  void declare_events();
  void read_events();
  void read_stop(Scene& scene, const Value& value);

  // read_draw.cpp: [draw]
  void read_draw();
  Drawn drawn_shape(std::uint32_t place, const Value& value);
  std::vector<NodeId> drawn_lengths(const Value& value, std::size_t count, const std::string& what, bool positive);

  // read_scenes.cpp, scene_values.cpp: [scene.NAME]
  void read_scenes();
  std::vector<const Entry*> merged(const Entry& scene, std::vector<std::string>& from) const;
  void read_scene(const Entry& entry);
  void read_span(Scene& scene, const Value& value);
  void read_initial(Scene& scene, const std::vector<const Entry*>& entries, bool guess);
  void warn_of_degrees(const Entry& entry, const Typed& typed, const InitialValue& initial);
  void read_solve(Scene& scene, const Value& value);
  void read_scene_parameters(Scene& scene, const std::vector<const Entry*>& entries);
  void read_scene_inputs(Scene& scene, const std::vector<const Entry*>& entries);
  InputTable read_input_table(const Value& table, const Symbol& input);
  void read_solver(Scene& scene, const Value& value);
  void read_outputs(Scene& scene, const Value& value);
  void check_output(const Value& value);
  void refuse_shadowed_outputs();
  bool is_contact_output(const std::vector<std::string>& parts);  // read_friction.cpp
  NodeId positive_number(const Value& value, const std::string& what, std::string_view unit);
  Symbol& coordinate_of_key(const Entry& entry, const std::string& what, std::uint8_t& order);

  const Source& source_;
  const Value& root_;
  Model model_;
  Scope scope_;
  Resolver resolver_;
  std::vector<PlaceSource> place_sources_;  // per Model::places
  std::vector<FrameSource> frame_sources_;  // per Model::frames
  std::vector<Chain> chains_;
  std::set<std::uint32_t> ranged_, measured_;  // coordinates whose range or unit [coordinates] states
};

}  // namespace eomgen::model
