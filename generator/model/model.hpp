// SPDX-License-Identifier: GPL-3.0-or-later
// The checked contents of a model file: the product of the model stage and the only input of later stages.
// Contract: docs/model-format.md. Quantities are in SI units, names are resolved to indices, vectors are 3-D.
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

/// Exponents of m kg s A K mol cd.
struct Dimension {
  std::array<Rational, 7> exponents{};
};
struct Unit {
  std::string text;                    // canonical SI, "m/s^2"; "1" for pure numbers; empty if unknown
  std::optional<Dimension> dimension;  // nullopt: unknown (a bare number)
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
  std::optional<std::uint32_t> initial_value_of;  // initial(q): the coordinate whose initial value every run assigns
};
struct Function {  // of time
  std::string name;
  NodeId expression = no_node;
  Unit unit;
  std::string tex;
  Span span;
};
/// A state of first order: d/dt of it is `rate`. It is declared by [[state]], or it is integral(e) from the start of
/// the run. Of a function of time (`integral`), that is a state only if e has no antiderivative in closed form; of the
/// motion, it is one like a declared state. A discrete value ([discrete]) is a state with the rate 0, which events and
/// samples change.
struct State {
  std::string name;  // of an integral "integral_1"; unique in the model
  NodeId rate = no_node;
  NodeId initial = no_node;  // its value at the start if a scene gives none; none: 0
  NodeId energy = no_node;   // the energy that it stores, if stated
  Unit unit;
  std::string tex;
  Span span;
  bool integral = false;
  bool discrete = false;
};
struct Input {
  /// Source of the value: a scene, or the contacts of a run (mechanics/contact_forces.hpp).
  enum class Source { scene, contacts };
  std::string name;
  NodeId default_value = no_node;  // the value if a scene gives none
  Unit unit;
  std::string tex;
  Span span;
  Source source = Source::scene;
};
struct Coordinate {
  std::string name;
  Unit unit;
  std::string tex;
  NodeId lower = no_node, upper = no_node;  // open interval of the chart, if it has one
  Span span;
  bool is_along_rim = false;  // the angle of the nearest point of a rim: it may start anywhere
};
struct Definition {
  std::string name;
  NodeId expression = no_node;
  bool vector = false;
  Unit unit;
  Span span;
};

/// The coordinate system and the entries of a place, as the user wrote them. Place::position is the same position as a
/// vector.
struct Chart {
  std::string system;                                           // name in coordinates::registry()
  std::array<NodeId, 3> entries{no_node, no_node, no_node};     // scalar expressions for the slots (third 0 if planar)
  std::array<NodeId, 3> unit_basis{no_node, no_node, no_node};  // vector expressions e_1, e_2, e_3; no_node: normalise
  bool planar = false;
};
/// The axes e1 e2 e3 after one step of a rotation: as vectors, as e_k = sum_j R[k][j] p_j in terms of the previous axes
/// (at first those of the parent), and the components along e1 e2 e3 of the angular velocity relative to them.
struct RotationStage {
  std::array<NodeId, 3> e{no_node, no_node, no_node};  // vectors
  std::array<std::array<NodeId, 3>, 3> R{};            // no_node: 0
  std::array<NodeId, 3> w{no_node, no_node, no_node};  // no_node: 0
};
/// Rotating axes of a body or of a [[frame]]; frames[0] are E1 E2 E3, without stages.
struct Frame {
  std::string name;
  std::string rotation;               // name in rotations::registry()
  std::uint32_t parent = 0;           // the frame relative to which it rotates
  std::vector<NodeId> entries;        // angles, parameters
  std::vector<RotationStage> stages;  // the last is its own axes
  NodeId singularity = no_node;       // Euler angles: an expression that is 0 where they are singular
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
  std::uint32_t from = 0;  // origin of the chart, index into Model::places
  Span span;
};
struct Particle {
  std::uint32_t place = 0;
  NodeId mass = no_node;
  Span span;
};

/// Coulomb friction. The coefficients are expressions that may use Op::slip. A width w0 selects the regularised law
/// -mu |N| w / sqrt(w^2 + w0^2), which never sticks and has no static coefficient.
struct Friction {
  NodeId static_coefficient = no_node, dynamic_coefficient = no_node;
  NodeId width = no_node;
  NodeId surface_velocity = no_node;  // vector: prescribed tangential motion of the surface
  Span span;
};
struct DryFriction {  // Coulomb friction on one coordinate, with a given normal force
  std::uint32_t coordinate;
  NodeId normal;
  Friction law;
};
/// The value of one key of a force. Names are those of forces/NAME.cpp.
struct Argument {
  std::string name;
  NodeId value = no_node;   // an expression; for places and bodies their position
  std::uint32_t index = 0;  // of a place, body, frame, coordinate, choice
};
/// An effect of a force: an expanded term of the description of its kind.
struct Effect {
  enum class LoadType {
    acceleration,  // vector `value`: an acceleration of every mass
    potential,     // scalar: a potential energy, of the points `at`, `other` if given; Op::extension is `extension`
    force,         // vector: at the point `at`
    moment,        // vector: on the frame `index`
    work,          // scalar: a generalised force on the scalar `at`
    damping,       // scalar: coefficient of a damper between the points `at` and `other`
    component,     // scalar: a generalised force along the coordinate `index`
  };
  LoadType load_type = LoadType::potential;
  NodeId value = no_node;
  NodeId at = no_node, other = no_node, extension = no_node;
  std::uint32_t index = 0;
};
struct Force {
  std::string name;  // as given, or "force 2"
  std::string kind;  // name in forces::registry()
  std::vector<Argument> arguments;
  std::vector<Effect> effects;
  std::optional<DryFriction> dry;  // dry friction is a contact and has no effects
  Span span;

  const Argument* argument(std::string_view key) const;  // nullptr if it is not given
  /// The expression of an argument; no_node if it is not given.
  NodeId value(std::string_view key) const;
  /// The acceleration of uniform gravity; no_node for all other forces.
  NodeId acceleration() const;
};

/// A contact of a body with a plane or another body: rolling = { .. }, sliding = { .. }.
struct BodyContact {
  std::uint32_t place = 0, frame = 0;              // of the body
  NodeId arm = no_node;                            // from its centre of mass to the point of contact
  std::uint32_t other_place = 0, other_frame = 0;  // of the other body; 0: a plane
  NodeId other_arm = no_node;
  std::array<NodeId, 2> tangents{no_node, no_node};  // t1, t2; vectors
  NodeId slip = no_node;                             // vector: relative velocity of the material points in contact
  NodeId tangential_velocity = no_node;              // vector: velocity of the point of contact over the body
  std::vector<NodeId> normal_velocity;               // per body: 0 if the point of contact stays on its surface
  NodeId offset = no_node;  // vector: 0 if the points of contact of both bodies are on a common normal
  bool rolling = false;     // given as rolling = { .. }
};

/// A coupling of the rotations of two bodies: gear = { .. } between bodies.
struct RotationCoupling {
  std::array<std::uint32_t, 3> frames{};         // of A, of B and of the carrier of both axes; 0: the ground
  std::array<NodeId, 2> axes{no_node, no_node};  // unit vectors
  NodeId ratio = no_node;                        // of the speed of A to that of B
};

inline constexpr std::size_t joint_components = 6;  // of reactions: three of the force on B, three of the moment

struct Constraint {
  std::string name;
  std::vector<NodeId> psi;             // scalar equations psi = 0; more than one are NAME.1, NAME.2, ...
  bool curve = false;                  // holonomic = ["psi1", "psi2"]
  bool velocity = false;               // velocity = "..": psi constrains velocities
  bool rolling = false;                // without friction: equations 1 and 2 constrain velocities, equation 3 positions
  std::optional<BodyContact> contact;  // of rolling and sliding
  bool unilateral = false;             // psi >= 0: the normal force is not negative
  NodeId restitution = no_node;        // of impacts of a unilateral constraint; none: 0
  std::optional<Friction> friction;
  std::optional<std::uint32_t> joint;  // the joint to which the equations belong
  bool unit = false;                   // the unit norm of Euler parameters
  std::optional<RotationCoupling> coupled;
  Span span;

  bool is_velocity_equation(std::size_t equation) const { return velocity || (rolling && equation < 2); }
  /// Rolling with friction: one equation; its reactions are two friction components followed by the normal force.
  bool is_rolling_with_friction() const { return contact && contact->rolling && friction; }
  std::size_t reaction_count() const { return joint ? joint_components : is_rolling_with_friction() ? 3 : psi.size(); }
};

/// A joint between two bodies, or a body and the ground. Its equations are in a Constraint of the same name.
struct Joint {
  std::string name;
  std::string type;                                // name in joints::registry()
  std::array<std::uint32_t, 2> frames{};           // of A and B; 0: the ground
  std::array<NodeId, 2> points{no_node, no_node};  // of the joint in A and B
  std::array<NodeId, 2> drift{
      no_node, no_node};  // vectors that are 0 if these points are fixed in their bodies; no_node: known to be fixed
  std::vector<NodeId> force,
      moment;              // per equation, vectors: reaction on B for lambda = 1, moment about its point; no_node: none
  std::uint32_t axes = 0;  // the reactions are given along the axes of this frame
  std::uint32_t constraint = 0;  // index into Model::constraints
  Span span;
};
/// A new value of a coordinate, a velocity, a state of first order or a discrete value.
struct Assignment {
  enum class Target { coordinate, velocity, state };
  Target target = Target::state;
  std::uint32_t index = 0;  // into Model::coordinates or Model::states
  NodeId value = no_node;   // all values of a reset are those before it
  Span span;
};
/// Simultaneous changes of the state, at an event or a sample.
struct Reset {
  std::vector<Assignment> set;
  NodeId condition = no_node;  // 1 where the reset is made, 0 elsewhere; none: always
};
struct Event {  // a change of sign of `when`
  enum class Direction { any, up, down };
  std::string name;
  NodeId when = no_node;
  Direction direction = Direction::any;
  bool stop = false;  // action = "stop": the run ends there
  Reset reset;        // its condition holds for the whole event
  Span span;
};
/// A discrete value that receives a new random number at every sample, before `set` of the sample.
struct Noise {
  enum class Distribution { normal, uniform };  // mean 0 and deviation 1; from -1 to 1
  std::uint32_t state = 0;                      // a discrete value
  Distribution distribution = Distribution::normal;
  std::uint32_t seed = 0;
};
/// Changes at the times offset + k every, for all integers k.
struct Sample {
  std::string name;
  NodeId every = no_node, offset = no_node;  // of parameters; offset: none is 0
  std::vector<Noise> noise;
  Reset reset;
  Span span;
};
const char* name(Event::Direction direction);  // "any", "up", "down"

/// A shape of [draw], centred, along the axes of the body; for a particle along E1 E2 E3.
struct ShapeSpec {
  std::uint32_t place = 0;
  std::string kind;  // sphere R; box a, b, c; cylinder R, L; disk R; rod L; arrow x, y, z; mesh x, y, z of each point
  std::vector<NodeId> lengths;
  std::vector<std::vector<std::uint32_t>> faces;  // of a mesh: indices of points, from 0; empty: convex hull
  std::uint32_t axis = 2;                         // axis of a cylinder, disk or rod
  std::vector<NodeId> at;                         // position of the centre; empty: 0
  Span span;
};

/// The law of impacts, and the order in which contacts that meet at the same time take their impulses.
struct Impacts {
  enum class Law {
    newton,   // normal speeds; impulses along the normals
    poisson,  // normal impulses of compression and restitution, with friction
    moreau,   // normal speeds, with friction
    stronge,  // work of the normal impulses, with friction in one direction of slip
  };
  enum class Order { simultaneous, sequence };
  Law law = Law::newton;
  Order order = Order::simultaneous;
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
struct InitialState {
  std::uint32_t state;  // declared, in Model::states
  NodeId value;         // may use coordinates and velocities at the start
  Span span;
};
struct InitialAngularVelocity {  // "B.omega" = [..]: components along the axes of B
  std::uint32_t frame;
  std::array<NodeId, 3> value;
  Span span;
};
/// Between its times a table holds the last value or runs along a straight line. Before and after them it is constant.
enum class Interpolation : std::uint8_t { hold, linear };
struct InputTable {
  Interpolation interpolation = Interpolation::hold;
  std::vector<NodeId> t, value;               // as written in the model
  std::vector<double> csv_times, csv_values;  // in SI, from a CSV file in place of these
};
struct SceneInput {
  std::uint32_t input;
  std::variant<NodeId, InputTable> signal;
  Span span;
};
struct OutputReference {
  std::string name;
  Span span;
};
struct Scene {
  // Defined in the .cpp file, so that they are compiled only once.
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  std::string name;
  NodeId t0 = no_node, t1 = no_node;
  std::vector<InitialValue> initial, guess;
  std::vector<InitialState> states;
  std::vector<InitialAngularVelocity> rotations;
  std::vector<std::pair<std::uint32_t, std::uint8_t>> solve;  // (coordinate, order) of values that may be adjusted
  std::vector<std::pair<std::uint32_t, NodeId>> parameters;
  std::vector<SceneInput> inputs;
  std::vector<OutputReference> outputs;  // existing names only: "energy", "reaction.NAME", ...
  std::vector<std::uint32_t> stop;       // events that end this scene, regardless of their action
  std::string solver = "auto";
  NodeId rtol = no_node, atol = no_node, step = no_node, every = no_node;
  Span span;
};

struct Model {
  // Defined in the .cpp file, so that they are compiled only once.
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
  std::string content_hash;        // hash of the file's bytes, and those of its CSV files, hexadecimal
  std::string folder;              // of files that the model names; empty: it was read as text and names none
  Arena arena;
  std::vector<Parameter> parameters;
  std::vector<Function> functions;
  std::vector<State> states;  // declared ones, then integrals, inner ones first, then discrete values
  std::optional<std::uint32_t>
      start_time;  // the parameter (the last one) that holds t0 of the run; only with integrals
  std::vector<Input> inputs;
  std::vector<Coordinate> coordinates;  // in order of declaration or first appearance
  std::vector<Definition> definitions;
  std::vector<Place> places;  // [0] is the origin
  std::vector<Particle> particles;
  std::vector<Frame> frames;  // [0] are the fixed axes
  std::vector<Body> bodies;
  Energy energy;
  std::optional<Impacts> impacts;
  std::vector<Force> forces;
  std::vector<Constraint> constraints;
  std::vector<Joint> joints;
  std::vector<Event> events;
  std::vector<Sample> samples;
  std::vector<ShapeSpec> drawn;
  std::vector<Scene> scenes;  // scenes[0] is "default" (generated if the file has none)
  std::vector<Warning> warnings;

  SourceLocation where(const Span& span) const;       // for Error
  const Scene& scene(const std::string& name) const;  // throws Error with did-you-mean
};

/// Reads and checks a model file. Throws Error{stage "model"}.
Model read_model(const std::string& path);
/// The same for a text in memory (tests, fuzzing); errors show `file` as the file name. The text may name files in
/// `folder`; if that is empty, it may name none.
Model read_model_text(const std::string& text, const std::string& file, const std::string& folder = "");

}  // namespace eomgen::model
