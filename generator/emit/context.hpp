// SPDX-License-Identifier: GPL-3.0-or-later
// What emitted code says about its model beside the Program: names, units, values. Plain data that the caller fills,
// so that emission needs neither the reader nor the derivation.
#pragma once

#include <string>
#include <vector>

namespace eomgen::emit {

struct Quantity {
  std::string name;
  std::string unit;  // "m/s^2", "1"; empty where unknown
  std::string note;  // of the user's
  double value = 0;  // parameters and inputs: the default
  std::string expression = {};  // of a parameter that depends on others, in the language of model files
};

/// A right-hand side in full precision, for the self test.
struct TestVector {
  double t = 0;
  int mode = 0;
  std::vector<double> x, p, u, dx;
};

struct EventText {
  std::string name, direction, action;
};

struct EmissionContext {
  std::string id;            // of the model; becomes NAME
  std::string title;
  std::string content_hash;
  std::string verdict;       // one line, of verify: "pass: 20 points, 50 digits"
  std::vector<Quantity> coordinates;  // all of the model, in declared order; those not in Program::free are eliminated
  std::vector<Quantity> parameters;   // all of the model, in declared order: the array p
  std::vector<Quantity> inputs;       // the array u
  std::vector<Quantity> integrals;    // all of the model; those in Program::integrals are states after the velocities
  std::string start_parameter;        // name of the parameter that holds the start of the run; empty: there is none
  std::vector<EventText> events;      // all of the model, in declared order
  std::vector<std::string> singular;  // "sin(phi) = 0"
  double start_time = 0;
  std::vector<double> start;          // x at the start of the default scene
  std::vector<TestVector> tests;
};

/// NAME of the C ABI: the model's id as an identifier that no target reserves.
std::string mangled_id(const std::string& id);
/// Of the Python target: NAME, or NAME_ where Python or its standard library has that name.
std::string module_name(const std::string& id);

}  // namespace eomgen::emit
