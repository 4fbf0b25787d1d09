// SPDX-License-Identifier: GPL-3.0-or-later
// Data about the model for emitted code besides the Program: names, units, values. The caller fills this plain data, so
// that emission depends on neither the model reader nor the derivation.
#pragma once

#include <cstddef>
#include <eom/hybrid/reset_types.hpp>
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
  std::string note;             // note of the user
  double value = 0;             // default of parameters and inputs
  std::string expression = {};  // of a dependent parameter, in the language of model files
};

/// The result arrays of a function of the ABI at a test vector, each with a bound of its rounding error.
struct FunctionValues {
  std::string function;
  unsigned to = 0;  // of `chart`: the set of second charts
  std::vector<std::vector<double>> values;
  std::vector<double> tolerances;
};

/// A state for the self test (self_test.hpp).
struct TestVector {
  double t = 0;
  std::vector<int> mode;                  // empty: all entries are 0
  std::vector<double> x, p, u, v;         // v: of the function with the longest one
  std::vector<FunctionValues> functions;  // rhs first
};

struct StartDescription;

struct EventDescription {
  std::string name, direction, action;
  eom::hybrid::Reset reset = {};
};

/// Period and offset of a sample in the language of model files; empty where they do not depend on parameters.
struct SampleFormulas {
  std::string every, offset;
};

/// Data that a program needs to run the model as `run` does: the default scene, whose code is described, and the output
/// indices of the columns of its table.
struct RunDescription {
  std::shared_ptr<const eom::hybrid::Problem> problem;
  std::vector<std::size_t> columns;
  double rows = 0;  // intervals between rows in the span of the run; 0: the scene states their length
  std::vector<std::uint32_t> beyond_range = {};  // coordinates of the model that may leave their range
};

struct EmissionContext {
  std::string id;  // id of the model; becomes NAME
  std::string title;
  std::string content_hash;
  std::string verdict;                // one line from verify: "pass: 20 points, 50 digits"
  std::vector<Quantity> coordinates;  // all of the model, in declared order; those not in Program::free are eliminated
  std::vector<Quantity> parameters;   // all of the model, in declared order: the array p
  std::vector<Quantity> inputs;       // the array u
  std::vector<std::string> varying_inputs = {};  // those that vary in time in the default scene
  std::vector<Quantity> states;  // of first order, all of the model; those in Program::states follow the velocities
  std::string start_parameter;   // name of the parameter for the start time; empty if none
  std::vector<EventDescription> events;    // all of the model, in declared order
  std::vector<std::string> inertial = {};  // inertial parameters, of the function `regressor`
  std::vector<std::string> frames = {};    // bodies, particles and points in declared order, of the function `frames`
  std::vector<std::string> singular;       // "sin(phi) = 0"
  double start_time = 0;
  /// Whether an event or a sample changes the state.
  bool has_resets() const;
  std::vector<eom::hybrid::Sample> samples;     // with the periods of the default scene
  std::vector<SampleFormulas> sample_formulas;  // of each sample
  std::vector<double> start;                    // x at the start of the default scene
  std::vector<TestVector> tests;
  std::shared_ptr<const RunDescription> run = {};                // if requested
  std::shared_ptr<const StartDescription> start_functions = {};  // of NAME_start, if requested (start/start.hpp)
  bool jumps_in_time = false;               // velocities may jump at kinks in time of prescribed motions
  std::optional<double> single_error = {};  // error in single precision, if requested (single_precision.hpp)
};

/// NAME of the C ABI: the model's id as an identifier that no target reserves.
std::string mangled_id(const std::string& id);
/// The module name for target python: NAME, or NAME_ if Python or its standard library uses that name.
std::string module_name(const std::string& id);
/// The name for target javascript: NAME, or NAME_ if JavaScript or browsers use that name.
std::string script_name(const std::string& id);

}  // namespace eomgen::emit
