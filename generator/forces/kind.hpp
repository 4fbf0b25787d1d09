// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of forces as data: a kind is one file with a function that makes one of these, and one line in registry.inc.
// It says which keys a force of this kind has in a model file, and what it does, as formulas in the language of model
// files. The model reader checks the keys and spells the formulas out (model/spell_forces.cpp), so that nothing
// downstream knows a force by name. The judge states each kind on its own, from what the author wrote
// (verify/forces/).
//
// Names in the formulas: the keys; of `ends` a and b; of `bodies` fA and fB with their axes A1 A2 A3 and B1 B2 B3 and
// their angular velocities wA and wB (E1 E2 E3 and 0 of the ground); of `points` rA and rB; of `body` its mass m, the
// position r of its centre of mass and its angular velocity w; of `triple` its entries with 1, 2, 3 behind the key; of
// terms over several masses those of Over.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace eomgen::forces {

enum class Asks {
  scalar,
  vector,
  triple,  // an array of three scalars
  point,   // a place by its name, or a vector
  points,  // two of them
  ends,    // two of them that are not the same, in space: between = [P, Q]
  place,   // a particle or point by its name
  frame,   // a body or frame, which the ground is not
  body,    // a body with mass
  bodies,  // two bodies or frames, or the ground and one
  energy,  // a scalar of `extension`
  choice,  // one of Key::choices
};

/// What a value may depend on, beside parameters.
enum class On { time, motion, state };  // t; and coordinates; and velocities and inputs

struct Choice {
  std::string text;
  std::string of_bodies;  // what it does with bodies, where it needs some: "acts on what a [[body]] has of inertia"
};

struct Key {
  std::string name;
  Asks asks = Asks::scalar;
  std::string unit = {};  // asked; empty: any
  On on = On::time;
  bool optional = false;
  std::string fallback = {};  // formula where it is left out and optional; empty: it has no value then
  std::string with = {};      // the fallback is for where this other key is given
  std::string unless = {};    // needed where this other key is not given
  std::string what = {};      // in messages: "gravity"; empty: "the KEY of FORCE"
  std::string remedy = {};    // where it is missing or made of what it may not depend on
  std::vector<Choice> choices = {};
};

/// What must hold of keys together. Messages follow the name of the force: "'f' has both a stiffness and an energy".
struct Rule {
  enum class Asks { not_both, one_of, needs };  // not both; at least one; the first needs the second
  Asks asks = Asks::not_both;
  std::string first, second;
  std::string what, remedy;
};

enum class Over { once, masses, pairs, bodies };  // once; m, r; m1, r1, m2, r2; m, r, d = arm, dJd = d . J d, trJ

/// What the formula is.
enum class Acts {
  acceleration,  // vector: of every mass
  potential,     // scalar: a potential energy
  force,         // vector: at the point `at`
  moment,        // vector: on the frame that the key `at` names, or on fA, fB of `bodies`
  work,          // scalar: a generalised force on the scalar `at`
  damping,       // scalar: coefficient of a damper between the ends a and b
};

/// Where a term is there; of a key that is left out and has a fallback, what counts as written is the fallback.
enum class Is { given, left_out, zero, not_zero, chosen };
struct When {
  Is is = Is::given;
  std::string key;
  std::string choice = {};
};

struct Term {
  Acts acts = Acts::potential;
  std::string formula;
  std::string at = {};
  std::vector<When> when = {};  // all of them
  std::string extension = {};   // what `extension` stands for in the formula
  Over over = Over::once;
  std::string arm = {};  // of Over::bodies
};

enum class Form {
  table,       // KIND = { key = value, .. }
  value,       // KIND = value, with the other keys beside it
  components,  // KIND = { coordinate = force, .. }
  friction,    // KIND = { coordinate, normal, and the law of friction }
};

/// Between two points among the keys' names; none where they are empty.
struct Line {
  std::string from, to;
};

struct Kind {
  std::string name;   // KIND of a model file: unique
  std::string title;  // for lists
  Form form = Form::table;
  std::vector<Key> keys = {};
  std::vector<Rule> rules = {};
  std::vector<Term> terms = {};
  Line spring = {}, damper = {};  // that `report` draws
};

std::span<const Kind> registry();
const Kind* find(std::string_view name);  // nullptr if there is none

}  // namespace eomgen::forces
