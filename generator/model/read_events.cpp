// SPDX-License-Identifier: GPL-3.0-or-later
// [[event]]: sign changes that a run reports, that change the state or end the run; [[sample]]: periodic changes of the
// state; and the events that end a scene.
#include "model/read_events.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/syntax.hpp"

namespace eomgen::model {
namespace {

// A reset knows the state before it, and no accelerations or reactions.
constexpr auto on_reset_variables = static_cast<Dependencies>(on_force_variables & ~on_state_rate);

}  // namespace

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
    check_keys(*table, {"[[event]]", {"name", "when", "direction", "action", "if", "set"}});
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
    read_reset(*table, what, event.reset);
  }
  read_samples();
}

void EventsReader::read_samples() {
  for (const Value* table : sections("sample")) {
    check_keys(*table, {"[[sample]]",
                        {"name", "every", "offset", "if", "set", "noise"},
                        {{"period", "the time between two samples is 'every'"}}});
    Sample sample;
    sample.span = table->span;
    sample.name = fmt::format("sample {}", model_.samples.size() + 1);
    if (table->find("name") != nullptr) {
      sample.name = text_of_key(*table, "name", "this [[sample]]");
      sample.span = table->find("name")->span;
      Symbol& symbol = scope_.declare(SymbolKind::sample, sample.name, sample.span);
      symbol.index = static_cast<std::uint32_t>(model_.samples.size());
    }
    const std::string what = fmt::format("the sample '{}'", sample.name);
    const Value& every = require_value(*table, "every", what, "add every = \"1 ms\": the time between two samples");
    const auto seconds = [](const std::string& of) {
      return Context{of, 0, Shape::scalar, dimension_of("s"), "it is made of numbers and parameters"};
    };
    const TypedNode period = resolver_.value(every, seconds("the period of " + what));
    if (period.constant && !cln::plusp(*period.constant))
      resolver_.refuse_value(period, every.span, "the period of " + what, "is not positive",
                             "write a time greater than 0");
    sample.every = period.node;
    if (const Value* offset = table->find("offset"))
      sample.offset = resolver_.value(*offset, seconds("the offset of " + what)).node;
    if (const Value* noise = table->find("noise")) {
      require_kind(Value::Kind::table, *noise, fmt::format("the noise of {}", what),
                   "write noise = { w = { normal = 1 } }: the distribution and the seed of a discrete value");
      for (const Entry& entry : noise->entries) sample.noise.push_back(read_noise(entry, what));
    }
    read_reset(*table, what, sample.reset);
    if (sample.reset.set.empty() && sample.noise.empty())
      source_.fail(table->span, fmt::format("{} changes nothing", what), "add set = { NAME = \"value\" }");
    model_.samples.push_back(std::move(sample));
  }
}

void EventsReader::read_reset(const Value& table, const std::string& what, Reset& reset) {
  if (const Value* condition = table.find("if")) {
    const Context context{"the condition of " + what, on_reset_variables, Shape::scalar, std::nullopt,
                          "it compares coordinates, velocities, states, discrete values, inputs, parameters and t"};
    reset.condition = resolver_.condition(*condition, context).node;
  }
  const Value* set = table.find("set");
  if (set == nullptr) return;
  require_kind(Value::Kind::table, *set, fmt::format("'set' of {}", what),
               "write set = { x_dot = \"-e*x_dot\" }: new values of velocities, coordinates, states, discrete values");
  for (const Entry& entry : set->entries) reset.set.push_back(read_assignment(entry, what));
}

Assignment EventsReader::read_assignment(const Entry& entry, const std::string& what) {
  Assignment result;
  result.span = entry.span;
  std::optional<Dimension> dimension;
  const Derivative derivative = split_derivative(entry.key);
  const Symbol* symbol = scope_.find(entry.key);
  const Symbol* base = scope_.find(derivative.base);
  if (symbol != nullptr && symbol->kind == SymbolKind::state) {
    result.index = symbol->index;
    dimension = model_.states[result.index].unit.dimension;
  } else if (base != nullptr && base->kind == SymbolKind::coordinate && derivative.order <= 1) {
    result.target = derivative.order == 0 ? Assignment::Target::coordinate : Assignment::Target::velocity;
    result.index = base->index;
    dimension = model_.coordinates[result.index].unit.dimension;
    if (dimension && derivative.order == 1) dimension = quotient(*dimension, dimension_of("s"));
  } else {
    std::vector<std::string> candidates = scope_.names(SymbolKind::state);
    for (const std::string& name : scope_.names(SymbolKind::coordinate))
      candidates.insert(candidates.end(), {name, name + "_dot"});
    const std::string hint = did_you_mean(entry.key, candidates);
    source_.fail(entry.span, fmt::format("'set' of {} names {}, which cannot be set", what, quote(entry.key)),
                 hint.empty() ? "the keys are coordinates q, their rates q_dot, states and discrete values" : hint);
  }
  const Context context{fmt::format("the new value of '{}'", entry.key), on_reset_variables, Shape::scalar, dimension,
                        "a new value is made of coordinates, velocities, states, discrete values, inputs, functions "
                        "of time, parameters and t, all before the change"};
  result.value = resolver_.value(entry.value, context).node;
  return result;
}

Noise EventsReader::read_noise(const Entry& entry, const std::string& what) {
  const std::string remedy = "write noise = { w = { normal = 1 } } with w in [discrete]; 1 is the seed";
  const Symbol* symbol = scope_.find(entry.key);
  if (symbol == nullptr || symbol->kind != SymbolKind::state || !model_.states[symbol->index].discrete)
    source_.fail(entry.span, fmt::format("'noise' of {} names {}, which is no discrete value", what, quote(entry.key)),
                 remedy);
  require_kind(Value::Kind::table, entry.value, fmt::format("the noise of '{}'", entry.key), remedy);
  check_keys(entry.value, {fmt::format("the noise of '{}'", entry.key), {"normal", "uniform"}});
  if (entry.value.entries.size() != 1)
    source_.fail(entry.value.span,
                 fmt::format("the noise of '{}' has {} distributions", entry.key, entry.value.entries.size()), remedy);
  const Entry& drawn = entry.value.entries[0];
  if (!drawn.value.is(Value::Kind::integer)) source_.fail(drawn.value.span, "the seed is not a whole number", remedy);
  const ExactNumber seed = parse_exact_number(drawn.value.text);
  if (!seed.problem.empty() || cln::minusp(seed.value) || seed.value > Rational(4294967295))
    source_.fail(drawn.value.span, "the seed is not between 0 and 4294967295", remedy);
  return {symbol->index, drawn.key == "normal" ? Noise::Distribution::normal : Noise::Distribution::uniform,
          static_cast<std::uint32_t>(cln::double_approx(seed.value))};
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
