// SPDX-License-Identifier: MIT
// Functions of the C ABI of emitted code in the forms that integrate() and integrate_modes() expect. In: pointers to
// NAME_rhs, NAME_events and NAME_jac, parameters, inputs. Out: callables. Nothing is copied, so the arrays must outlive
// them.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "eom/modes/contact_state.hpp"
#include "eom/with_jacobian.hpp"

namespace eom {

/// The argument `mode` of the ABI for the number of a mode of the contacts. Branches of kinks follow the state.
class ModeEntries {
 public:
  /// Throws std::invalid_argument if the number has no place among `size` entries.
  ModeEntries(int number, std::size_t size) : empty_(size == 0) {
    if (empty_ && number != 0) throw std::invalid_argument("eom::CompiledModel: mode_size is NAME_mode_size");
    if (size > near_.size()) far_.resize(size);
    int* const entries = far_.empty() ? near_.data() : far_.data();
    for (std::size_t j = 0; j < max_contacts && j < size; ++j) entries[j] = contact_digit(number, j);
  }
  /// Null without entries.
  const int* data() const { return empty_ ? nullptr : far_.empty() ? near_.data() : far_.data(); }

 private:
  std::array<int, 16> near_{};
  std::vector<int> far_;
  bool empty_;
};

/// The functions of one emitted model with its parameters and inputs.
struct CompiledModel {
  /// The type of NAME_rhs and NAME_events.
  using Function = int (*)(double t, const double* x, const double* p, const double* u, const int* mode,
                           double* result);

  /// The type of NAME_jac.
  using Derivatives = int (*)(double t, const double* x, const double* p, const double* u, const int* mode,
                              double* dfdx, double* dfdt);

  Function rhs_function = nullptr;
  Function events_function = nullptr;
  const double* p = nullptr;
  const double* u = nullptr;  // null: the defaults
  Derivatives jac_function = nullptr;
  std::size_t mode_size = 0;  // NAME_mode_size, of models with contacts

  /// The right-hand side and the event functions, with the number of a mode as an argument (contact_digit()).
  auto rhs() const {
    return [*this](double t, const double* x, int mode, double* dx) {
      return rhs_function(t, x, p, u, ModeEntries(mode, mode_size).data(), dx);
    };
  }
  /// The event functions, with the number of a mode as an argument.
  auto events() const {
    return [*this](double t, const double* x, int mode, double* g) {
      return events_function(t, x, p, u, ModeEntries(mode, mode_size).data(), g);
    };
  }
  /// The right-hand side with its derivatives NAME_jac for implicit methods. They use differences if it is null.
  auto rhs_and_jacobian() const {
    return WithJacobian{rhs(), [*this](double t, const double* x, int mode, double* dfdx, double* dfdt) {
                          return jac_function == nullptr
                                     ? no_jacobian_here
                                     : jac_function(t, x, p, u, ModeEntries(mode, mode_size).data(), dfdx, dfdt);
                        }};
  }
  /// The same for a fixed mode.
  auto rhs(int mode) const {
    return [*this, mode](double t, const double* x, double* dx) {
      return rhs_function(t, x, p, u, ModeEntries(mode, mode_size).data(), dx);
    };
  }
  /// The event functions in a fixed mode.
  auto events(int mode) const {
    return [*this, mode](double t, const double* x, double* g) {
      return events_function(t, x, p, u, ModeEntries(mode, mode_size).data(), g);
    };
  }
};

}  // namespace eom
