// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/declared_order.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <type_traits>

namespace eomgen::model {
namespace {

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

}  // namespace

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

}  // namespace eomgen::model
