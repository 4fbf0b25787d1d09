// SPDX-License-Identifier: GPL-3.0-or-later
// The mechanical system and all analyses of it. In: a model file, its text or a Definition. Out: plain structures.
//
// Calls that derive equations or compile code take seconds; a CallControl can stop them. All functions throw Error
// (eomgen/error.hpp) if the model, an option or an external tool is wrong. Error has the line and column of the model
// if the cause has a position there.
//
// Thread safety: any thread may call any function, on the same model or on different ones. The computer algebra is not
// thread-safe, so one lock serialises all calls but the integration of run(). A callback that runs inside a call may
// call the library again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "eomgen/benchmark.hpp"
#include "eomgen/call_control.hpp"
#include "eomgen/certificate.hpp"
#include "eomgen/compiled_model.hpp"
#include "eomgen/definition.hpp"
#include "eomgen/error.hpp"
#include "eomgen/examination.hpp"
#include "eomgen/formulas.hpp"
#include "eomgen/motion.hpp"
#include "eomgen/simulation.hpp"
#include "eomgen/sources.hpp"
#include "eomgen/steady.hpp"

namespace eomgen {

namespace model {
struct Model;
}

class PreparedRuns;

/// A model that was read and checked. Immutable; copies share the data.
class Model {
 public:
  /// Reads a model file (docs/model-format.md). Throws Error{stage "model"} if it is not a valid model.
  static Model from_file(const std::string& path);
  /// Reads a model from text in the format of model files. `name`: name of the model, and of the file in errors.
  /// `folder`: of CSV files that the text names; empty: it may name none.
  static Model from_text(const std::string& text, const std::string& name = "model", const std::string& folder = "");
  /// Builds a model from a Definition. Throws as from_text() does.
  static Model from(const Definition& definition, const std::string& name = "model");

  std::string id() const;                        // base name of the file, or `name` of from_text()
  std::string title() const;                     // may be empty
  std::vector<std::string> coordinates() const;  // names, with those that constraints eliminate
  std::vector<std::string> parameters() const;   // names
  std::vector<std::string> inputs() const;       // names
  std::vector<std::string> scenes() const;       // names
  /// Warnings of the model reader, each with position and remedy.
  std::vector<std::string> warnings() const;
  /// The same as values.
  std::vector<Warning> reader_warnings() const;
  /// The number in SI units of a text such as "50 cm" or "30deg", for a parameter, an input, a coordinate, a rate or a
  /// state of this name. Warns if it has no unit and the model states the parameter in another unit than SI. Throws
  /// Error if the text is no number with a unit, or if the unit has another dimension.
  double number_of(const std::string& name, const std::string& text, const CallControl& control = {}) const;
  std::string text() const;    // of the model file
  std::string folder() const;  // of files that the model names; empty: from_text() without one

  /// Classifies the model: degrees of freedom, constraints, forces, conserved quantities, singular sets.
  Examination examine(const CallControl& control = {}) const;
  /// Derives the equations of motion in display form. Throws Error{stage "derive"} for an unknown key.
  Equations equations(const EquationsOptions& options = {}, const CallControl& control = {}) const;
  /// Derives the equations of motion in compiled form by Lagrange's equations. `automatic` means approach II here.
  Derivation derivation(Approach approach = Approach::two, const CallControl& control = {}) const;
  /// Returns the whole derivation as a LaTeX document. Throws Error{ErrorKind::check} if the check against the
  /// independent oracle fails. `seed`: of the random states of that check.
  std::string latex_document(const CallControl& control = {}, std::uint64_t seed = 1) const;
  /// Checks all formulations against the independent oracle in multiple precision. A failed check is a result
  /// (Certificate::pass is false), not an error.
  Certificate verify(const VerifyOptions& options = {}, const CallControl& control = {}) const;
  /// Generates verified source code. Throws Error{ErrorKind::check} if the formulations disagree.
  Sources emit(const EmitOptions& options = {}, const CallControl& control = {}) const;
  /// Derives, verifies, compiles and integrates a scene. The model and its copies keep the equations and the code of
  /// their latest runs, so that another run costs its integration, which takes no lock. A run that fails numerically
  /// returns its outcome and throws nothing.
  Motion run(const RunOptions& options = {}, const CallControl& control = {}) const;
  /// Derives, verifies and compiles the equations as functions that a program calls, with the numbers of a scene.
  CompiledModel compile(const CompileOptions& options = {}, const CallControl& control = {}) const;
  /// Computes the forces that prescribed motions require. Throws Error{stage "inverse"} if no constraint prescribes a
  /// motion or a name is unknown.
  InverseDynamics inverse_dynamics(const InverseOptions& options = {}, const CallControl& control = {}) const;
  /// Linearises the equations about a state of a scene. Throws Error{stage "linearize"} if a term has no derivative
  /// there.
  Linearisation linearise(const LineariseOptions& options = {}, const CallControl& control = {}) const;
  /// Searches equilibria and steady motions and classifies their stability. Throws Error{stage "equilibria"} if the
  /// equations depend on t or a quantity cannot be held.
  SteadyMotions steady_motions(const SteadyOptions& options = {}, const CallControl& control = {}) const;
  /// Measures the error and run time of solvers against a reference solution. Throws Error{stage "bench"} for scenes
  /// without a reference solution: contacts, moving inputs, kinks.
  Benchmark benchmark(const BenchmarkOptions& options = {}, const CallControl& control = {}) const;
  /// Runs solvers on stiff and extreme variations of a scene. Throws Error{stage "stress"} for an unknown solver.
  StressTest stress_test(const StressOptions& options = {}, const CallControl& control = {}) const;

 private:
  explicit Model(model::Model read);
  std::shared_ptr<const model::Model> read_;
  std::shared_ptr<PreparedRuns> runs_;
};

}  // namespace eomgen
