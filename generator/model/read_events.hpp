// SPDX-License-Identifier: GPL-3.0-or-later
// [[event]], and the events that end a scene.
#pragma once

#include "model/room.hpp"

namespace eomgen::model {

class EventsReader : private Room {
 public:
  explicit EventsReader(Reading& reading) : Room(reading) {}
  void declare();
  void read();
  void read_stop(Scene& scene, const Value& value);
};

}  // namespace eomgen::model
