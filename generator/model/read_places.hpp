// SPDX-License-Identifier: GPL-3.0-or-later
// [[particle]] [[point]], and where the places of bodies and chains are.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class PlacesReader : private SectionReader {
 public:
  explicit PlacesReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void declare_coordinates();
  std::uint32_t declare_place(const std::string& name, Span span, PlaceSource where);
  Typed define_place(Symbol& symbol);
  void read_particles();
};

}  // namespace eomgen::model
