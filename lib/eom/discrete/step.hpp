// SPDX-License-Identifier: MIT
// One step of a method as a function x1 = step(t, h, x, p, u), with its derivatives by all arguments: for optimal
// control, shooting, estimation. In: the name of a method, functions of a model (functions.hpp). Out: x1 and
// derivatives. A method is one file with its class and its entry in Methods.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "eom/discrete/explicit_rk.hpp"
#include "eom/discrete/functions.hpp"
#include "eom/discrete/midpoint.hpp"
#include "eom/discrete/variational.hpp"
#include "eom/explicit_rk/dop853.hpp"
#include "eom/explicit_rk/dopri5.hpp"
#include "eom/explicit_rk/rk4.hpp"
#include "eom/explicit_rk/tsit5.hpp"

namespace eom::discrete {

// clang-format off
using Methods = std::variant<
    ExplicitRk<explicit_rk::Rk4>,
    ExplicitRk<explicit_rk::Dopri5>,
    ExplicitRk<explicit_rk::Tsit5>,
    ExplicitRk<explicit_rk::Dop853>,
    Midpoint,
    Variational>;
// clang-format on

namespace detail {

template <class... M>
constexpr std::array<const char*, sizeof...(M)> names_of(std::type_identity<std::variant<M...>>) {
  return {M::name...};
}

}  // namespace detail

/// The names of the methods, in order.
inline constexpr std::array<const char*, std::variant_size_v<Methods>> method_names =
    detail::names_of(std::type_identity<Methods>{});

/// A step of a method, with its work space. A call depends on its arguments only, and allocates nothing. One thread at
/// a time may use an object.
class Step {
 public:
  /// Throws std::invalid_argument for an unknown method, and for states that the method cannot have.
  Step(std::string_view method, const Sizes& sizes) : method_(make(method, sizes)) {}

  /// x1: N, may be x. Returns 0, a code of docs/abi.md, or code_no_convergence (outcome.hpp).
  template <class F>
  int operator()(const F& functions, const Arguments& at, double* x1) {
    return std::visit([&](auto& method) { return method.step(functions, at, x1); }, method_);
  }

  /// The same, and the derivatives of x1. x1 must not be x. Returns code_no_function if a derivative needs a function
  /// that the model lacks. For `midpoint` every call needs jac, for `variational2` momenta and momenta_jac.
  template <class F>
  int derivatives(const F& functions, const Arguments& at, double* x1, const Derivatives& to) {
    return std::visit([&](auto& method) { return method.derivatives(functions, at, x1, to); }, method_);
  }

 private:
  static Methods make(std::string_view method, const Sizes& sizes) {
    if (sizes.states == 0) throw std::invalid_argument("eom::discrete::Step: the state is empty");
    return make_from<0>(method, sizes);
  }
  template <std::size_t k>
  static Methods make_from(std::string_view method, const Sizes& sizes) {
    if constexpr (k < std::variant_size_v<Methods>) {
      if (method == method_names[k]) return Methods(std::in_place_index<k>, sizes);
      return make_from<k + 1>(method, sizes);
    } else {
      std::string known;
      for (const char* name : method_names) known += (known.empty() ? "" : ", ") + std::string(name);
      throw std::invalid_argument("eom::discrete::Step: no method is called '" + std::string(method) + "'; there are " +
                                  known);
    }
  }

  Methods method_;
};

}  // namespace eom::discrete
