// SPDX-License-Identifier: GPL-3.0-or-later
// [scene.NAME]: inheritance, time span, initial values, adjustable values, solver.
#include "model/read_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <optional>
#include <set>
#include <vector>

#include "model/read_bodies.hpp"
#include "model/read_events.hpp"
#include "model/read_states.hpp"

namespace eomgen::model {
namespace {

constexpr std::array<std::string_view, 5> merging{"initial", "guess", "parameters", "inputs", "from"};

Context plain(std::string what, std::string_view unit) {
  return Context{std::move(what), 0, Shape::scalar, dimension_of(unit), ""};
}

/// The coordinate q of an initial(q) in an expression, whose value the start determines.
std::optional<std::uint32_t> start_in(const Model& model, NodeId root) {
  std::vector<NodeId> left{root};
  std::set<NodeId> seen;
  while (!left.empty()) {
    const NodeId id = left.back();
    left.pop_back();
    if (id == no_node || !seen.insert(id).second) continue;
    const Node& node = model.arena[id];
    if (node.op == Op::parameter) {
      if (const auto& of = model.parameters[node.index].initial_value_of) return of;
    } else if (node.op == Op::definition) {
      left.push_back(model.definitions[node.index].expression);
    } else if (node.op == Op::function) {
      left.push_back(model.functions[node.index].expression);
    }
    left.insert(left.end(), std::begin(node.args), std::end(node.args));
  }
  return std::nullopt;
}

}  // namespace

void ScenesReader::read() {
  const Value* table = section("scene");
  if (table != nullptr && table->entries.size() > max_scenes) {
    source_.fail(table->entries[max_scenes].span, fmt::format("the model has more than {} scenes", max_scenes),
                 "put further scenes into another file");
  }
  if (table != nullptr && table->find("default") == nullptr) {
    for (const Entry& entry : table->entries) {
      std::string lowered = entry.key;
      std::transform(lowered.begin(), lowered.end(), lowered.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (edit_distance(lowered, "default", 1) > 1) continue;
      source_.fail(entry.span, fmt::format("there is no scene 'default', but {} has a similar name", quote(entry.key)),
                   "write [scene.default], or add one: it is the scene that runs where none is named");
    }
  }
  if (table == nullptr || table->find("default") == nullptr) {
    Scene scene;
    scene.name = "default";
    scene.t0 = resolver_.number(0, Span{}).node;
    scene.t1 = resolver_.number(10, Span{}).node;
    BodiesReader(context_).complete_parameters(scene);
    model_.scenes.push_back(std::move(scene));
  } else {
    read_scene(*table->entry("default"));
  }
  if (table == nullptr) return;
  for (const Entry& entry : table->entries) {
    if (entry.key != "default") read_scene(entry);
  }
}

// The entries of a scene including those inherited by `from`: tables merge key by key, other keys replace.
std::vector<const Entry*> ScenesReader::merged(const Entry& scene, std::vector<std::string>& from) const {
  const std::string what = fmt::format("[scene.{}]", scene.key);
  require_kind(Value::Kind::table, scene.value, what, "write [scene.NAME] and its keys below");
  check_keys(scene.value, {what,
                           {"from", "t", "initial", "solve", "guess", "parameters", "inputs", "outputs", "solver",
                            "rtol", "atol", "step", "every", "stop"}});
  if (std::find(from.begin(), from.end(), scene.key) != from.end()) {
    source_.fail(
        scene.value.find("from")->span,
        fmt::format("the scene '{}' starts from itself: {} -> {}", scene.key, fmt::join(from, " -> "), scene.key),
        "break the circle of 'from'");
  }
  from.push_back(scene.key);
  std::vector<const Entry*> result;
  if (const Value* base = scene.value.find("from")) {
    require_kind(Value::Kind::text, *base, "'from'", "write from = \"default\"");
    const Entry* other = section("scene")->entry(base->text);
    if (other == nullptr) {
      std::vector<std::string> names;
      for (const Entry& entry : section("scene")->entries) names.push_back(entry.key);
      const std::string hint = did_you_mean(base->text, names);
      source_.fail(base->span, fmt::format("there is no scene {}", quote(base->text)),
                   hint.empty() ? "name a [scene.NAME] of this file" : hint);
    }
    result = merged(*other, from);
  }
  for (const Entry& entry : scene.value.entries) {
    const bool merges = std::find(merging.begin(), merging.end(), entry.key) != merging.end();
    if (!merges) std::erase_if(result, [&](const Entry* old) { return old->key == entry.key; });
    result.push_back(&entry);
  }
  return result;
}

namespace {

// Merges the tables of one key, earlier scenes first; a later value replaces an earlier one at its position.
std::vector<const Entry*> merged_table(const std::vector<const Entry*>& scene, std::string_view key) {
  std::vector<const Entry*> result;
  std::map<std::string_view, std::size_t> at;
  for (const Entry* table : scene) {
    if (table->key != key) continue;
    for (const Entry& entry : table->value.entries) {
      const auto [known, added] = at.emplace(entry.key, result.size());
      if (added) {
        result.push_back(&entry);
      } else {
        result[known->second] = &entry;
      }
    }
  }
  return result;
}

}  // namespace

void ScenesReader::read_scene(const Entry& entry) {
  if (!is_identifier(entry.key) || entry.key.size() > max_name_length) {
    source_.fail(entry.span, fmt::format("{} cannot be the name of a scene", quote(entry.key)),
                 "use letters, digits and underscores");
  }
  std::vector<std::string> from;
  const std::vector<const Entry*> entries = merged(entry, from);
  Scene scene;
  scene.name = entry.key;
  scene.span = entry.span;
  scene.t0 = resolver_.number(0, entry.span).node;
  scene.t1 = resolver_.number(10, entry.span).node;
  for (const Entry* item : entries) {
    const Value& value = item->value;
    const std::string& key = item->key;
    if (std::find(merging.begin(), merging.end(), key) != merging.end()) {
      if (key != "from")
        require_kind(Value::Kind::table, value, fmt::format("'{}'", key),
                     fmt::format("write {} = {{ name = value }}", key));
    } else if (key == "t") {
      read_span(scene, value);
    } else if (key == "solve") {
      read_solve(scene, value);
    } else if (key == "outputs") {
      read_outputs(scene, value);
    } else if (key == "solver") {
      read_solver(scene, value);
    } else if (key == "stop") {
      EventsReader(context_).read_stop(scene, value);
    } else {
      const bool time = key == "step" || key == "every";
      const NodeId node = positive_number(value, fmt::format("'{}'", key), time ? "s" : "1");
      (key == "rtol" ? scene.rtol : key == "atol" ? scene.atol : key == "step" ? scene.step : scene.every) = node;
    }
  }
  read_scene_parameters(scene, merged_table(entries, "parameters"));
  read_scene_inputs(scene, merged_table(entries, "inputs"));
  read_initial(scene, merged_table(entries, "initial"), false);
  read_initial(scene, merged_table(entries, "guess"), true);
  BodiesReader(context_).complete_parameters(scene);
  BodiesReader(context_).check_initial_angular_velocities(scene);
  model_.scenes.push_back(std::move(scene));
}

void ScenesReader::read_span(Scene& scene, const Value& value) {
  const std::string remedy = "write t = [0, 10]: start and end in seconds";
  require_kind(Value::Kind::array, value, "'t'", remedy);
  if (value.items.size() != 2) source_.fail(value.span, fmt::format("'t' has {} entries", value.items.size()), remedy);
  const TypedNode t0 = resolver_.value(value.items[0], plain("the start of the run", "s"));
  const TypedNode t1 = resolver_.value(value.items[1], plain("the end of the run", "s"));
  if (t0.constant && t1.constant && *t0.constant >= *t1.constant)
    source_.fail(value.span, "the run ends before it starts", remedy);
  scene.t0 = t0.node;
  scene.t1 = t1.node;
}

NodeId ScenesReader::positive_number(const Value& value, const std::string& what, std::string_view unit) {
  if (value.is(Value::Kind::array))
    source_.fail(value.span, fmt::format("{} has {} values", what, value.items.size()),
                 "write one, which holds for all");
  const TypedNode typed = resolver_.value(value, plain(what, unit == "1" ? "1" : unit));
  if (typed.constant && !cln::plusp(*typed.constant))
    resolver_.refuse_value(typed, value.span, what, "is not positive", "write a number greater than 0");
  return typed.node;
}

Symbol& ScenesReader::coordinate_of_key(const Entry& entry, const std::string& what, std::uint8_t& order) {
  const Derivative derivative = split_derivative(entry.key);
  Symbol* symbol = scope_.find(derivative.base);
  order = derivative.order;
  if (symbol != nullptr && symbol->kind == SymbolKind::coordinate && order <= 1) return *symbol;
  std::vector<std::string> candidates;
  for (const std::string& name : scope_.names(SymbolKind::coordinate))
    candidates.insert(candidates.end(), {name, name + "_dot"});
  for (const std::string& name : scope_.names(SymbolKind::state)) candidates.push_back(name);
  const std::string hint = did_you_mean(entry.key, candidates);
  if (symbol != nullptr && symbol->kind == SymbolKind::coordinate) {
    source_.fail(entry.span, fmt::format("{} is an acceleration, which {} cannot state", quote(entry.key), what),
                 "accelerations follow from the equations");
  }
  source_.fail(entry.span, fmt::format("{} names {}, which is no coordinate or velocity", what, quote(entry.key)),
               hint.empty() ? "the keys are coordinates q, their rates q_dot, and states of first order" : hint);
}

void ScenesReader::read_initial(Scene& scene, const std::vector<const Entry*>& entries, bool guess) {
  const std::string what = guess ? "'guess'" : "'initial'";
  std::set<std::pair<std::uint32_t, std::uint8_t>> given;
  if (guess) {
    for (const InitialValue& known : scene.initial) given.insert({known.coordinate, known.order});
  }
  for (const Entry* entry : entries) {
    const auto require_known = [&](NodeId value) {
      const auto of = start_in(model_, value);
      if (!of) return;
      const std::string& q = model_.coordinates[*of].name;
      source_.fail(
          entry->value.span,
          fmt::format("the start value of '{}' uses initial({}), which is not known before the start", entry->key, q),
          fmt::format("write {}, and give its value before", q));
    };
    if (BodiesReader(context_).read_initial_angular_velocity(scene, *entry, guess)) {
      for (const NodeId component : scene.rotations.back().value) require_known(component);
      continue;
    }
    if (const Symbol* state = scope_.find(entry->key); state != nullptr && state->kind == SymbolKind::state) {
      if (guess) {
        source_.fail(entry->span,
                     fmt::format("'{}' is a state of first order, which no constraint determines", entry->key),
                     "give it in 'initial'");
      }
      StatesReader(context_).read_initial(scene, *entry, *state);
      continue;
    }
    InitialValue initial{};
    const Symbol& symbol = coordinate_of_key(*entry, what, initial.order);
    initial.coordinate = symbol.index;
    initial.span = entry->span;
    if (guess && given.count({initial.coordinate, initial.order}) > 0) {
      source_.fail(entry->span, fmt::format("'{}' is given in 'initial' and guessed too", entry->key),
                   "keep one of them");
    }
    Context context{
        fmt::format("the start value of '{}'", entry->key), on_time | on_coordinate | on_velocity, Shape::scalar,
        model_.coordinates[symbol.index].unit.dimension,
        "start values are made of numbers, parameters, functions at the start, definitions and values given before"};
    if (context.dimension && initial.order == 1) context.dimension = quotient(*context.dimension, dimension_of("s"));
    const TypedNode typed = resolver_.value(entry->value, context);
    initial.value = typed.node;
    require_known(initial.value);
    warn_of_degrees(*entry, typed, initial);
    for (const auto& used : resolver_.coordinates_in(initial.value)) {
      if (given.count(used) > 0) continue;
      source_.fail(entry->value.span,
                   fmt::format("the start value of '{}' uses '{}{}', which is not given before it", entry->key,
                               model_.coordinates[used.first].name,
                               used.second == 0   ? ""
                               : used.second == 1 ? "_dot"
                                                  : "_ddot"),
                   "give that value first, or write the number");
    }
    if (!guess) given.insert({initial.coordinate, initial.order});
    (guess ? scene.guess : scene.initial).push_back(initial);
  }
}

// Warns of a value like 45 for an angle in radians, which was probably meant in degrees or has surplus full turns.
void ScenesReader::warn_of_degrees(const Entry& entry, const TypedNode& typed, const InitialValue& initial) {
  const Rational turn = Rational(62832) / 10000;
  const bool angle = model_.coordinates[initial.coordinate].unit.text == "rad";
  if (!angle || initial.order != 0 || !typed.literal || !typed.constant || cln::abs(*typed.constant) <= turn) return;
  const std::string written = entry.value.text;
  resolver_.warn(entry.value.span, fmt::format("'{}' starts at {}: radians?", entry.key, written),
                 fmt::format("write \"{0} deg\" for degrees, \"{0} rad\" for radians", written));
}

void ScenesReader::read_solve(Scene& scene, const Value& value) {
  require_kind(Value::Kind::array, value, "'solve'", "write solve = [\"y_dot\"]");
  for (const Value& item : value.items) {
    require_kind(Value::Kind::text, item, "an entry of 'solve'", "write solve = [\"y_dot\"]");
    std::uint8_t order = 0;
    const Symbol& symbol = coordinate_of_key(Entry{item.text, item.span, {}}, "'solve'", order);
    const std::pair<std::uint32_t, std::uint8_t> wanted{symbol.index, order};
    if (std::find(scene.solve.begin(), scene.solve.end(), wanted) != scene.solve.end()) {
      source_.fail(item.span, fmt::format("'{}' is named twice in 'solve'", item.text), "name it once");
    }
    scene.solve.push_back(wanted);
  }
}

}  // namespace eomgen::model
