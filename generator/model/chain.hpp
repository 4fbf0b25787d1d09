// SPDX-License-Identifier: GPL-3.0-or-later
// [[chain]]: a shorthand for particles on rods.
#pragma once

#include "model/room.hpp"

namespace eomgen::model {

class ChainsReader : private Room {
 public:
  explicit ChainsReader(Reading& reading) : Room(reading) {}
  void declare(const Value& table);
  Typed position(const PlaceSource& where);
  Typed entry(const Value& table, std::string_view key, long link, const Context& context);
};

}  // namespace eomgen::model
