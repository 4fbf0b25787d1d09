// SPDX-License-Identifier: GPL-3.0-or-later
// Particles and bodies of a random mechanism: charts, rotations, inertias.
#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {

std::string MechanismBuilder::chart(Place& place) {
  const Place* from = earlier(40);
  if (from != nullptr) {
    feature("from");
    place.depend_on(*from);
  }
  const std::string tail = (from != nullptr ? ", from = \"" + from->name + "\"" : "") + std::string(" }");
  const auto own = [&](std::vector<std::string> names) {
    for (const std::string& n : names) place.own.push_back(n);
    return names;
  };
  if (times_ && dice_.chance(50)) {
    feature("entries that are expressions");
    const std::string x = own({offset()})[0], y = own({offset()})[0];
    coordinate_lines_ += x + " = {}\n";
    const std::string entries = "[\"" + x + " + " + function_of_time() + "\", \"" + y + "\"";
    return "{ cartesian = " + entries + (planar_ ? "]" : ", \"" + own({offset()})[0] + "\"]") + tail;
  }
  if (planar_) {
    switch (dice_.below(3)) {
      case 0:
        feature("cylindrical");
        return "{ cylindrical = [\"" + own({dice_.chance(50) ? length() : value(40, 120)})[0] + "\", \"" +
               own({angle()})[0] + "\", \"0\"]" + tail;
      case 1:
        feature("oblique");
        return "{ oblique = " + list(own({offset(), offset()})) + ", angle = \"" + dice_.decimal(20, 60) + "\"" + tail;
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
      return "{ cartesian = [\"" + x + " + " + moved + "\", \"" + y + "\", \"" + value(20, 60) + "*" + x + "\"]" + tail;
    }
    default: {
      feature("cartesian");
      place.free_position = from == nullptr;
      return "{ cartesian = " + list(own({offset(), offset(), offset()})) + tail;
    }
  }
}

void MechanismBuilder::add_particle() {
  Place place;
  place.name = "P" + std::to_string(places_.size() + 1);
  feature("particle");
  const std::string position = chart(place);
  std::string mass = value(50, 300);
  if (dice_.chance(8)) {
    feature("mass of time");
    mass += " + 0.1*t";
  }
  place_lines_ += "[[particle]]\nname = \"" + place.name + "\"\nmass = \"" + mass + "\"\nposition = " + position + "\n";
  places_.push_back(place);
}

std::string MechanismBuilder::rotation(Place& body, const Place*& parent) {
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
      const std::string set =
          dice_.pick<std::string>({"121", "131", "212", "232", "313", "323", "123", "132", "213", "231", "312", "321"});
      feature("euler " + set);
      return "{ euler = \"" + set + "\", angles = " + list(turn({angle(), angle(40, 110), angle()})) + " }";
    }
  }
}

std::string MechanismBuilder::inertia(const Place& body) {
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

void MechanismBuilder::add_body() {
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
    body.depend_on(*carrier);
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
    body.depend_on(*parent);
    place_lines_ += "relative_to = \"" + parent->name + "\"\n";
  }
  places_.push_back(body);
}

}  // namespace eomgen::random_models
