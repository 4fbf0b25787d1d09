// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a model file section by section, each with its own class (section_reader.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <tuple>
#include <type_traits>

#include "model/content_hash.hpp"
#include "model/expand_contacts.hpp"
#include "model/model.hpp"
#include "model/read_bodies.hpp"
#include "model/read_constraints.hpp"
#include "model/read_draw.hpp"
#include "model/read_events.hpp"
#include "model/read_forces.hpp"
#include "model/read_joints.hpp"
#include "model/read_names.hpp"
#include "model/read_places.hpp"
#include "model/read_scenes.hpp"
#include "model/read_states.hpp"
#include "model/units.hpp"

namespace eomgen::model {
namespace {

// integral(e) starts at the start of the run, which depends on the scene. An internal parameter holds the start time,
// so that later stages and callers of emitted code treat it like any other parameter.

std::string free_name(const Model& model, std::string name) {
  const auto taken = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  };
  while (taken(model.parameters) || taken(model.functions) || taken(model.inputs) || taken(model.coordinates) ||
         taken(model.definitions) || taken(model.places) || taken(model.frames) || taken(model.constraints) ||
         taken(model.forces) || taken(model.events) || taken(model.states)) {
    name += '_';
  }
  return name;
}

/// Names the parameters that represent initial(q).
void name_start_values(Model& model) {
  for (Parameter& p : model.parameters) {
    if (!p.initial_value_of) continue;
    const Coordinate& q = model.coordinates[*p.initial_value_of];
    std::string name;
    std::swap(name, p.name);  // its own name must not count as taken
    p.name = free_name(model, name);
    p.unit = q.unit;
    p.note = "start value of " + q.name;
    if (!q.tex.empty()) p.tex = "{" + q.tex + "}^{0}";
  }
}

/// Names the integrals integral_1, .. Underscores are appended until the names are unique.
void name_integrals(Model& model) {
  std::size_t number = 0;
  for (State& state : model.states) {
    if (state.integral || state.name.empty()) state.name = free_name(model, "integral_" + std::to_string(++number));
  }
}

/// If the model has integrals of functions of time: appends the parameter `t_start` and sets its value in every scene.
/// Underscores are appended to its name until it is unique.
void add_start_time(Model& model, bool units_stated) {
  const auto first =
      std::find_if(model.states.begin(), model.states.end(), [](const State& state) { return state.integral; });
  if (first == model.states.end()) return;
  Parameter start;
  start.name = free_name(model, "t_start");
  start.value = model.scenes.front().t0;
  if (units_stated) start.unit = unit_of(dimension_of("s"));
  start.tex = "t_{0}";
  start.note = "start of the run, from which integrals count";
  start.span = first->span;
  start.used = true;
  const auto index = static_cast<std::uint32_t>(model.parameters.size());
  model.parameters.push_back(std::move(start));
  model.start_time = index;
  for (Scene& scene : model.scenes) scene.parameters.emplace_back(index, scene.t0);
}

// Names are resolved in the order of their dependencies. The order that users see (the array p, columns, tables) is the
// order of declaration.

// Items that the program added come last.
template <class T>
bool is_made_up(const T& item) {
  if constexpr (std::is_same_v<T, Parameter>) return item.initial_value_of.has_value();
  return false;
}

// Sorts by position in the file. Returns the new index of each old one.
template <class T>
std::vector<std::uint32_t> sort_by_place(std::vector<T>& items) {
  std::vector<std::uint32_t> order(items.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t i) {
    return std::tuple(is_made_up(items[i]), items[i].span.line, items[i].span.column);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  std::vector<std::uint32_t> moved(items.size());
  std::vector<T> sorted;
  for (std::uint32_t k = 0; k < order.size(); ++k) {
    moved[order[k]] = k;
    sorted.push_back(std::move(items[order[k]]));
  }
  items = std::move(sorted);
  return moved;
}

// The layout of states: declared ones, integrals of the motion, integrals of functions of time, discrete values.
// Integrals are found while expressions are read, behind discrete values.
void sort_states(Model& model) {
  std::vector<State> sorted;
  std::vector<std::uint32_t> moved(model.states.size());
  const auto rank = [](const State& state) { return state.discrete ? 2 : state.integral ? 1 : 0; };
  for (const int wanted : {0, 1, 2}) {
    for (std::uint32_t k = 0; k < model.states.size(); ++k) {
      if (rank(model.states[k]) != wanted) continue;
      moved[k] = static_cast<std::uint32_t>(sorted.size());
      sorted.push_back(model.states[k]);
    }
  }
  model.states = std::move(sorted);
  for (Node& node : model.arena.nodes) {
    if (node.op == Op::state || node.op == Op::integral) node.index = moved[node.index];
  }
  for (Scene& scene : model.scenes) {
    for (InitialState& initial : scene.states) initial.state = moved[initial.state];
  }
  const auto move = [&](Reset& reset) {
    for (Assignment& assignment : reset.set) {
      if (assignment.target == Assignment::Target::state) assignment.index = moved[assignment.index];
    }
  };
  for (Event& event : model.events) move(event.reset);
  for (Sample& sample : model.samples) {
    move(sample.reset);
    for (Noise& noise : sample.noise) noise.state = moved[noise.state];
  }
}

/// Sorts parameters, functions and definitions into the order of the file, and renumbers them in expressions and
/// scenes.
void restore_declared_order(Model& model) {
  const std::vector<std::uint32_t> parameters = sort_by_place(model.parameters);
  const std::vector<std::uint32_t> functions = sort_by_place(model.functions);
  const std::vector<std::uint32_t> definitions = sort_by_place(model.definitions);
  for (Node& node : model.arena.nodes) {
    if (node.op == Op::parameter) node.index = parameters[node.index];
    if (node.op == Op::function) node.index = functions[node.index];
    if (node.op == Op::definition) node.index = definitions[node.index];
  }
  for (Scene& scene : model.scenes) {
    for (auto& override_value : scene.parameters) override_value.first = parameters[override_value.first];
  }
  sort_states(model);
}

// Whether the model states any unit. Without units nothing is checked: the metres and radians of coordinates have no
// effect. `section` is that of a value in it, empty for the whole file; `is_unit`: a text is a unit.
bool states_units(const Value& value, std::string_view section, bool is_unit) {
  if (value.is(Value::Kind::text)) {
    // Angles are numbers: their units do not imply that other quantities have units.
    const auto says = [](const std::optional<MeasuredUnit>& unit) { return unit && !is_one(unit->dimension); };
    if (is_unit) {
      const std::optional<MeasuredUnit> unit = parse_unit(value.text);
      return !unit || says(unit);
    }
    for (std::size_t open = 0; (open = value.text.find('[', open)) != std::string::npos; ++open) {
      const std::size_t close = value.text.find(']', open);
      if (close == std::string::npos) return true;  // rejected later
      const std::optional<MeasuredUnit> unit = parse_unit(value.text.substr(open + 1, close - open - 1));
      if (!unit || says(unit)) return true;
    }
    return says(trailing_unit(value.text));
  }
  const auto words = [](std::string_view name) {
    return name == "title" || name == "notes" || name == "note" || name == "tex" || name == "name" || name == "scene";
  };
  return std::any_of(value.items.begin(), value.items.end(),
                     [&](const Value& item) { return states_units(item, section, false); }) ||
         std::any_of(value.entries.begin(), value.entries.end(), [&](const Entry& entry) {
           if (value.find("csv") != nullptr && entry.key != "unit") return false;  // names of files and columns
           const bool unit = entry.key == "unit" || section == "coordinates";      // x = "m"
           return !words(entry.key) && states_units(entry.value, section.empty() ? entry.key : "inside", unit);
         });
}

class Reader : private SectionReader {
 public:
  explicit Reader(ReaderContext& context) : SectionReader(context) {
    context.define = [&context](Symbol& symbol) { return NamesReader(context).define(symbol); };
  }
  // Declares every name of the file, then resolves expressions. Names are resolved on demand, so that the order of the
  // file does not matter.
  void read() {
    read_head();
    NamesReader(context_).declare();
    StatesReader(context_).declare();
    PlacesReader(context_).declare();
    ConstraintsReader(context_).declare();
    JointsReader(context_).declare();
    BodiesReader(context_).declare_units();
    ForcesReader(context_).declare();
    EventsReader(context_).declare();
    StatesReader(context_).declare_discrete();
    PlacesReader(context_).declare_coordinates();

    for (const SymbolKind kind : {SymbolKind::parameter, SymbolKind::function, SymbolKind::input}) {
      for (Symbol* symbol : scope_.all(kind)) resolver_.symbol(*symbol, symbol->span);
    }
    NamesReader(context_).read_ranges();
    PlacesReader(context_).read_particles();
    BodiesReader(context_).read();
    for (Symbol* symbol : scope_.all(SymbolKind::definition)) resolver_.symbol(*symbol, symbol->span);
    ConstraintsReader(context_).read_energy(NamesReader(context_).armature_energy());
    ForcesReader(context_).read();
    ConstraintsReader(context_).read();
    ConstraintsReader(context_).read_impacts();
    BodiesReader(context_).read_units();
    StatesReader(context_).read();
    EventsReader(context_).read();
    DrawReader(context_).read();
    if (model_.particles.empty() && model_.bodies.empty() && model_.energy.kinetic == no_node) {
      source_.fail(root_.span, "nothing moves: the model has no particle, no body and no kinetic energy",
                   "add a [[particle]] or [[body]], or kinetic = \"..\" in [energy]");
    }
    if (model_.coordinates.empty()) {
      source_.fail(root_.span, "nothing moves: the model has no coordinate",
                   "name coordinates in a position or in [coordinates]");
    }
    ScenesReader(context_).refuse_shadowed_outputs();
    ScenesReader(context_).read();
    JointsReader(context_).read();
    NamesReader(context_).warn_unused();
  }

 private:
  void read_head() {
    check_keys(root_,
               {"a model", {"format",      "title",      "notes",    "parameters", "functions", "inputs", "coordinates",
                            "definitions", "energy",     "particle", "body",       "frame",     "point",  "chain",
                            "force",       "constraint", "contact",  "joint",      "event",     "state",  "discrete",
                            "sample",      "draw",       "scene",    "impacts"}});
    const Value& format = require_value(root_, "format", "the model", "add format = 1 at the top");
    if (!format.is(Value::Kind::integer) || format.text != "1") {
      source_.fail(format.span, fmt::format("the format {} is not known", quote(format.text)), "write format = 1");
    }
    for (const char* key : {"title", "notes"}) {
      if (root_.find(key) != nullptr)
        (key[0] == 't' ? model_.title : model_.notes) = text_of_key(root_, key, "the model");
    }
    resolver_.set_units_stated(states_units(root_, "", false));
    Place origin;
    origin.name = "origin";
    origin.position = resolver_
                          .check_context(resolver_.number(0, Span{}), Span{},
                                         Context{"the origin", 0, Shape::vector, std::nullopt, ""})
                          .node;
    model_.places.push_back(std::move(origin));
    place_sources_.emplace_back();
    model_.frames.emplace_back();
    model_.frames.back().name = "ground";
    frame_sources_.emplace_back().keeps_attitude = true;
  }
};

}  // namespace

Model read_model_text(const std::string& text, const std::string& file, const std::string& folder) {
  const Source source(file, text);
  Value root = read_document(source);
  std::vector<Value> lengths = expand_contacts(source, root);
  ReaderContext context(source, root);
  context.contact_lengths = std::move(lengths);
  context.folder = folder;
  Reader(context).read();
  Model& model = context.model;
  restore_declared_order(model);
  name_start_values(model);
  name_integrals(model);
  add_start_time(model, context.resolver.units_stated());
  model.file = file;
  model.id = std::filesystem::path(file).stem().string();
  model.lines = source.lines();
  model.content_hash = content_hash(text);
  model.folder = folder;
  for (const std::string& hash : context.data_hashes) model.content_hash = content_hash(model.content_hash + hash);
  return std::move(model);
}

Model read_model(const std::string& path) {
  const auto fail = [&](const std::string& what, const std::string& remedy) -> void {
    throw Error("model", SourceLocation{path, 0, 0, 1, ""}, what, remedy);
  };
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (!std::filesystem::exists(status)) fail("there is no such file", "check the path; models are .toml files");
  if (std::filesystem::is_directory(status))
    fail("this is a directory", "name a model file, such as models/cart_pendulum.toml");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("the file cannot be read", "check its permissions");
  std::string text(max_file_bytes + 1, '\0');  // one byte more than allowed, to detect a file that is too large
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) fail("the file cannot be read", "check the file");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > max_file_bytes)
    fail(fmt::format("the file has more than {} bytes", max_file_bytes), "check that this is a model file");
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return read_model_text(text, path, folder.empty() ? "." : folder);
}

const Argument* Force::argument(std::string_view key) const {
  const auto found = std::find_if(arguments.begin(), arguments.end(), [&](const Argument& a) { return a.name == key; });
  return found == arguments.end() ? nullptr : &*found;
}

NodeId Force::value(std::string_view key) const {
  const Argument* found = argument(key);
  return found == nullptr ? no_node : found->value;
}

SourceLocation Model::where(const Span& span) const { return locate(file, lines, span); }

const Scene& Model::scene(const std::string& name) const {
  std::vector<std::string> names;
  for (const Scene& candidate : scenes) {
    if (candidate.name == name) return candidate;
    names.push_back(candidate.name);
  }
  const std::string hint = did_you_mean(name, names);
  throw Error("model", SourceLocation{file, 0, 0, 1, ""}, fmt::format("there is no scene {}", quote(name)),
              hint.empty() ? fmt::format("the scenes are {}", fmt::join(names, ", ")) : hint);
}

}  // namespace eomgen::model
