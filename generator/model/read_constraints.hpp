// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[constraint]], [energy] and [impacts].
#pragma once

#include <optional>

#include "model/section_reader.hpp"

namespace eomgen::model {

class ConstraintsReader : private SectionReader {
 public:
  explicit ConstraintsReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void read();
  /// `armatures`: a kinetic energy beside that of [energy].
  void read_energy(const std::optional<TypedNode>& armatures);
  void read_impacts();

 private:
  bool read_contact(Constraint& constraint, const Value& table);
  bool read_coupling(Constraint& constraint, const Value& table);
  void read_equations(Constraint& constraint, const Value& value);
  void read_unilateral(Constraint& constraint, const Value& table);
};

}  // namespace eomgen::model
