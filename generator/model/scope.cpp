// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/scope.hpp"

#include <fmt/format.h>

namespace eomgen::model {

const char* kind_name(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::parameter: return "a parameter";
    case SymbolKind::function: return "a function of time";
    case SymbolKind::input: return "an input";
    case SymbolKind::coordinate: return "a coordinate";
    case SymbolKind::state: return "a state";
    case SymbolKind::definition: return "a definition";
    case SymbolKind::place: return "a particle or point";
    case SymbolKind::frame: return "a frame";
    case SymbolKind::constraint: return "a constraint";
    case SymbolKind::force: return "a force";
    case SymbolKind::event: return "an event";
    case SymbolKind::sample: return "a sample";
  }
  return "a name";
}

Symbol& Scope::declare(SymbolKind kind, const std::string& name, Span span, const Entry* entry) {
  if (const auto reason = name_error(name)) {
    source_.fail(span, fmt::format("{} cannot be a name: {}", quote(name), *reason), "choose another name");
  }
  if (const Symbol* other = find(name)) {
    source_.fail(span, fmt::format("'{}' is declared twice", name),
                 fmt::format("it is {} on line {}; all names share one scope: choose another", kind_name(other->kind),
                             other->span.line));
  }
  if (order_.size() >= max_names) {
    source_.fail(span, fmt::format("the model has more than {} names", max_names),
                 "a model of this size cannot be handled");
  }
  Symbol symbol;
  symbol.kind = kind;
  symbol.name = name;
  symbol.span = span;
  symbol.entry = entry;
  order_.push_back(name);
  return symbols_.emplace(name, std::move(symbol)).first->second;
}

void Scope::declare_axes(const std::string& name, Span span) {
  Symbol symbol;
  symbol.kind = SymbolKind::frame;
  symbol.name = "the axes of " + name;
  symbol.span = span;
  symbol.index = static_cast<std::uint32_t>(axes_.size());
  axes_.push_back(std::move(symbol));
}

Symbol* Scope::find(std::string_view name) {
  const auto found = symbols_.find(name);
  return found == symbols_.end() ? nullptr : &found->second;
}

std::vector<std::string> Scope::names() const { return order_; }

std::vector<std::string> Scope::names(SymbolKind kind) const {
  std::vector<std::string> result;
  for (const std::string& name : order_) {
    if (symbols_.find(name)->second.kind == kind) result.push_back(name);
  }
  return result;
}

std::vector<Symbol*> Scope::all(SymbolKind kind) {
  std::vector<Symbol*> result;
  for (const std::string& name : order_) {
    Symbol* symbol = find(name);
    if (symbol->kind == kind) result.push_back(symbol);
  }
  return result;
}

}  // namespace eomgen::model
