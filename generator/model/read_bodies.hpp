// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[body]] and [[frame]]: rotations, points on bodies, and initial rotations.
#pragma once

#include <map>

#include "model/section_reader.hpp"
#include "rotations/rotation.hpp"

namespace eomgen::model {

class BodiesReader : private SectionReader {
 public:
  explicit BodiesReader(ReaderContext& context) : SectionReader(context) {}
  void declare_frame(const Value& table, std::uint32_t place, Symbol& symbol);
  void declare_angles(const Value& table);
  TypedNode define_axes(Symbol& symbol);
  TypedNode point_on_body(const Value& table, const std::string& what);
  void read();
  void declare_units();
  void read_units();
  void complete_parameters(Scene& scene);
  bool read_initial_angular_velocity(Scene& scene, const Entry& entry, bool guess);
  void check_initial_angular_velocities(const Scene& scene) const;

 private:
  const Entry& rotation_entry(const Value& rotation) const;
  void read_rotation(Frame& frame, std::uint32_t index, const Value& rotation);
  std::vector<const Value*> rotation_entries(Frame& frame, const rotations::Rotation& found, const Entry& entry,
                                             const Value& rotation);
  std::optional<std::array<cln::cl_RA, 3>> numbers_of(NodeId vector) const;
  void read_axis_rotation(Frame& frame, std::uint32_t index, const Value& rotation,
                          std::map<std::string, TypedNode>& local);
  void add_stage(std::uint32_t index, const rotations::Step& step, const std::map<std::string, TypedNode>& local,
                 Span span);
};

}  // namespace eomgen::model
