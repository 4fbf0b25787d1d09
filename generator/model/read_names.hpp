// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [parameters], [functions], [inputs], [coordinates] and [definitions]. Names are declared first; their
// values are read on demand.
#pragma once

#include <optional>

#include "model/section_reader.hpp"

namespace eomgen::model {

class NamesReader : private SectionReader {
 public:
  explicit NamesReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  std::uint32_t declare_coordinate(const std::string& name, Span span, const Entry* entry);
  TypedNode define(Symbol& symbol);
  void read_ranges();
  /// The kinetic energy of all armatures, if there are any.
  std::optional<TypedNode> armature_energy();
  void warn_misspelt(const std::string& name, Span span);
  void warn_unused();

 private:
  TypedNode define_parameter(Symbol& symbol);
  TypedNode define_function(Symbol& symbol);
  TypedNode define_input(Symbol& symbol);
  TypedNode define_definition(Symbol& symbol);
  void read_coordinate(const Entry& entry);
};

}  // namespace eomgen::model
