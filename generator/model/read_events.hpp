// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[event]], of [[sample]], and of the events that end a scene.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class EventsReader : private SectionReader {
 public:
  explicit EventsReader(ReaderContext& context) : SectionReader(context) {}
  void declare();
  void read();
  void read_stop(Scene& scene, const Value& value);

 private:
  void read_samples();
  void read_reset(const Value& table, const std::string& what, Reset& reset);
  Assignment read_assignment(const Entry& entry, const std::string& what);
  Noise read_noise(const Entry& entry, const std::string& what);
};

}  // namespace eomgen::model
