// SPDX-License-Identifier: GPL-3.0-or-later
// [draw]: how a report draws particles and bodies.
#pragma once

#include "model/room.hpp"

namespace eomgen::model {

class DrawReader : private Room {
 public:
  explicit DrawReader(Reading& reading) : Room(reading) {}
  void read();

 private:
  Drawn drawn_shape(std::uint32_t place, const Value& value);
  std::vector<NodeId> drawn_lengths(const Value& value, std::size_t count, const std::string& what, bool positive);
};

}  // namespace eomgen::model
