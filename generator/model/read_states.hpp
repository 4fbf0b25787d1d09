// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[state]]: states of first order. Their names are declared first; rates may use all of them.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class StatesReader : private SectionReader {
 public:
  explicit StatesReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void read();
  /// The start value of a state in a scene.
  void read_initial(Scene& scene, const Entry& entry, const Symbol& symbol);

 private:
  NodeId start_value(const State& state, const Value& value);
};

}  // namespace eomgen::model
