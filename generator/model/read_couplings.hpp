// SPDX-License-Identifier: GPL-3.0-or-later
// gear = { .. } of a [[constraint]], and other couplings of couplings/: a constraint on the velocities of two
// rotations.
#pragma once

#include <map>

#include "couplings/coupling.hpp"
#include "model/section_reader.hpp"

namespace eomgen::model {

class CouplingsReader : private SectionReader {
 public:
  explicit CouplingsReader(ReaderContext& context) : SectionReader(context) {}
  /// The coupling that a [[constraint]] is; nullptr where it is none.
  const Entry* found(const Value& table) const;
  void read(Constraint& constraint, const Entry& entry);

 private:
  Coupled between_bodies(const Value& table, const std::string& what, std::map<std::string, Typed>& local);
  Typed turning(std::uint32_t frame, Span span);
};

}  // namespace eomgen::model
