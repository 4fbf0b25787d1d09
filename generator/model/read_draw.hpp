// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [draw]: shapes of particles and bodies in a report.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class DrawReader : private SectionReader {
 public:
  explicit DrawReader(ReaderContext& context) : SectionReader(context) {}
  void read();

 private:
  void read_table(const Value& table);
  ShapeSpec drawn_shape(std::uint32_t place, const Value& value);
  void read_mesh(ShapeSpec& drawn, const Value& points, const Value* faces, const std::string& what);
  void require_extent(const ShapeSpec& drawn, const Value& points, const Value* faces, const std::string& what);
  bool depends_on_start(NodeId root) const;
  std::vector<NodeId> drawn_lengths(const Value& value, std::size_t count, const std::string& what, bool positive);
};

}  // namespace eomgen::model
