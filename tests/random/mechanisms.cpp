// SPDX-License-Identifier: GPL-3.0-or-later
#include "random/mechanisms.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "random/between_bodies.hpp"
#include "random/dice.hpp"

namespace eomgen::random_models {
namespace {

struct Place {
  std::string name;
  bool body = false;
  bool spatial_rotation = false;    // more than one angle
  std::vector<std::string> own;     // coordinates of its position
  std::vector<std::string> angles;  // coordinates of its rotation
  bool euler_parameters = false;
  bool free_position = false;  // three (in a plane two) Cartesian coordinates of its own, from the origin
};

// The models of the seeds before it are what they were when these kinds were added: findings are told by their seeds.
constexpr std::uint64_t first_with_contacts = 1001, first_with_forces_between_bodies = 2001;

// Writes one model. Every member adds some lines and keeps account of what later ones may refer to.
class Builder {
 public:
  explicit Builder(std::uint64_t seed)
      : dice_(seed), contacts_(seed >= first_with_contacts), between_(seed >= first_with_forces_between_bodies) {}

  Mechanism build() {
    planar_ = dice_.chance(35);
    feature(planar_ ? "planar" : "spatial");
    named_parameters_ = static_cast<int>(dice_.below(3)) * 50;
    equal_ = dice_.chance(25);
    const std::size_t places = 1 + dice_.below(planar_ ? 5 : 4);
    for (std::size_t i = 0; i < places; ++i) {
      if (dice_.chance(60))
        add_body();
      else
        add_particle();
    }
    add_forces();
    add_energies();
    add_constraints();
    if (contacts_) {
      if (dice_.chance(35)) add_joint_of_all_axes();
      if (dice_.chance(75)) add_contacts();
    }
    if (between_) {
      std::vector<std::string> turning;
      for (const Place& place : places_) {
        if (place.body && !place.angles.empty()) turning.push_back(place.name);
      }
      force_lines_ += forces_between(dice_, turning, planar_, result_.features);
    }
    return finish();
  }

 private:
  void feature(const std::string& name) { result_.features.insert(name); }

  // A number, or the name of a new parameter that has it. Positive.
  std::string value(int low, int high) {
    const std::string number = equal_ && low <= 100 && 100 <= high ? "1" : dice_.decimal(low, high);
    if (!dice_.chance(named_parameters_)) return number;
    const std::string name = "p" + std::to_string(++parameters_);
    parameter_lines_ += name + " = " + number + "\n";
    return name;
  }
  std::string signed_value(int low, int high) { return (dice_.chance(50) ? "-" : "") + value(low, high); }

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
    function_lines_ += name + " = \"" + dice_.decimal(10, 40) + "*sin(" + dice_.decimal(50, 300) + "*t)\"\n";
    return name;
  }

  static std::string list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& n : names) text += (text.empty() ? "\"" : ", \"") + n + "\"";
    return "[" + text + "]";
  }

  // Where a place may be measured from: an earlier one, or the origin.
  const Place* earlier(int percent) {
    return !places_.empty() && dice_.chance(percent) ? &places_[dice_.below(places_.size())] : nullptr;
  }

  // An axis of the ground or, in space, of a body.
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

  std::string chart(Place& place) {
    const Place* from = earlier(40);
    if (from != nullptr) feature("from");
    const std::string tail = (from != nullptr ? ", from = \"" + from->name + "\"" : "") + std::string(" }");
    const auto own = [&](std::vector<std::string> names) {
      for (const std::string& n : names) place.own.push_back(n);
      return names;
    };
    if (planar_) {
      switch (dice_.below(3)) {
        case 0:
          feature("cylindrical");
          return "{ cylindrical = [\"" + own({dice_.chance(50) ? length() : value(40, 120)})[0] + "\", \"" +
                 own({angle()})[0] + "\", \"0\"]" + tail;
        case 1:
          feature("oblique");
          return "{ oblique = " + list(own({offset(), offset()})) + ", angle = \"" + dice_.decimal(20, 60) + "\"" +
                 tail;
        default: {
          feature("cartesian");
          place.free_position = from == nullptr;
          return "{ cartesian = " + list(own({offset(), offset()})) + tail;
        }
      }
    }
    switch (dice_.below(7)) {
      case 0: feature("cylindrical"); return "{ cylindrical = " + list(own({length(), angle(), offset()})) + tail;
      case 1:
        feature("spherical");
        if (dice_.chance(50))
          return "{ spherical = [\"" + value(40, 120) + "\", \"" + own({angle()})[0] + "\", \"" + own({angle()})[0] +
                 "\"]" + tail;
        return "{ spherical = " + list(own({length(), angle(), angle()})) + tail;
      case 2: feature("parabolic"); return "{ parabolic = " + list(own({length(), length(), angle()})) + tail;
      case 3:
        feature("helical");
        return "{ helical = " + list(own({angle(), length(), offset()})) + ", pitch = \"" + value(20, 60) + "\"" + tail;
      case 4:
        feature("oblique");
        return "{ oblique = " + list(own({offset(), offset(), offset()})) + ", angle = \"" + dice_.decimal(20, 60) +
               "\"" + tail;
      case 5: {
        feature("entries that are expressions");
        const std::string moved = dice_.chance(50) ? function_of_time() : value(20, 60);
        const std::string x = own({offset()})[0], y = own({offset()})[0];
        coordinate_lines_ += x + " = {}\n";
        return "{ cartesian = [\"" + x + " + " + moved + "\", \"" + y + "\", \"" + value(20, 60) + "*" + x + "\"]" +
               tail;
      }
      default: {
        feature("cartesian");
        place.free_position = from == nullptr;
        return "{ cartesian = " + list(own({offset(), offset(), offset()})) + tail;
      }
    }
  }

  void add_particle() {
    Place place;
    place.name = "P" + std::to_string(places_.size() + 1);
    feature("particle");
    const std::string position = chart(place);
    std::string mass = value(50, 300);
    if (dice_.chance(8)) {
      feature("mass of time");
      mass += " + 0.1*t";
    }
    place_lines_ +=
        "[[particle]]\nname = \"" + place.name + "\"\nmass = \"" + mass + "\"\nposition = " + position + "\n";
    places_.push_back(place);
  }

  std::string rotation(Place& body, const Place*& parent) {
    parent = nullptr;
    if (const Place* p = earlier(40); p != nullptr && p->body) parent = p;
    const auto turn = [&](std::vector<std::string> names) {
      for (const std::string& n : names) body.angles.push_back(n);
      return names;
    };
    if (planar_) {
      feature("rotation in the plane");
      return "{ axis = \"" + (parent != nullptr ? parent->name + ".e3" : std::string("E3")) + "\", angle = \"" +
             turn({angle()})[0] + "\" }";
    }
    switch (dice_.below(6)) {
      case 0: {
        body.spatial_rotation = true;
        feature("euler_parameters");
        body.euler_parameters = true;
        const std::vector<std::string> v{dice_.decimal(-40, 40), dice_.decimal(-40, 40), dice_.decimal(-40, 40)};
        std::vector<std::string> e{
            coordinate("\"sqrt(1 - (" + v[0] + ")^2 - (" + v[1] + ")^2 - (" + v[2] + ")^2)\"", "")};
        for (const std::string& start : v) e.push_back(coordinate(start, ""));
        spins_.push_back(body.name);
        return "{ euler_parameters = " + list(turn(e)) + " }";
      }
      case 1: {
        body.spatial_rotation = true;
        feature("rodrigues");
        return "{ rodrigues = " + list(turn({offset(), offset(), offset()})) + " }";
      }
      case 2:
        if (parent != nullptr && dice_.chance(60))
          return "{ axis = \"" + parent->name + dice_.pick<std::string>({".e1", ".e2", ".e3"}) + "\", angle = \"" +
                 turn({angle()})[0] + "\" }";
        parent = nullptr;
        return "{ axis = \"" + direction() + "\", angle = \"" + turn({angle()})[0] + "\" }";
      case 3:
        if (dice_.chance(40)) {
          feature("fixed rotation");
          return "{ fixed = true }";
        }
        [[fallthrough]];
      default: {
        body.spatial_rotation = true;
        const std::string set = dice_.pick<std::string>(
            {"121", "131", "212", "232", "313", "323", "123", "132", "213", "231", "312", "321"});
        feature("euler " + set);
        return "{ euler = \"" + set + "\", angles = " + list(turn({angle(), angle(40, 110), angle()})) + " }";
      }
    }
  }

  std::string inertia(const Place& body) {
    if (planar_ && dice_.chance(60)) return "\"" + value(5, 40) + "\"";
    switch (dice_.below(body.spatial_rotation || !planar_ ? 6 : 5)) {
      case 0: return "{ sphere = \"" + value(20, 60) + "\" }";
      case 1: return "{ cylinder = [\"" + value(20, 60) + "\", \"" + value(40, 90) + "\"] }";
      case 2: return "{ disk = \"" + value(20, 60) + "\" }";
      case 3: return "{ box = [\"" + value(20, 60) + "\", \"" + value(20, 60) + "\", \"" + value(20, 60) + "\"] }";
      case 4: {
        const std::string a = value(20, 24);
        return "{ principal = [\"" + a + "\", \"" + (dice_.chance(30) ? a : value(25, 29)) + "\", \"" + value(15, 19) +
               "\"] }";
      }
      default: feature("full inertia tensor"); return "[[0.25, 0.02, -0.01], [0.02, 0.3, 0.03], [-0.01, 0.03, 0.2]]";
    }
  }

  void add_body() {
    Place body;
    body.name = "B" + std::to_string(places_.size() + 1);
    body.body = true;
    feature("body");
    const Place* parent = nullptr;
    const Place* carrier = earlier(65);
    if (carrier != nullptr && !carrier->body) carrier = nullptr;
    std::string position;
    if (carrier != nullptr) {
      feature("tree of bodies");
      if (dice_.chance(25)) {
        feature("sliding in a tree");
        position = "\"" + carrier->name + " + " + length() + "*" + body_axis(*carrier) + "\"";
        coordinate_lines_ += coordinates_.back() + " = {}\n";
        body.own.push_back(coordinates_.back());
      } else {
        position = "\"" + carrier->name + " + " + value(20, 90) + "*" + body_axis(*carrier) + " - " + value(20, 90) +
                   "*" + body_axis(body) + "\"";
      }
    } else if (dice_.chance(20)) {
      feature("body on a pivot");
      position = "\"" + value(20, 90) + "*" + body_axis(body) + "\"";
    } else {
      position = chart(body);
    }
    const std::string turned = rotation(body, parent);
    place_lines_ += "[[body]]\nname = \"" + body.name + "\"\nmass = \"" + value(50, 300) +
                    "\"\ninertia = " + inertia(body) + "\nposition = " + position + "\nrotation = " + turned + "\n";
    if (parent != nullptr) {
      feature("relative rotation");
      place_lines_ += "relative_to = \"" + parent->name + "\"\n";
    }
    places_.push_back(body);
  }

  std::string somewhere() { return dice_.chance(35) ? "origin" : point_of(places_[dice_.below(places_.size())]); }
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

  void add_forces() {
    if (dice_.chance(75)) force("gravity = \"-9.81*" + std::string(planar_ ? "E2" : "E3") + "\"");
    const std::size_t count = dice_.below(4);
    for (std::size_t k = 0; k < count; ++k) {
      const Place& a = places_[dice_.below(places_.size())];
      switch (dice_.below(9)) {
        case 0:
        case 1: {
          const std::string other = "\"" + value(150, 300) + "*E1\"";
          feature("spring");
          force("spring = { between = [\"" + point_of(a) + "\", " + other + "], stiffness = \"" + value(100, 900) +
                "\", length = \"" + value(20, 120) + "\" }");
          break;
        }
        case 2:
          feature("damper");
          force("damper = { between = [\"" + point_of(a) + "\", \"" + value(150, 300) + "*E2\"], coefficient = \"" +
                value(10, 90) + "\" }");
          break;
        case 3:
          if (a.angles.empty() || a.euler_parameters) break;
          feature("torsion");
          force("torsion = { angle = \"" + dice_.pick(a.angles) + "\", stiffness = \"" + value(50, 400) +
                "\", coefficient = \"" + value(5, 50) + "\" }");
          break;
        case 4:
          if (!a.body) break;
          feature("follower force");
          force("on = \"" + point_of(a) + "\"\nforce = \"" + scalar_of_time() + "*" + body_axis(a) + "\"");
          break;
        case 5:
          if (!a.body) break;
          feature("moment");
          force("on = \"" + a.name + "\"\nmoment = \"" + scalar_of_time() + "*" + (planar_ ? "E3" : body_axis(a)) +
                "\"");
          break;
        case 6:
          feature("force");
          force("on = \"" + point_of(a) + "\"\nforce = \"" + scalar_of_time() + "*" + direction() + " - " +
                value(5, 40) + "*velocity(" + a.name + ")\"");
          break;
        case 7:
          feature("drag");
          force("drag = { on = \"" + a.name + "\", density = \"1.2\", area = \"" + value(10, 50) +
                "\", coefficient = \"0.47\" }");
          break;
        default: {
          feature("generalized force");
          const std::string q = dice_.pick(coordinates_);
          force("generalized = { " + q + " = \"" + scalar_of_time() + " - " + value(5, 40) + "*" + q + "_dot\" }");
        }
      }
    }
  }

  void add_energies() {
    if (!dice_.chance(12)) return;
    feature("energy given");
    const std::string q = dice_.pick(coordinates_);
    energy_ = "kinetic = \"1/2*" + value(20, 90) + "*" + q + "_dot^2\"\npotential = \"1/2*" + value(50, 300) + "*" + q +
              "^2\"\n";
  }

  void constraint(const std::string& kind, const std::string& line) {
    feature(kind);
    result_.constrained = true;
    constraint_lines_ += "[[constraint]]\nname = \"c" + std::to_string(++constraints_) + "\"\n" + line + "\n";
  }

  /// One of the places that fit, if any does; else any.
  template <class Fits>
  const Place& one_of(const Fits& fits) {
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (fits(places_[i])) which.push_back(i);
    }
    return places_[which.empty() ? dice_.below(places_.size()) : dice_.pick(which)];
  }

  // Two bodies with axes at right angles, or held fast to one another as they are placed at the start.
  void add_joint_of_all_axes() {
    const bool universal = !planar_ && dice_.chance(70);
    // The place of the first and one of its angles follow from a universal joint.
    const auto fits = [&](const Place& p) {
      return p.body && (!universal || (p.free_position && p.angles.size() == 3 && p.spatial_rotation));
    };
    const Place& a = one_of(fits);
    const Place& b = places_[dice_.below(places_.size())];
    if (!fits(a) || (&a != &b && !b.body)) return;
    const std::string other = &a == &b ? "ground" : b.name,
                      head = "[[joint]]\nname = \"j" + std::to_string(joints_ + 1) + "\"\n";
    const std::string bodies = "bodies = [\"" + other + "\", \"" + a.name + "\"]\n";
    std::size_t left = coordinates_.size();
    for (const Place& p : places_) left -= p.euler_parameters ? 1 : 0;
    if (left <= (universal ? 4u : planar_ ? 3u : 6u) || result_.constrained) return;
    if (universal) {
      const std::string at = &a == &b ? "origin" : point_of(b), from = point_of(a),
                        axis = &a == &b ? "E3" : body_axis(b);
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

  std::string coulomb() {
    if (dice_.chance(15)) {
      feature("smooth friction");
      return "friction = { dynamic = \"" + value(10, 60) + "\", law = \"smooth\", width = \"0.01\" }\n";
    }
    feature("dry friction");
    const std::string dynamic = dice_.decimal(10, 60);
    return "friction = { static = \"" + (dice_.chance(50) ? dynamic : dice_.decimal(61, 90)) + "\", dynamic = \"" +
           dynamic + "\" }\n";
  }

  std::string one_sided() {
    feature("unilateral");
    return std::string("holds = \"unilateral\"\n") +
           (dice_.chance(60) ? "restitution = \"" + value(0, 90) + "\"\n" : "");
  }

  // At most three, as the program takes: a floor below the start of a place, a rough one through it, dry guides, a ball
  // on rough ground.
  void add_contacts() {
    const std::string up = planar_ ? "E2" : "E3";
    const std::size_t count = 1 + dice_.below(3);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t kind = dice_.below(4);
      const Place& a = one_of([&](const Place& p) {
        return p.free_position && (kind != 1 || !p.body) && (kind != 3 || (p.body && p.spatial_rotation));
      });
      const std::string height = a.free_position ? a.own.back() : "";
      switch (kind) {
        case 0:  // a floor below the start, of which nothing is known but for coordinates
          if (height.empty())
            contact("floor",
                    "holonomic = \"dot(" + point_of(a) + ", " + up + ") + " + value(200, 400) + "\"\n" + one_sided());
          if (height.empty() || follows_.contains(height) || result_.constrained) break;
          contact("floor",
                  "holonomic = \"" + height + " - initial(" + height + ") + " + value(1, 30) + "\"\n" + one_sided());
          break;
        case 1:  // a rough one through the start, level or not
          if (height.empty() || follows_.contains(height) || a.body || result_.constrained) break;
          contact("rough surface", "holonomic = \"" + height +
                                       (dice_.chance(50) ? " - " + value(10, 40) + "*" + a.own[0] : std::string()) +
                                       " - " + value(10, 90) + "\"\n" + coulomb() +
                                       (dice_.chance(30) ? one_sided() : std::string()));
          follows_.insert(height);
          break;
        case 2: {
          const std::string q = dice_.pick(coordinates_);
          if (is_euler_parameter(q) || !dry_.insert(q).second) break;
          feature("dry force");
          const std::string dynamic = dice_.decimal(10, 60);
          force("dry = { coordinate = \"" + q + "\", normal = \"" + value(50, 300) + "\", static = \"" +
                (dice_.chance(50) ? dynamic : dice_.decimal(61, 90)) + "\", dynamic = \"" + dynamic + "\" }");
          break;
        }
        default: {
          if (planar_ || !a.body || !a.free_position || !a.spatial_rotation || rolling_ || result_.constrained) break;
          rolling_ = true;
          const bool apart = dice_.chance(40);
          const std::string radius = apart ? dice_.decimal(1, 9) : value(20, 60);
          contact("rough ball", std::string(dice_.chance(70) ? "rolling" : "sliding") + " = { body = \"" + a.name +
                                    "\", shape = { sphere = \"" + radius +
                                    "\" }, on = \"ground\" }\nfriction = { static = \"0.5\", dynamic = \"" +
                                    dice_.decimal(10, 50) + "\" }\n" + (apart ? one_sided() : std::string()));
          if (!apart) follows_.insert(height);
        }
      }
    }
  }
  void contact(const std::string& kind, const std::string& lines) {
    feature(kind);
    constraint_lines_ += "[[constraint]]\nname = \"c" + std::to_string(++constraints_) + "\"\n" + lines;
  }

  bool is_euler_parameter(const std::string& q) const {
    for (const Place& p : places_) {
      if (p.euler_parameters && std::find(p.angles.begin(), p.angles.end(), q) != p.angles.end()) return true;
    }
    return false;
  }

  void add_constraints() {
    std::size_t left = coordinates_.size();
    for (const Place& p : places_) left -= p.euler_parameters ? 1 : 0;
    const auto room = [&](std::size_t wanted) { return left > wanted && (left -= wanted, true); };
    const std::size_t count = dice_.chance(60) ? 0 : 1 + dice_.below(2);
    for (std::size_t k = 0; k < count; ++k) {
      const Place& a = places_[dice_.below(places_.size())];
      const Place& b = places_[dice_.below(places_.size())];
      switch (dice_.below(6)) {
        case 0: {  // a joint as placed at the start; loops and bodies with coordinates of their own
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
          if (!a.free_position || &a == &b || !room(1)) break;
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
          if (planar_ || !a.body || !a.free_position || !a.spatial_rotation || rolling_ ||
              follows_.contains(a.own[2]) || !room(3))
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

  Mechanism finish() {
    std::string& t = result_.text;
    t = "format = 1\n";
    const auto section = [&](const char* name, const std::string& lines) {
      if (!lines.empty()) t += std::string("[") + name + "]\n" + lines;
    };
    section("parameters", parameter_lines_);
    section("functions", function_lines_);
    section("inputs", input_lines_);
    section("coordinates", coordinate_lines_);
    section("energy", energy_);
    t += place_lines_ + force_lines_ + constraint_lines_ + joint_lines_;
    t += "[scene.default]\nt = [0, 0.3]\n";
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const auto& [value, rate] = starts_[i];
      const std::string& q = coordinates_[i];
      if (follows_.contains(q)) {
        guess_ += (guess_.empty() ? "" : ", ") + q + " = " + value;
        continue;
      }
      if (!value.empty()) start_ += (start_.empty() ? "" : ", ") + q + " = " + value;
      // Rates that constraints bind to one another are left to them: the start is at rest but for what is prescribed.
      if (!rate.empty() && !result_.constrained && constraints_ == 0)
        start_ += (start_.empty() ? "" : ", ") + q + "_dot = " + rate;
    }
    if (result_.constrained || constraints_ > 0) spins_.clear();
    for (const std::string& body : spins_)
      start_ += (start_.empty() ? "" : ", ") + ("\"" + body + ".omega\" = [" + dice_.decimal(-90, 90) + ", " +
                                                dice_.decimal(-90, 90) + ", " + dice_.decimal(-90, 90) + "]");
    t += "initial = { " + start_ + " }\n";
    if (!guess_.empty()) t += "guess = { " + guess_ + " }\n";
    return result_;
  }

  Dice dice_;
  Mechanism result_;
  bool contacts_ = false, planar_ = false, equal_ = false, rolling_ = false;
  bool between_ = false;
  int named_parameters_ = 50, parameters_ = 0, functions_ = 0, inputs_ = 0, constraints_ = 0, joints_ = 0;
  std::vector<Place> places_;
  std::vector<std::string> coordinates_, spins_;
  std::vector<std::pair<std::string, std::string>> starts_;  // of each coordinate: value, rate
  std::set<std::string> dry_;                                // slide dry
  std::set<std::string> follows_;                            // from a constraint
  std::string parameter_lines_, function_lines_, input_lines_, coordinate_lines_, energy_, place_lines_, force_lines_,
      constraint_lines_, joint_lines_, start_, guess_;
};

}  // namespace

Mechanism mechanism(std::uint64_t seed) { return Builder(seed).build(); }

}  // namespace eomgen::random_models
