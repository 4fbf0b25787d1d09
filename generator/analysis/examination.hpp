// SPDX-License-Identifier: GPL-3.0-or-later
// Structural analysis of a model: degrees of freedom, classes of constraints and forces, conserved quantities, singular
// sets. All of it is known before any integration.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "print/render.hpp"
#include "work.hpp"

namespace eomgen::analysis {

struct ExaminedCoordinate {
  std::string name, unit;
  bool eliminated = false;  // fixed by a constraint
};

/// A declared state of first order.
struct ExaminedState {
  std::string name, unit;
  std::string rate;             // a formula
  bool energy_counted = false;  // the model states the energy that it stores
};

struct ExaminedDiscrete {
  std::string name, unit;
};

/// Changes of the state at an event or a sample.
struct ExaminedReset {
  std::string name;
  std::string when;                                      // of an event: its function; of a sample: its period
  std::string condition;                                 // "" if there is none
  std::vector<std::pair<std::string, std::string>> set;  // names and formulas of new values
  bool sample = false;
};

struct ExaminedJoint {
  std::string name, type;
  std::array<std::string, 2> bodies;
  std::string axes;
  std::vector<std::string> reactions, undetermined;  // names of outputs
};

struct ExaminedContact {
  std::string name, kind, law;    // "surface", "curve", "coordinate"; "coulomb", "smooth", "none"
  std::vector<std::string> slip;  // outputs: tangential velocity along each tangent
  bool unilateral = false;
};

struct ExaminedConserved {
  std::string name, title;
  print::PrintedFormula expression;
  std::string certainty;                // "proven" or "numerical"
  std::vector<std::string> where_zero;  // parameters that must be 0 for it, as they are; usually none
};

struct ExaminedSet {
  print::PrintedFormula set;
  std::string approach;  // "I", "II", "both"
};

struct ExaminedChart {
  std::string of, own, second;
  std::vector<std::string> angles;
  std::string refusal;  // why no second chart is available; empty if one is
};

struct Examination {
  std::vector<ExaminedCoordinate> coordinates;
  long degrees_of_freedom = 0;
  std::vector<ExaminedState> states;
  std::vector<ExaminedDiscrete> discrete;
  std::vector<ExaminedReset> resets;
  std::vector<ExaminedQuantity> parameters, inputs;
  std::vector<ConstraintClass> constraints;
  std::vector<ExaminedJoint> joints;
  std::vector<ForceClass> forces;
  std::vector<ExaminedContact> contacts;
  std::vector<ExaminedConserved> conserved;
  std::vector<ExaminedSet> singular;
  std::vector<ExaminedChart> charts;
  bool has_all_units = false;  // all units are given and were checked
  std::vector<work::LeftOut> left_out;
  bool interrupted = false;  // the result is partial
};

/// Throws Error if the model has no equations of motion. On interruption: returns the partial result if `partial`,
/// otherwise throws work::Interrupted.
Examination examine(std::shared_ptr<const model::Model> model, bool partial = false);

}  // namespace eomgen::analysis
