// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/section_reader.hpp"

#include <fmt/format.h>

namespace eomgen::model {

ReaderContext::ReaderContext(const Source& file, const Value& tree)
    : source(file),
      root(tree),
      scope(source),
      resolver(source, model, scope, [this](Symbol& symbol) { return define(symbol); }) {}

SectionReader::SectionReader(ReaderContext& context)
    : context_(context),
      source_(context.source),
      root_(context.root),
      model_(context.model),
      scope_(context.scope),
      resolver_(context.resolver),
      place_sources_(context.place_sources),
      frame_sources_(context.frame_sources),
      chains_(context.chains),
      coordinates_with_range_(context.coordinates_with_range),
      coordinates_with_unit_(context.coordinates_with_unit) {}

std::uint32_t SectionReader::require_place(const Value& value, const std::string& what) {
  require_kind(Value::Kind::text, value, what, "write the name of a particle or point, or \"origin\"");
  if (value.text == "origin") return 0;
  Symbol* symbol = scope_.find(value.text);
  if (symbol == nullptr || symbol->kind != SymbolKind::place) {
    std::vector<std::string> places = scope_.names(SymbolKind::place);
    places.emplace_back("origin");
    const std::string hint = did_you_mean(value.text, places);
    source_.fail(value.span,
                 symbol == nullptr ? fmt::format("there is no particle or point {}", quote(value.text))
                                   : fmt::format("{} is {}, not a particle or point", quote(value.text),
                                                 model::kind_name(symbol->kind)),
                 hint.empty() ? "name a particle or point, or \"origin\"" : hint);
  }
  symbol->used = true;
  return symbol->index;
}

std::uint32_t SectionReader::require_frame(const Value& value, const std::string& what) {
  require_kind(Value::Kind::text, value, what, "write the name of a body or frame");
  if (value.text == "ground") return 0;
  Symbol* symbol = scope_.find(value.text);
  if (symbol == nullptr || symbol->frame == 0) {
    std::vector<std::string> names;
    for (std::size_t k = 1; k < model_.frames.size(); ++k) names.push_back(model_.frames[k].name);
    const std::string hint = did_you_mean(value.text, names);
    source_.fail(value.span,
                 symbol == nullptr
                     ? fmt::format("there is no body or frame {}", quote(value.text))
                     : fmt::format("{} is {}, which has no axes", quote(value.text), model::kind_name(symbol->kind)),
                 !hint.empty()   ? hint
                 : names.empty() ? "add a [[body]] or a [[frame]]"
                                 : fmt::format("the bodies and frames are {}", fmt::join(names, ", ")));
  }
  symbol->used = true;
  return symbol->frame;
}

TypedNode SectionReader::point(const Value& value, const std::string& what) {
  // A misspelt name of a place has its own message.
  if (value.is(Value::Kind::text) && is_identifier(value.text) && scope_.find(value.text) == nullptr &&
      value.text != "origin" && !is_reserved(value.text)) {
    require_place(value, what);
  }
  return resolver_.value(value, Context{what, on_motion, Shape::vector, dimension_of("m"), ""});
}

}  // namespace eomgen::model
