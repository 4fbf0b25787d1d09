// SPDX-License-Identifier: GPL-3.0-or-later
// The builder of a random mechanism. In: a seed. Out: the text of a model, section by section; each file adds the
// sections of one kind.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "random/mechanisms.hpp"
#include "random/random_source.hpp"

namespace eomgen::random_models {

struct Place {
  std::string name;
  bool body = false;
  bool spatial_rotation = false;    // more than one angle
  std::vector<std::string> own;     // coordinates of its position
  std::vector<std::string> angles;  // coordinates of its rotation
  bool euler_parameters = false;
  bool free_position = false;           // three (in a plane two) Cartesian coordinates of its own, from the origin
  std::set<std::string> carriers = {};  // places that its position or its rotation depends on

  void depend_on(const Place& other) {
    carriers.insert(other.name);
    carriers.insert(other.carriers.begin(), other.carriers.end());
  }
};

// Writes one model. Every member adds some lines and records the names that later ones may refer to.
class MechanismBuilder {
 public:
  explicit MechanismBuilder(std::uint64_t seed);

  Mechanism build();

 private:
  void feature(const std::string& name) { result_.features.insert(name); }

  // A positive number, or the name of a new parameter with this value.
  std::string value(int low, int high) {
    const std::string number = equal_ && low <= 100 && 100 <= high ? "1" : dice_.decimal(low, high);
    if (!dice_.chance(named_parameters_)) return number;
    const std::string name = "p" + std::to_string(++parameters_);
    parameter_lines_ += name + " = " + number + "\n";
    return name;
  }

  std::string coordinate(const std::string& start, const std::string& rate) {
    const std::string name = "q" + std::to_string(coordinates_.size() + 1);
    coordinates_.push_back(name);
    starts_.push_back({start, rate});
    return name;
  }
  std::string length(int low = 40, int high = 150) {
    return coordinate(dice_.decimal(low, high), dice_.decimal(-60, 60));
  }
  std::string angle(int low = 30, int high = 120) {
    return coordinate(dice_.decimal(low, high), dice_.decimal(-90, 90));
  }
  std::string offset() { return coordinate(dice_.decimal(-120, 120), dice_.decimal(-60, 60)); }

  std::string function_of_time() {
    feature("prescribed motion");
    const std::string name = "f" + std::to_string(++functions_);
    const std::string smooth = dice_.decimal(10, 40) + "*sin(" + dice_.decimal(50, 300) + "*t)";
    function_lines_ += name + " = \"" + (times_ ? kink_of_time() : smooth) + "\"\n";
    return name;
  }

  static std::string list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& n : names) text += (text.empty() ? "\"" : ", \"") + n + "\"";
    return "[" + text + "]";
  }

  // The origin of a new place: an earlier place, or null for the origin of the ground.
  const Place* earlier(int percent) {
    return !places_.empty() && dice_.chance(percent) ? &places_[dice_.below(places_.size())] : nullptr;
  }

  // A direction in the axes of the ground.
  std::string direction() {
    if (planar_) return dice_.pick<std::string>({"E1", "E2", "0.6*E1 + 0.8*E2"});
    return dice_.pick<std::string>({"E1", "E2", "E3", "-E3", "E1 + E2", "0.6*E1 - 0.8*E3", "2*E2"});
  }
  std::string body_axis(const Place& body) {
    return body.name +
           (planar_ ? dice_.pick<std::string>({".e1", ".e2"}) : dice_.pick<std::string>({".e1", ".e2", ".e3"}));
  }
  std::string point_of(const Place& place) {
    if (!place.body || dice_.chance(40)) return place.name;
    feature("point on a body");
    return place.name + " + " + value(20, 80) + "*" + body_axis(place) +
           (dice_.chance(30) ? " - " + value(10, 50) + "*" + body_axis(place) : "");
  }

  std::string random_point() { return dice_.chance(35) ? "origin" : point_of(places_[dice_.below(places_.size())]); }
  std::string scalar_of_time() {
    if (dice_.chance(50)) return value(20, 300);
    if (dice_.chance(50)) {
      feature("input");
      const std::string name = "u" + std::to_string(++inputs_);
      input_lines_ += name + " = { default = " + dice_.decimal(-200, 200) + " }\n";
      return name;
    }
    return value(20, 300) + "*cos(" + dice_.decimal(50, 300) + "*t)";
  }

  void force(const std::string& line) { force_lines_ += "[[force]]\n" + line + "\n"; }

  /// A random one of the places that fit, or of all places if none fits.
  template <class Fits>
  const Place& one_of(const Fits& fits) {
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (fits(places_[i])) which.push_back(i);
    }
    return places_[which.empty() ? dice_.below(places_.size()) : dice_.pick(which)];
  }

  // mechanism_places.cpp
  std::string chart(Place& place);
  std::string rotation(Place& body, const Place*& parent);
  std::string inertia(const Place& body);
  void add_particle();
  void add_body();

  // mechanism_forces.cpp
  void add_forces();
  void add_energies();

  // mechanism_constraints.cpp
  bool is_euler_parameter(const std::string& q) const;
  void constraint(const std::string& kind, const std::string& line);
  void add_constraints();
  void add_joint_of_all_axes();

  // mechanism_contacts.cpp
  std::string coulomb();
  std::string one_sided();
  void contact(const std::string& kind, const std::string& lines);
  void add_contacts();

  // mechanisms.cpp
  void add_armatures();
  // mechanism_times.cpp
  std::string kink_of_time();
  void add_times();
  std::string signal();
  std::string start_value(std::size_t of, bool rate, const std::string& number);
  // mechanism_states.cpp
  std::string free_coordinate();
  void add_states();
  void add_resets(const std::string& q, const std::vector<std::string>& states);

  Mechanism finish();

  RandomSource dice_;
  Mechanism result_;
  bool contacts_ = false, planar_ = false, equal_ = false, rolling_ = false;
  bool between_ = false;
  bool small_ = false, states_ = false, armatures_ = false, times_ = false;
  int named_parameters_ = 50, parameters_ = 0, functions_ = 0, inputs_ = 0, constraints_ = 0, joints_ = 0;
  std::vector<Place> places_;
  std::vector<std::string> coordinates_, spins_;
  std::vector<std::pair<std::string, std::string>> starts_;  // of each coordinate: value, rate
  std::set<std::string> dry_;                                // slide dry
  std::set<std::string> follows_;                            // from a constraint
  std::string parameter_lines_, function_lines_, input_lines_, coordinate_lines_, energy_, place_lines_, force_lines_,
      constraint_lines_, joint_lines_, discrete_lines_, event_lines_, start_, guess_;
};

}  // namespace eomgen::random_models
