// SPDX-License-Identifier: GPL-3.0-or-later
// What a model file says, checked: the product of the model stage and all that later stages know of the user's file.
// Contract: docs/model-format.md. Every quantity is in SI units; names are resolved to indices; vectors are 3-D.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "error.hpp"
#include "model/expression.hpp"

namespace eomgen::model {

/// Exponents of m kg s A K mol cd; nothing where the dimension is unknown (a bare number).
struct Dimension {
  std::array<Rational, 7> exponents{};
};
struct Unit {
  std::string text;                    // canonical SI, "m/s^2"; "1" for pure numbers; empty where unknown
  std::optional<Dimension> dimension;  // nullopt: unknown
};

struct Parameter {
  std::string name;
  NodeId value = no_node;  // of numbers and other parameters, earlier or later in the file
  std::string written;     // as the author wrote it: "48.85 deg"
  Unit unit;
  std::string tex, note;
  bool positive = false;
  Span span;
  bool used = false;
  std::optional<std::uint32_t> start_of;  // initial(q): the coordinate whose start value every run puts here
};
struct Function {  // of time
  std::string name;
  NodeId is = no_node;
  Unit unit;
  std::string tex;
  Span span;
};
struct Integral {    // integral(e) of a function of time, from the start of the run
  std::string name;  // "integral_1", for where it becomes a state; no other name of the model is like it
  NodeId integrand = no_node;
  Unit unit;
  Span span;
};
struct Input {
  std::string name;
  NodeId fallback = no_node;  // the value where a scene gives none
  Unit unit;
  std::string tex;
  Span span;
};
struct Coordinate {
  std::string name;
  Unit unit;
  std::string tex;
  NodeId lower = no_node, upper = no_node;  // open interval of the chart, where it has one
  Span span;
};
struct Definition {
  std::string name;
  NodeId is = no_node;
  bool vector = false;
  Unit unit;
  Span span;
};

/// Coordinates of a place, as the user wrote them: which system, which entries; `position` of the Place is the same
/// thing already spelled out as a vector.
struct Chart {
  std::string system;                                           // name in coordinates::registry()
  std::array<NodeId, 3> entries{no_node, no_node, no_node};     // scalar expressions for the slots (third 0 if planar)
  std::array<NodeId, 3> unit_basis{no_node, no_node, no_node};  // vector expressions e_1, e_2, e_3; no_node: normalise
  bool planar = false;
};
/// Axes e1 e2 e3 on the way of a rotation, and the same thing as numbers: e_k = sum_j R[k][j] p_j of the axes before
/// (those of the parent at first), and the components along e1 e2 e3 of the angular velocity against those before.
struct Stage {
  std::array<NodeId, 3> e{no_node, no_node, no_node};  // vectors
  std::array<std::array<NodeId, 3>, 3> R{};            // no_node: 0
  std::array<NodeId, 3> w{no_node, no_node, no_node};  // no_node: 0
};
/// Axes that turn, of a body or of a [[frame]]; frames[0] are E1 E2 E3, without stages.
struct Frame {
  std::string name;
  std::string rotation;         // name in rotations::registry()
  std::uint32_t parent = 0;     // whose axes it turns against
  std::vector<NodeId> entries;  // angles, parameters
  std::vector<Stage> stages;    // the last is its own axes
  NodeId regular = no_node;     // is 0 where the angles fail, for Euler angles
  Span span;
};
/// A rigid body; its centre of mass is a place.
struct Body {
  std::uint32_t place = 0, frame = 0;
  NodeId mass = no_node;
  std::array<std::array<NodeId, 3>, 3> inertia{};  // about the centre of mass, along its own axes
  Span span;
};
/// A particle, a body's centre of mass, a point, or the origin (always places[0]).
struct Place {
  std::string name;
  NodeId position = no_node;  // absolute
  std::optional<Chart> chart;
  std::uint32_t from = 0;  // place that the chart measures from
  Span span;
};
struct Particle {
  std::uint32_t place = 0;
  NodeId mass = no_node;
  Span span;
};

/// Coulomb's law: coefficients are expressions, which may use Op::slip. With a width w0 the smooth law in its place,
/// -mu |N| w / sqrt(w^2 + w0^2), which never sticks and has no static coefficient.
struct Friction {
  NodeId static_coefficient = no_node, dynamic_coefficient = no_node;
  NodeId width = no_node;
  NodeId surface_velocity = no_node;  // vector: stated motion of the surface along itself
  Span span;
};
struct Dry {  // Coulomb friction on one coordinate, with a given normal force
  std::uint32_t coordinate;
  NodeId normal;
  Friction law;
};
/// What the author of a force wrote, by the names of forces/NAME.cpp.
struct Argument {
  std::string name;
  NodeId value = no_node;   // an expression; of places and bodies where they are
  std::uint32_t index = 0;  // of a place, body, frame, coordinate, choice
};
/// What a force does, as the description of its kind spells it out.
struct Effect {
  enum class Acts {
    acceleration,  // vector `value`: of every mass
    potential,     // scalar: an energy, of the points `at`, `other` if given; Op::extension is `extension`
    force,         // vector: at the point `at`
    moment,        // vector: on the frame `index`
    work,          // scalar: a generalised force on the scalar `at`
    damping,       // scalar: coefficient of a damper between the points `at` and `other`
    component,     // scalar: a generalised force along the coordinate `index`
  };
  Acts acts = Acts::potential;
  NodeId value = no_node;
  NodeId at = no_node, other = no_node, extension = no_node;
  std::uint32_t index = 0;
};
struct Force {
  std::string name;  // given, or "force 2"
  std::string kind;  // name in forces::registry()
  std::vector<Argument> arguments;
  std::vector<Effect> effects;
  std::optional<Dry> dry;  // a contact, which has no effects
  Span span;

  const Argument* argument(std::string_view key) const;  // nullptr where it is not given
  /// The expression of an argument; no_node where it is not given.
  NodeId value(std::string_view key) const;
  /// The acceleration of every mass, of uniform gravity; no_node of all other forces.
  NodeId acceleration() const;
};

/// Where a body touches a plane or another body: rolling = { .. }, sliding = { .. }.
struct BodyContact {
  std::uint32_t place = 0, frame = 0;              // of the body
  NodeId arm = no_node;                            // from its centre of mass to the point of contact
  std::uint32_t other_place = 0, other_frame = 0;  // of the body that it touches; 0: a plane
  NodeId other_arm = no_node;
  std::array<NodeId, 2> tangents{no_node, no_node};  // t1, t2; vectors
  NodeId slip = no_node;                             // vector: the velocity of its point there against what it touches
  NodeId tangential_velocity = no_node;              // vector: that of the point of contact over the body
  std::vector<NodeId> normal_velocity;               // vanish if the point of contact is one, per body
  NodeId offset = no_node;  // vector: vanishes if the points of both bodies are over one another
  bool rolling = false;     // written as rolling
};

/// Two bodies that turn together: gear = { .. } between bodies.
struct Coupled {
  std::array<std::uint32_t, 3> frames{};         // of A and B, and on which both turn; 0: the ground
  std::array<NodeId, 2> axes{no_node, no_node};  // unit vectors
  NodeId ratio = no_node;                        // of the speed of A to that of B
};

inline constexpr std::size_t joint_components = 6;  // of reactions: three of the force on B, three of the moment

struct Constraint {
  std::string name;
  std::vector<NodeId> psi;  // scalar equations psi = 0; more than one are NAME.1, NAME.2, ...
  bool curve = false;       // holonomic = ["psi1", "psi2"]
  bool velocity = false;    // velocity = "..": psi binds velocities
  bool rolling = false;     // without friction: of three equations the first two bind velocities, the third positions
  std::optional<BodyContact> contact;  // of rolling and sliding
  bool unilateral = false;             // psi >= 0: it pushes and does not pull
  NodeId restitution = no_node;        // of impacts of a unilateral one; none: 0
  std::optional<Friction> friction;
  std::optional<std::uint32_t> joint;  // whose equations these are
  bool unit = false;                   // the length of Euler parameters
  std::optional<Coupled> coupled;
  Span span;

  bool binds_velocities(std::size_t equation) const { return velocity || (rolling && equation < 2); }
  /// Rolls while friction holds it: one equation, and two components of friction as reactions before it.
  bool rolls_by_friction() const { return contact && contact->rolling && friction; }
  std::size_t reactions() const { return joint ? joint_components : rolls_by_friction() ? 3 : psi.size(); }
};

/// Between two bodies, or a body and the ground. Its equations are those of a Constraint of the same name.
struct Joint {
  std::string name;
  std::string type;                                // name in joints::registry()
  std::array<std::uint32_t, 2> frames{};           // of A and B; 0: the ground
  std::array<NodeId, 2> points{no_node, no_node};  // of the joint in A and B
  std::array<NodeId, 2> drift{
      no_node, no_node};  // vectors that vanish if these points are fixed in their bodies; no_node: they are
  std::vector<NodeId> force,
      moment;              // per equation, vectors: what lambda = 1 is on B, the moment about its point; no_node: none
  std::uint32_t axes = 0;  // frame along whose axes the reactions are given
  std::uint32_t constraint = 0;  // index into Model::constraints
  Span span;
};
struct Event {  // a change of sign of `when`
  enum class Direction { any, up, down };
  std::string name;
  NodeId when = no_node;
  Direction direction = Direction::any;
  bool stop = false;  // action = "stop": the run ends there
  Span span;
};
const char* name(Event::Direction direction);  // "any", "up", "down"

/// A shape of [draw], about its middle along the own axes of a body; of a particle along E1 E2 E3.
struct Drawn {
  std::uint32_t place = 0;
  std::string kind;  // sphere R; box a, b, c; cylinder R, L; disk R; rod L; arrow x, y, z; mesh x, y, z of each point
  std::vector<NodeId> lengths;
  std::vector<std::vector<std::uint32_t>> faces;  // of a mesh: its points, from 0; none: it is convex
  std::uint32_t axis = 2;                         // that a cylinder, disk or rod is about
  std::vector<NodeId> at;                         // of its middle; none: 0
  Span span;
};

struct Energy {
  NodeId kinetic = no_node, potential = no_node;
};

struct InitialValue {
  std::uint32_t coordinate;
  std::uint8_t order;  // 0: value, 1: rate
  NodeId value;
  Span span;
};
struct InitialRotation {  // "B.omega" = [..]: along its own axes
  std::uint32_t frame;
  std::array<NodeId, 3> value;
  Span span;
};
struct InputTable {  // piecewise constant: value[k] from t[k] until t[k+1]
  std::vector<NodeId> t, value;
};
struct SceneInput {
  std::uint32_t input;
  std::variant<NodeId, InputTable> signal;
  Span span;
};
struct Named {
  std::string name;
  Span span;
};
struct Scene {
  // Defined once: every file that holds one would compile them anew.
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  std::string name;
  NodeId t0 = no_node, t1 = no_node;
  std::vector<InitialValue> initial, guess;
  std::vector<InitialRotation> rotations;
  std::vector<std::pair<std::uint32_t, std::uint8_t>> solve;  // coordinate, order that may be moved
  std::vector<std::pair<std::uint32_t, NodeId>> parameters;
  std::vector<SceneInput> inputs;
  std::vector<Named> outputs;       // checked against the names that exist; "energy", "reaction.NAME", ...
  std::vector<std::uint32_t> stop;  // events that end this scene, whatever their action
  std::string solver = "auto";
  NodeId rtol = no_node, atol = no_node, step = no_node, every = no_node;
  Span span;
};

struct Model {
  // Defined once: every file that holds one would compile them anew.
  Model();
  Model(const Model&);
  Model(Model&&) noexcept;
  Model& operator=(const Model&);
  Model& operator=(Model&&) noexcept;
  ~Model();

  std::string file;  // as given
  std::string id;    // file name without .toml
  std::string title, notes;
  std::vector<std::string> lines;  // the source, for carets
  std::string content_hash;        // of the file's bytes, hexadecimal
  Arena arena;
  std::vector<Parameter> parameters;
  std::vector<Function> functions;
  std::vector<Integral> integrals;  // inner ones before those that use them
  std::optional<std::uint32_t>
      start_time;  // the parameter that holds t0 of the run: the last; where there are integrals
  std::vector<Input> inputs;
  std::vector<Coordinate> coordinates;  // in order of declaration or first appearance
  std::vector<Definition> definitions;
  std::vector<Place> places;  // [0] is the origin
  std::vector<Particle> particles;
  std::vector<Frame> frames;  // [0] are the fixed axes
  std::vector<Body> bodies;
  Energy energy;
  std::vector<Force> forces;
  std::vector<Constraint> constraints;
  std::vector<Joint> joints;
  std::vector<Event> events;
  std::vector<Drawn> drawn;
  std::vector<Scene> scenes;  // scenes[0] is "default" (made up if the file has none)
  std::vector<Warning> warnings;

  Where where(const Span& span) const;                // for Error
  const Scene& scene(const std::string& name) const;  // throws Error with did-you-mean
};

/// Reads and checks a model file. Throws Error{stage "model"}.
Model read_model(const std::string& path);
/// The same from a text that is already in memory (tests, fuzzing); `file` is the name that errors show.
Model read_model_text(const std::string& text, const std::string& file);

}  // namespace eomgen::model
