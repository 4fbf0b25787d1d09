// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of [[chain]], a shorthand for particles on rods.
#pragma once

#include "model/section_reader.hpp"

namespace eomgen::model {

class ChainsReader : private SectionReader {
 public:
  explicit ChainsReader(ReaderContext& context) : SectionReader(context) {}
  void declare(const Value& table);
  TypedNode position(const PlaceDeclaration& where);
  TypedNode entry(const Value& table, std::string_view key, long link, const Context& context);
};

}  // namespace eomgen::model
