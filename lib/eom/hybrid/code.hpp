// SPDX-License-Identifier: MIT
// The compiled model of a run: functions of the C ABI (docs/abi.md) and their metadata. Data only. The functions are
// emitted, or written by hand with the same conventions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "eom/contacts/description.hpp"
#include "eom/layout.hpp"
#include "eom/modes/contact_state.hpp"

namespace eom::hybrid {

/// Outputs that code in these charts does not provide, because they belong to the own charts.
struct OwnOutputs {
  unsigned in_charts = 0;  // set of second charts
  std::vector<std::uint32_t> outputs;
};

/// n: number of free coordinates; N = 2 n + first_order + discrete: length of x; m: active constraints. A null function
/// was not emitted. A run without constraints, events and contacts needs only `rhs` and `outputs`.
struct Code {
  int (*rhs)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  // The right-hand side in two parts, null if it is not split: the part that depends on parameters only, and the rest.
  int (*prepare)(const double*, double*) = nullptr;
  int (*rhs_prepared)(double, const double*, const double*, const double*, const double*, const int*,
                      double*) = nullptr;
  std::size_t prepared = 0;  // number of values that `prepare` writes
  int (*outputs)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  int (*events)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  int (*resets)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  int (*contact_rows)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  // rhs and power without the forces of `contact_set`; null if not emitted.
  int (*rhs_open)(double, const double*, const double*, const double*, const int*, double*, double*) = nullptr;
  // What `outputs` writes for the power alone; null if not emitted.
  int (*power)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  std::size_t reset_values = 0;  // number of values that `resets` writes
  // For implicit solvers. They use differences if it is null, and for df/dt with inputs that vary in time.
  int (*jac)(double, const double*, const double*, const double*, const int*, double*, double*) = nullptr;
  int (*mass)(double, const double*, const double*, double*, double*) = nullptr;
  int (*constraints)(double, const double*, const double*, double*, double*, double*) = nullptr;
  std::vector<std::string> output_names;  // entries of y, beginning with every coordinate of the model and its _dot
  std::vector<std::uint32_t> free;        // coordinates in the state, each with its rate
  std::size_t first_order = 0;            // states of first order, after the rates: never projected
  std::size_t discrete = 0;               // discrete values, after them: their rate is 0, and only resets change them
  std::size_t active_constraints = 0;
  std::vector<bool> holonomic = {};     // per active constraint: false if it constrains velocities only
  std::vector<std::string> kinks = {};  // "abs", "max": their surfaces follow the model's events in g
  std::vector<Contact> contacts = {};   // after the kinks in g, contact_values of each
  contacts::Set contact_set = {};       // contacts whose forces are inputs; `contact_rows` writes their values
  // For the solver taylor, up to its highest order.
  int (*taylor)(double, const double*, const double*, const double*, const int*, int, double*) = nullptr;
  int taylor_order = 0;
  // For variational solvers, with `mass`, and with `constraints` if there are any.
  int (*momenta)(double, const double*, const double*, const double*, const int*, double*, double*) = nullptr;
  // For code with several charts.
  int (*chart)(const double*, const int*, const int*, double*) = nullptr;
  int (*mass_in)(double, const double*, const double*, const int*, double*, double*) = nullptr;
  int (*constraints_in)(double, const double*, const double*, const int*, double*, double*, double*) = nullptr;
  std::vector<OwnOutputs> own_outputs = {};
  // df/dp and df/du, for sensitivities.
  int (*jac_p)(double, const double*, const double*, const double*, const int*, double*) = nullptr;
  int (*jac_u)(double, const double*, const double*, const double*, const int*, double*) = nullptr;

  /// The layout of x.
  StateLayout layout() const { return {free.size(), first_order, discrete}; }
};

}  // namespace eom::hybrid
