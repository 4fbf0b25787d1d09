// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints and joints of a random mechanism.
#include <algorithm>

#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {

void MechanismBuilder::constraint(const std::string& kind, const std::string& line) {
  feature(kind);
  result_.constrained = true;
  constraint_lines_ += "[[constraint]]\nname = \"c" + std::to_string(++constraints_) + "\"\n" + line + "\n";
}

bool MechanismBuilder::is_euler_parameter(const std::string& q) const {
  for (const Place& p : places_) {
    if (p.euler_parameters && std::find(p.angles.begin(), p.angles.end(), q) != p.angles.end()) return true;
  }
  return false;
}

void MechanismBuilder::add_constraints() {
  std::size_t left = coordinates_.size();
  for (const Place& p : places_) left -= p.euler_parameters ? 1 : 0;
  const auto room = [&](std::size_t wanted) { return left > wanted && (left -= wanted, true); };
  const std::size_t count = dice_.chance(60) ? 0 : 1 + dice_.below(2);
  for (std::size_t k = 0; k < count; ++k) {
    const Place& a = places_[dice_.below(places_.size())];
    const Place& b = places_[dice_.below(places_.size())];
    switch (dice_.below(6)) {
      case 0: {  // a joint in the configuration of the start; loops, and bodies with their own coordinates
        if (!a.body || (&a != &b && !b.body)) break;
        const std::string type =
            planar_ ? "pin" : dice_.pick<std::string>({"ball", "pin", "universal", "cylindrical", "slider"});
        const std::size_t equations = planar_ ? 2 : type == "ball" ? 3 : type == "pin" || type == "slider" ? 5 : 4;
        const std::string other = &a == &b ? "ground" : b.name;
        if (type == "universal" || !room(equations)) break;
        feature("joint " + type);
        result_.constrained = true;
        joint_lines_ += "[[joint]]\nname = \"j" + std::to_string(++joints_) + "\"\ntype = \"" + type +
                        "\"\nbodies = [\"" + other + "\", \"" + a.name + "\"]\nat = \"" + point_of(a) + "\"\n" +
                        (type == "ball" ? "" : "axis = \"" + (planar_ ? "E3" : body_axis(a)) + "\"\n");
        break;
      }
      case 1:
        if (!a.free_position || &a == &b || b.carriers.contains(a.name) || !room(1)) break;
        if (follows_.contains(a.own[0])) break;
        follows_.insert(a.own[0]);
        constraint("distance", "holonomic = \"norm(" + a.name + " - " + b.name + ") - " + value(80, 200) +
                                   (dice_.chance(25) ? " - " + function_of_time() : "") + "\"");
        break;
      case 2: {
        const std::string q = dice_.pick(coordinates_), r = dice_.pick(coordinates_);
        if (q == r || follows_.contains(q) || follows_.contains(r) || is_euler_parameter(q) || !room(1)) break;
        follows_.insert(q);
        constraint("relation of coordinates", "holonomic = \"" + q + " - " + value(40, 90) + "*" + r +
                                                  (dice_.chance(40) ? "^2" : "") + " - " + value(10, 60) + "\"");
        break;
      }
      case 3: {
        const std::string q = dice_.pick(coordinates_), r = dice_.pick(coordinates_), s = dice_.pick(coordinates_);
        if (q == r || !room(1)) break;
        constraint("velocity constraint",
                   "velocity = \"" + q + "_dot*cos(" + s + ") - " + value(30, 90) + "*" + r + "_dot\"");
        break;
      }
      case 4:
        if (!a.body || !room(1)) break;
        constraint("knife edge", "velocity = \"dot(" + body_axis(a) + ", velocity(" + a.name + "))\"");
        break;
      default:
        if (planar_ || !a.body || !a.free_position || !a.spatial_rotation || rolling_ || follows_.contains(a.own[2]) ||
            !room(3))
          break;
        rolling_ = true;
        follows_.insert(a.own[2]);
        constraint("rolling", "rolling = { body = \"" + a.name + "\", shape = { " +
                                  dice_.pick<std::string>({"sphere", "sphere"}) + " = \"" + value(20, 60) +
                                  "\" }, on = \"ground\" }");
        break;
    }
  }
}

// Two bodies with orthogonal axes, or rigidly connected in the configuration of the start.
void MechanismBuilder::add_joint_of_all_axes() {
  const bool universal = !planar_ && dice_.chance(70);
  // The position of the first and one of its angles follow from a universal joint.
  const auto fits = [&](const Place& p) {
    return p.body && (!universal || (p.free_position && p.angles.size() == 3 && p.spatial_rotation));
  };
  const Place& a = one_of(fits);
  const Place& b = places_[dice_.below(places_.size())];
  if (!fits(a) || (&a != &b && !b.body)) return;
  // Points that move with the position of a may have a distance that no position of a removes.
  if (universal && b.carriers.contains(a.name)) return;
  const std::string other = &a == &b ? "ground" : b.name,
                    head = "[[joint]]\nname = \"j" + std::to_string(joints_ + 1) + "\"\n";
  const std::string bodies = "bodies = [\"" + other + "\", \"" + a.name + "\"]\n";
  std::size_t left = coordinates_.size();
  for (const Place& p : places_) left -= p.euler_parameters ? 1 : 0;
  if (left <= (universal ? 4u : planar_ ? 3u : 6u) || result_.constrained) return;
  if (universal) {
    const std::string at = &a == &b ? "origin" : point_of(b), from = point_of(a), axis = &a == &b ? "E3" : body_axis(b);
    joint_lines_ += head + "type = \"universal\"\n" + bodies + "at = [\"" + at + "\", \"" + from + "\"]\naxis = [\"" +
                    axis + "\", \"" + body_axis(a) + "\"]\n";
    for (const std::string& q : a.own) follows_.insert(q);
    follows_.insert(a.angles[1]);
  } else {
    joint_lines_ += head + "type = \"fixed\"\n" + bodies + "at = \"" + point_of(a) + "\"\n";
  }
  ++joints_;
  result_.constrained = true;
  feature(universal ? "joint universal" : "joint fixed");
}

}  // namespace eomgen::random_models
