// SPDX-License-Identifier: GPL-3.0-or-later
// What emitted code says about its model beside the Program: names, units, values. Plain data that the caller fills,
// so that emission needs neither the reader nor the derivation.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace eom::hybrid {
struct Problem;
}

namespace eomgen::emit {

struct Quantity {
  std::string name;
  std::string unit;             // "m/s^2", "1"; empty where unknown
  std::string note;             // of the user's
  double value = 0;             // parameters and inputs: the default
  std::string expression = {};  // of a parameter that depends on others, in the language of model files
};

/// What a function of the ABI gives at a test vector: its arrays, and for each how far rounding may take it.
struct FunctionValues {
  std::string function;
  int to = 0;  // of `chart`
  std::vector<std::vector<double>> values;
  std::vector<double> tolerances;
};

/// A state for the self test (self_test.hpp).
struct TestVector {
  double t = 0;
  int mode = 0;
  std::vector<double> x, p, u;
  std::vector<FunctionValues> functions;  // rhs first
};

struct EventText {
  std::string name, direction, action;
};

/// What a program needs to run the model as `run` does: the default scene, whose code is described, and the places
/// among the outputs of the columns of its table.
struct RunText {
  std::shared_ptr<const eom::hybrid::Problem> problem;
  std::vector<std::size_t> columns;
  std::vector<std::uint32_t> beyond_range = {};  // coordinates of the model that may leave their range
};

struct EmissionContext {
  std::string id;  // of the model; becomes NAME
  std::string title;
  std::string content_hash;
  std::string verdict;                // one line, of verify: "pass: 20 points, 50 digits"
  std::vector<Quantity> coordinates;  // all of the model, in declared order; those not in Program::free are eliminated
  std::vector<Quantity> parameters;   // all of the model, in declared order: the array p
  std::vector<Quantity> inputs;       // the array u
  std::vector<Quantity> integrals;    // all of the model; those in Program::integrals are states after the velocities
  std::string start_parameter;        // name of the parameter that holds the start of the run; empty: there is none
  std::vector<EventText> events;      // all of the model, in declared order
  std::vector<std::string> singular;  // "sin(phi) = 0"
  double start_time = 0;
  std::vector<double> start;  // x at the start of the default scene
  std::vector<TestVector> tests;
  std::shared_ptr<const RunText> run = {};  // where it was asked for
  std::optional<double> single_error = {};  // of single precision, where that was asked for (single_precision.hpp)
};

/// NAME of the C ABI: the model's id as an identifier that no target reserves.
std::string mangled_id(const std::string& id);
/// Of the Python target: NAME, or NAME_ where Python or its standard library has that name.
std::string module_name(const std::string& id);
/// Of the target javascript: NAME, or NAME_ where JavaScript or a browser has that name.
std::string script_name(const std::string& id);

}  // namespace eomgen::emit
