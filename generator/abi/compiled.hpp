// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the table (functions.hpp) as function pointers: their types, and calls by name.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "abi/functions.hpp"

namespace eomgen::abi {

/// The arguments of a compiled function. A function reads only those that it takes.
struct CallArguments {
  double t = 0;
  const double *x = nullptr, *p = nullptr, *w = nullptr, *u = nullptr, *v = nullptr;
  const int *mode = nullptr, *to = nullptr;
  int order = 0;
  std::array<double*, 3> results{};
};

constexpr std::size_t count(std::initializer_list<Result> results) { return results.size(); }

template <Input input>
constexpr auto argument(const CallArguments& given) {
  if constexpr (input == Input::time)
    return given.t;
  else if constexpr (input == Input::state)
    return given.x;
  else if constexpr (input == Input::parameters)
    return given.p;
  else if constexpr (input == Input::prepared)
    return given.w;
  else if constexpr (input == Input::inputs)
    return given.u;
  else if constexpr (input == Input::mode)
    return given.mode;
  else if constexpr (input == Input::order)
    return given.order;
  else if constexpr (input == Input::to)
    return given.to;
  else
    return given.v;
}

template <Input... inputs>
struct Signature {
  template <std::size_t... result>
  static int call(auto function, const CallArguments& given, std::index_sequence<result...>) {
    return function(argument<inputs>(given)..., given.results[result]...);
  }
  template <std::size_t... result>
  static auto pointer(std::index_sequence<result...>)
      -> int (*)(decltype(argument<inputs>(CallArguments{}))...,
                 decltype(std::get<result>(CallArguments{}.results) + 0)...);
};

/// The pointer type of a function with these inputs and this number of result arrays.
template <class Inputs, std::size_t results>
using FunctionPointer = decltype(Inputs::pointer(std::make_index_sequence<results>{}));

/// Pointers to all functions of the table; null if the code lacks a function.
struct CompiledFunctions {
#define INPUTS(...) Signature<__VA_ARGS__>
#define RESULTS(...) count({__VA_ARGS__})
#define ABI_FUNCTION(name, signature, result_count, comes, purpose) \
  FunctionPointer<signature, result_count> name = nullptr;
  using enum Input;
#include "abi/functions.inc"
#undef ABI_FUNCTION

  /// Calls visit(name, pointer) for each function, with a reference to the pointer.
  template <class Visit>
  void each(Visit&& visit) {
#define ABI_FUNCTION(name, signature, result_count, comes, purpose) visit(#name, name);
#include "abi/functions.inc"
#undef ABI_FUNCTION
  }

  bool has(std::string_view function) const {
#define ABI_FUNCTION(name, signature, result_count, comes, purpose) \
  if (function == #name) return name != nullptr;
#include "abi/functions.inc"
#undef ABI_FUNCTION
    return false;
  }

  /// Calls the function of this name, which must not be null, and returns its code.
  int call(std::string_view function, const CallArguments& given) const {
#define ABI_FUNCTION(name, signature, result_count, comes, purpose) \
  if (function == #name) return signature::call(name, given, std::make_index_sequence<result_count>{});
#include "abi/functions.inc"
#undef ABI_FUNCTION
    return -1;
  }
#undef RESULTS
#undef INPUTS
};

}  // namespace eomgen::abi
