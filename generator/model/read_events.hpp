// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[event]] and of the events that end a scene.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class EventsReader : private SectionReader {
 public:
  explicit EventsReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void read();
  void read_stop(Scene& scene, const Value& value);
};

}  // namespace eomgen::model
