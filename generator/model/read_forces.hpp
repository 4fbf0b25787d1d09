// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[force]]: checks the keys described in forces/ and expands the formulas.
#pragma once

#include <map>

#include "forces/kind.hpp"
#include "model/section_reader.hpp"

namespace eomgen::model {

class ForcesReader : private SectionReader {
 public:
  explicit ForcesReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void read();

 private:
  /// A force while its keys are read.
  struct ForceDraft {
    const forces::Kind& kind;
    Force& force;
    const Value& table;                      // the table with its keys
    std::string what;                        // "'NAME'" or "this spring"
    bool named = false;                      // the author gave it a name
    std::map<std::string, TypedNode> local;  // names available in its formulas
  };
  // read_forces.cpp
  const Entry& kind_of(const Value& table) const;
  void warn_of_repeated_weight() const;
  void read_force(Force& force, const Value& table);
  void read_components(Force& force, const Value& table, const std::string& what);
  void check_rules(const ForceDraft& open) const;
  void read_key(ForceDraft& open, const forces::Key& key);
  // read_force_keys.cpp
  void read_value(ForceDraft& open, const forces::Key& key, const Value& value);
  Context context(const ForceDraft& open, const forces::Key& key, Shape shape) const;
  void store_argument(ForceDraft& open, const std::string& name, const TypedNode& typed, std::uint32_t index = 0);
  void read_triple(ForceDraft& open, const forces::Key& key, const Value& value);
  void read_pair(ForceDraft& open, const forces::Key& key, const Value& value);
  void read_body(ForceDraft& open, const forces::Key& key, const Value& value);
  void read_bodies(ForceDraft& open, const forces::Key& key, const Value& value);
  void read_energy(ForceDraft& open, const forces::Key& key, const Value& value);
  void read_choice(ForceDraft& open, const forces::Key& key, const Value& value);
  // expand_forces.cpp
  void expand_formulas(ForceDraft& open);
  bool applies(const ForceDraft& open, const forces::Term& term) const;
  void add_effect(const ForceDraft& open, const forces::Term& term, const std::map<std::string, TypedNode>& local);
  std::map<std::string, TypedNode> mass_names(std::uint32_t place, NodeId mass, const std::string& number, Span span);
  void add_over_bodies(const ForceDraft& open, const forces::Term& term);
  bool is_literal_zero(NodeId node) const;
};

}  // namespace eomgen::model
