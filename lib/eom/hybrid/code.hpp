// SPDX-License-Identifier: MIT
// The compiled model of a run: functions of the C ABI (docs/abi.md) and what they say of themselves. Data only; the
// functions are those of emitted code, or written by hand after the same conventions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "eom/modes/contacts.hpp"

namespace eom::hybrid {

/// Outputs that code in these charts does not give: they belong to the own ones.
struct OwnOutputs {
  int in_charts = 0;  // bits of mode
  std::vector<std::uint32_t> outputs;
};

/// n: coordinates that are state; N = 2 n + integrals: entries of x; m: active constraints. A null function was not
/// emitted. Of a run without constraints, events and contacts `rhs` and `outputs` are enough.
struct Code {
  int (*rhs)(double, const double*, const double*, const double*, int, double*) = nullptr;
  // The same in two, null where it is not split: what needs parameters only, and the rest.
  int (*prepare)(const double*, double*) = nullptr;
  int (*rhs_prepared)(double, const double*, const double*, const double*, const double*, int, double*) = nullptr;
  std::size_t prepared = 0;  // entries of what `prepare` writes
  int (*outputs)(double, const double*, const double*, const double*, int, double*) = nullptr;
  int (*events)(double, const double*, const double*, const double*, int, double*) = nullptr;
  // For implicit solvers; without it, and for df/dt along inputs that move, they take differences.
  int (*jac)(double, const double*, const double*, const double*, int, double*, double*) = nullptr;
  int (*mass)(double, const double*, const double*, double*, double*) = nullptr;
  int (*constraints)(double, const double*, const double*, double*, double*, double*) = nullptr;
  std::vector<std::string> output_names;  // entries of y: begins with every coordinate of the model and its _dot
  std::vector<std::uint32_t> free;        // coordinates that are state, with their rates
  std::size_t integrals = 0;              // states after them: 0 at the start, never projected
  std::size_t active_constraints = 0;
  std::vector<bool> holonomic = {};     // per active constraint: false where it binds velocities only
  std::vector<std::string> kinks = {};  // "abs", "max": their surfaces follow the model's events in g
  std::vector<Contact> contacts = {};   // after them, contact_values of each
  std::size_t first_kink_bit = 0;       // of mode: two for each kink, above and below its surface
  // For the solver taylor, up to its highest order.
  int (*taylor)(double, const double*, const double*, const double*, int, int, double*) = nullptr;
  int taylor_order = 0;
  // For variational solvers, with mass, and with constraints where there are any.
  int (*momenta)(double, const double*, const double*, const double*, int, double*, double*) = nullptr;
  // Of code that knows several charts.
  int (*chart)(const double*, int, int, double*) = nullptr;
  int (*mass_in)(double, const double*, const double*, int, double*, double*) = nullptr;
  int (*constraints_in)(double, const double*, const double*, int, double*, double*, double*) = nullptr;
  std::vector<OwnOutputs> own_outputs = {};
  // df/dp: for sensitivities.
  int (*jac_p)(double, const double*, const double*, const double*, int, double*) = nullptr;
};

}  // namespace eom::hybrid
