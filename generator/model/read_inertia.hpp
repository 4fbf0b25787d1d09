// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of the inertia of a [[body]].
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class InertiaReader : private SectionReader {
 public:
  explicit InertiaReader(ReaderContext& context) : SectionReader(context) {}
  void read(Body& body, const Value& table);

 private:
  void read_scalar_inertia(Body& body, const Value& value);
  std::array<NodeId, 3> shape_moments(const Body& body, const Entry& shape);
};

}  // namespace eomgen::model
