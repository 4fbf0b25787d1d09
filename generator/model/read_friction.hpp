// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of Coulomb friction: friction = { .. } of a constraint, and the force dry = { .. } on one coordinate.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class FrictionReader : private SectionReader {
 public:
  explicit FrictionReader(ReaderContext& context) : SectionReader(context) {}
  void read_constraint_friction(Constraint& constraint, const Value& value);
  DryFriction read_dry_friction(const Value& table, const std::string& what);
  /// Whether it is an output of a contact: friction.NAME, friction.NAME.1 .. 3, slip.NAME, slip.NAME.1 .. 2, mode.NAME.
  bool is_output(const std::vector<std::string>& parts);

 private:
  Friction coefficients(const Value& table, const std::string& what, std::optional<Dimension> speed);
};

}  // namespace eomgen::model
