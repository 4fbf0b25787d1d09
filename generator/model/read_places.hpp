// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[particle]] and [[point]], and of the positions of bodies and chains.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class PlacesReader : private SectionReader {
 public:
  explicit PlacesReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void declare_coordinates();
  std::uint32_t declare_place(const std::string& name, Span span, PlaceDeclaration where);
  TypedNode define_place(Symbol& symbol);
  void read_particles();
};

}  // namespace eomgen::model
