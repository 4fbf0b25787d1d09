// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of gear = { .. } of a [[constraint]] and of the other couplings of couplings/: constraints on the velocities
// of two rotations.
#pragma once

#include <map>

#include "couplings/coupling.hpp"
#include "model/section_reader.hpp"

namespace eomgen::model {

class CouplingsReader : private SectionReader {
 public:
  explicit CouplingsReader(ReaderContext& context) : SectionReader(context) {}
  /// The entry of the coupling in a [[constraint]]; nullptr if there is none.
  const Entry* find_coupling(const Value& table) const;
  void read(Constraint& constraint, const Entry& entry);

 private:
  RotationCoupling between_bodies(const Value& table, const std::string& what, std::map<std::string, TypedNode>& local);
  TypedNode relative_angular_velocity(std::uint32_t frame, Span span);
};

}  // namespace eomgen::model
