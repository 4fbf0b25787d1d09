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
  struct Open {
    const forces::Kind& kind;
    Force& force;
    const Value& table;                  // the table with its keys
    std::string what;                    // "'NAME'" or "this spring"
    bool named = false;                  // the author gave it a name
    std::map<std::string, Typed> local;  // names available in its formulas
  };
  // read_forces.cpp
  const Entry& kind_of(const Value& table) const;
  void read_force(Force& force, const Value& table);
  void read_components(Force& force, const Value& table, const std::string& what);
  void check_rules(const Open& open) const;
  void read_key(Open& open, const forces::Key& key);
  // read_force_keys.cpp
  void read_value(Open& open, const forces::Key& key, const Value& value);
  Context context(const Open& open, const forces::Key& key, Shape shape) const;
  void keep(Open& open, const std::string& name, const Typed& typed, std::uint32_t index = 0);
  void read_triple(Open& open, const forces::Key& key, const Value& value);
  void read_pair(Open& open, const forces::Key& key, const Value& value);
  void read_body(Open& open, const forces::Key& key, const Value& value);
  void read_bodies(Open& open, const forces::Key& key, const Value& value);
  void read_energy(Open& open, const forces::Key& key, const Value& value);
  void read_choice(Open& open, const forces::Key& key, const Value& value);
  // spell_forces.cpp
  void spell(Open& open);
  bool applies(const Open& open, const forces::Term& term) const;
  void add_effect(const Open& open, const forces::Term& term, const std::map<std::string, Typed>& local);
  std::map<std::string, Typed> mass_names(std::uint32_t place, NodeId mass, const std::string& number, Span span);
  void add_over_bodies(const Open& open, const forces::Term& term);
  bool is_written_zero(NodeId node) const;
};

}  // namespace eomgen::model
