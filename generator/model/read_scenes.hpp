// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [scene.NAME]: initial values, parameters, inputs, outputs and the solver.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class ScenesReader : private SectionReader {
 public:
  explicit ScenesReader(ReaderContext& context) : SectionReader(context) {}
  void read();
  void refuse_shadowed_outputs();

 private:
  std::vector<const Entry*> merged(const Entry& scene, std::vector<std::string>& from) const;
  void read_scene(const Entry& entry);
  void read_span(Scene& scene, const Value& value);
  void read_initial(Scene& scene, const std::vector<const Entry*>& entries, bool guess);
  void warn_of_degrees(const Entry& entry, const TypedNode& typed, const InitialValue& initial);
  void read_solve(Scene& scene, const Value& value);
  void read_scene_parameters(Scene& scene, const std::vector<const Entry*>& entries);
  void read_scene_inputs(Scene& scene, const std::vector<const Entry*>& entries);
  InputTable read_input_table(const Value& table, const Symbol& input);
  InputTable read_written_table(const Value& table, const Symbol& input, const std::string& what);
  InputTable read_csv_table(const Value& table, const Symbol& input, const std::string& what);
  void read_solver(Scene& scene, const Value& value);
  void read_outputs(Scene& scene, const Value& value);
  bool may_be_conserved(const std::vector<std::string>& parts) const;
  void check_output(const Value& value);
  NodeId positive_number(const Value& value, const std::string& what, std::string_view unit);
  Symbol& coordinate_of_key(const Entry& entry, const std::string& what, std::uint8_t& order);
};

}  // namespace eomgen::model
