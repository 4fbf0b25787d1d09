// SPDX-License-Identifier: GPL-3.0-or-later
// [[event]]: sign changes that a run reports or that end it; and the events that end a scene.
#include "model/read_events.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eomgen::model {

const char* name(Event::Direction direction) {
  switch (direction) {
    case Event::Direction::any: return "any";
    case Event::Direction::up: return "up";
    case Event::Direction::down: return "down";
  }
  return "any";
}

void EventsReader::declare() {
  for (const Value* table : sections("event")) {
    check_keys(*table, {"[[event]]", {"name", "when", "direction", "action"}});
    Event event;
    event.name = text_of_key(*table, "name", "this [[event]]");
    event.span = table->find("name")->span;
    Symbol& symbol = scope_.declare(SymbolKind::event, event.name, event.span);
    symbol.index = static_cast<std::uint32_t>(model_.events.size());
    model_.events.push_back(std::move(event));
  }
}

void EventsReader::read() {
  std::size_t index = 0;
  for (const Value* table : sections("event")) {
    Event& event = model_.events[index++];
    const std::string what = fmt::format("the event '{}'", event.name);
    const Value& when =
        require_value(*table, "when", what, "add when = \"expression\": the event is where it changes its sign");
    const TypedNode typed =
        resolver_.value(when, Context{what, on_anything | on_reaction, Shape::scalar, std::nullopt, ""});
    if (typed.dependencies == 0) {
      source_.fail(when.span, fmt::format("{} is of a constant, which never changes its sign", what),
                   "write an expression of coordinates, velocities, accelerations, reaction.NAME, inputs or t");
    }
    event.when = typed.node;
    if (const Value* direction = table->find("direction")) {
      const char* remedy = "write direction = \"up\", \"down\" or \"any\"";
      const std::string& text =
          require_kind(Value::Kind::text, *direction, fmt::format("the direction of {}", what), remedy).text;
      if (text != "any" && text != "up" && text != "down")
        source_.fail(direction->span, fmt::format("an event has no direction {}", quote(text)), remedy);
      event.direction = text == "up"     ? Event::Direction::up
                        : text == "down" ? Event::Direction::down
                                         : Event::Direction::any;
    }
    if (const Value* action = table->find("action")) {
      const char* remedy = "write action = \"record\" or \"stop\"";
      const std::string& text =
          require_kind(Value::Kind::text, *action, fmt::format("the action of {}", what), remedy).text;
      if (text != "record" && text != "stop")
        source_.fail(action->span, fmt::format("an event has no action {}", quote(text)), remedy);
      event.stop = text == "stop";
    }
  }
}

void EventsReader::read_stop(Scene& scene, const Value& value) {
  const std::string remedy = "write stop = [\"NAME\"] with the name of an [[event]]";
  require_kind(Value::Kind::array, value, "'stop'", remedy);
  for (const Value& item : value.items) {
    require_kind(Value::Kind::text, item, "an entry of 'stop'", remedy);
    const Symbol* symbol = scope_.find(item.text);
    if (symbol == nullptr || symbol->kind != SymbolKind::event) {
      const std::string hint = did_you_mean(item.text, scope_.names(SymbolKind::event));
      source_.fail(item.span, fmt::format("'stop' names {}, which is no event", quote(item.text)),
                   hint.empty() ? remedy : hint);
    }
    if (std::find(scene.stop.begin(), scene.stop.end(), symbol->index) != scene.stop.end())
      source_.fail(item.span, fmt::format("'{}' is named twice in 'stop'", item.text), "name it once");
    scene.stop.push_back(symbol->index);
  }
}

}  // namespace eomgen::model
