// SPDX-License-Identifier: GPL-3.0-or-later
// The model in the form in which a page integrates it: the optimised program in JavaScript, restricted to the functions
// that the page calls, with the data for initial states and changes of parameters. If the page cannot integrate the
// model, it replays the run, and the reason is given.
#pragma once

#include <eom/contacts/description.hpp>
#include <eom/hybrid/reset_types.hpp>
#include <eom/layout.hpp>
#include <eom/modes/contact_state.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/drawing/parts.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct LiveState {
  std::string name, unit;
  bool is_adjustable = true;  // has a slider; integrals over time are 0 at the start
};
struct LiveParameter {
  std::string name, unit, note;
  double value = 0;
  bool positive = false;
  bool is_adjustable = false;  // has a slider; dependent parameters have none
};
struct LiveEvent {
  std::string name;
  bool is_terminal = false;
  const char* direction = "";
  eom::hybrid::Reset reset = {};
};

/// A contact whose modes are tabulated. Indices are those of the function `contact_outputs`.
struct LiveContact {
  std::string name;
  eom::ContactShape shape;
  std::vector<std::size_t> slip, phi;  // per tangent
  std::vector<std::vector<std::size_t>> slopes;
  std::size_t constraint = 0;              // of a contact that can open
  std::optional<std::size_t> restitution;  // of a contact that can open
};

/// Initial data of the page's integrator.
struct LiveStart {
  eom::StateLayout layout;
  std::vector<LiveState> states;                            // of the whole layout
  std::vector<double> lower, upper;                         // n bounds of the coordinates; infinite: no bound
  std::vector<std::pair<std::size_t, double>> set;          // (state, initial value) that the command line sets
  std::vector<LiveParameter> parameters;                    // all
  std::vector<std::pair<std::size_t, std::size_t>> starts;  // (parameter, coordinate whose initial value it is)
  std::size_t inputs = 0;
  std::vector<LiveEvent> events;
  std::vector<eom::hybrid::Sample> samples;  // the page computes their periods from its parameters
  std::vector<LiveContact> contacts;
  std::size_t contact_outputs = 0, mode_size = 0;
  eom::contacts::Set contact_set;  // contacts whose forces are inputs; their places are in `info` of the script
  std::size_t constraints = 0, event_functions = 0, reset_values = 0, sizes = 0;
};

struct LiveModel {
  std::string script;  // of the target javascript; its last statement has no side effects; empty: the page replays
  std::string name;    // of the constant that the script defines
  std::string reason;  // a sentence: why the page replays the run
  LiveStart start;

  bool has_contacts() const { return !start.contacts.empty() || !start.contact_set.empty(); }
};

/// `sizes`: expressions in parameters. `outputs`: names in the order of the array that the page draws and plots from.
/// `set`: parameters and initial values that the command line set to numbers.
LiveModel live_model(const pipeline::Simulation& simulation, const std::vector<symbolic::Ref>& sizes,
                     const std::vector<std::string>& outputs, const std::set<std::string>& set);

}  // namespace eomgen::analysis
