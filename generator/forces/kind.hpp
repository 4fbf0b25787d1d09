// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of forces as data: a kind is one file with a function that returns a Kind, and one line in registry.inc. A Kind
// lists the keys of the force in a model file, and its effects as formulas in the model language. The model reader
// checks the keys and expands the formulas (model/expand_forces.cpp), so that no later stage depends on a kind of
// force. The oracle has its own statement of each kind, in terms of the keys that the author wrote (oracle/forces/).
//
// Names in the formulas: the keys. In addition: for `ends` a and b; for `bodies` fA and fB with their axes A1 A2 A3 and
// B1 B2 B3 and their angular velocities wA and wB (for the ground E1 E2 E3 and 0); for `points` rA and rB; for `body`
// its mass m, the position r of its centre of mass and its angular velocity w; for `triple` the key followed by 1, 2,
// 3; for terms over several masses the names of the enum below (once, masses, pairs, bodies).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::forces {

enum class ValueType {
  scalar,
  vector,
  triple,  // an array of three scalars
  point,   // the name of a place, or a vector
  points,  // two points
  ends,    // two different points: between = [P, Q]
  place,   // the name of a particle or point
  frame,   // a body or frame, not the ground
  body,    // a body with mass
  bodies,  // two bodies or frames, or one and the ground
  energy,  // a scalar function of `extension`
  choice,  // one of Key::choices
};

/// The variables that a value may depend on, besides parameters. Each entry includes the previous ones.
enum class Dependency { time, motion, state };  // t; coordinates; velocities and inputs

struct Choice {
  std::string text;
  std::string body_requirement;  // if it needs bodies: the reason, "acts on what a [[body]] has of inertia"
};

struct Key {
  std::string name;
  ValueType type = ValueType::scalar;
  std::string unit = {};  // required; empty: any
  Dependency dependency = Dependency::time;
  bool optional = false;
  std::string default_value = {};     // default formula of an optional key; empty: no value
  std::string default_requires = {};  // the default applies only if this other key is given
  std::string required_unless = {};   // required only if this other key is not given
  std::string what = {};              // in messages: "gravity"; empty: "the KEY of FORCE"
  std::string remedy = {};            // if it is missing or depends on a forbidden variable
  std::vector<Choice> choices = {};
  bool is_stiffness = false;  // of a spring: `stress` varies it
};

/// A condition on two keys. Messages follow the name of the force: "'f' has both a stiffness and an energy".
struct Rule {
  enum class Type { not_both, one_of, needs };  // not both; at least one; the first needs the second
  Type type = Type::not_both;
  std::string first, second;
  std::string what, remedy;
  std::vector<std::string> others = {};  // of one_of: further keys
};

/// The objects over which a term is summed, and the names that its formula may use:
/// once: none; masses: m, r; pairs: m1, r1, m2, r2; bodies: m, r, d = arm, dJd = d . J d, trJ = trace of J.
enum class Domain { once, masses, pairs, bodies };

/// The meaning of the formula of a term.
enum class LoadType {
  acceleration,  // vector: an acceleration of every mass
  potential,     // scalar: a potential energy
  force,         // vector: at the point `at`
  moment,        // vector: on the frame that the key `at` names, or on fA, fB of `bodies`
  work,          // scalar: a generalised force on the scalar `at`
  damping,       // scalar: coefficient of a damper between the ends a and b
};

/// A condition on a key. An omitted key with a default counts as given with this default.
enum class Predicate { given, left_out, zero, nonzero, chosen };
struct Condition {
  Predicate predicate = Predicate::given;
  std::string key;
  std::string choice = {};
};

struct Term {
  LoadType load_type = LoadType::potential;
  std::string formula;
  std::string at = {};
  std::vector<Condition> conditions = {};  // the term applies if all of them hold
  std::string extension = {};              // the formula for which `extension` stands
  Domain domain = Domain::once;
  std::string arm = {};  // of Domain::bodies
};

/// How a force of this kind is written in a model file.
enum class InputFormat {
  table,       // KIND = { key = value, .. }
  value,       // KIND = value, with the other keys in the same table
  components,  // KIND = { coordinate = force, .. }
  friction,    // KIND = { coordinate, normal, and the law of friction }
};

/// A symbol drawn between the points of two keys; empty names: none.
struct Line {
  std::string from, to;
};

/// Keys of a linear spring between the points of a potential: with s = a - b the energy is k (|s| - l)^2/2. Empty
/// names: none.
struct LinearSpring {
  std::string stiffness, length;
};

struct Kind {
  std::string name;   // unique; the key KIND of a model file
  std::string title;  // for lists
  InputFormat form = InputFormat::table;
  std::vector<Key> keys = {};
  std::vector<Rule> rules = {};
  std::vector<Term> terms = {};
  Line spring = {}, damper = {};    // drawn by `report`
  LinearSpring linear_spring = {};  // its energy as textbooks write it, its forces as arrows
};

std::span<const Kind> registry();
const Kind* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::forces
