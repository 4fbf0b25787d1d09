// SPDX-License-Identifier: GPL-3.0-or-later
// Lists: the entry with a name, and the list of a function's values.
#pragma once

#include <functional>
#include <iterator>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

namespace eomgen {

/// The first entry of `list` whose member `name` is `name`; nullptr if there is none.
template <class List>
auto* find_named(List&& list, std::string_view name) {
  for (auto& entry : list) {
    if (entry.name == name) return &entry;
  }
  return static_cast<decltype(std::to_address(std::begin(list)))>(nullptr);
}

/// function(entry) for each entry of `list`, in its order; a member pointer is a function too. `T`: the type of the
/// values, if it is not that of the function's result.
template <class T = void, class List, class Function>
auto mapped(const List& list, const Function& function) {
  using Result = std::decay_t<std::invoke_result_t<const Function&, decltype(*std::begin(list))>>;
  std::vector<std::conditional_t<std::is_void_v<T>, Result, T>> values;
  values.reserve(std::size(list));
  for (const auto& entry : list) values.emplace_back(std::invoke(function, entry));
  return values;
}

}  // namespace eomgen
