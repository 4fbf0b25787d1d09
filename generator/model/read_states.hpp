// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[state]] and [discrete]: states of first order and discrete values. Their names are declared first; rates
// may use all of them.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class StatesReader : private SectionReader {
 public:
  explicit StatesReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  /// After declare() and the declarations of all other names.
  void declare_discrete();
  void read();
  /// The start value of a state in a scene.
  void read_initial(Scene& scene, const Entry& entry, const Symbol& symbol);

 private:
  State& add(State state, const Entry* entry = nullptr);
  NodeId start_value(const State& state, const Value& value);
};

}  // namespace eomgen::model
