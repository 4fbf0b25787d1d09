// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of positions in a coordinate system of the registry, or in one that the model defines.
#pragma once

#include "coordinates/coordinate_system.hpp"
#include "model/section_reader.hpp"

namespace eomgen::model {

class PositionsReader : private SectionReader {
 public:
  explicit PositionsReader(ReaderContext& context) : SectionReader(context) {}
  void declare_entries(const Value& position);
  void declare_entry(const Value& entry, std::string_view unit);
  TypedNode position(std::uint32_t place, const Value& table);

 private:
  /// A position in a chart, relative to the origin of the chart.
  struct ExpandedPosition {
    Chart chart;
    std::array<TypedNode, 3> x;
  };
  const Entry& system_entry(const Value& table) const;
  ExpandedPosition expanded_position(const Value& table, const Entry& entry);
  ExpandedPosition custom_position(const Value& table, const Entry& entry);
  std::array<TypedNode, 3> solved_position(const Value& names, const Value& q, const Context& context);
  void check_inverse(const ExpandedPosition& expanded, const Value& q, bool both);
  void check_independent(const ExpandedPosition& expanded, const Entry& entry, Span constant);
  std::array<TypedNode, 3> chart_entries(const coordinates::CoordinateSystem& system, const Value& entries);
};

}  // namespace eomgen::model
