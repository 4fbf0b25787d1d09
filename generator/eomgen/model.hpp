// SPDX-License-Identifier: GPL-3.0-or-later
// A mechanical system, and all that eomgen does with one. Calls take seconds where they derive or compile; each takes a
// Task that can end it. Error (eomgen/error.hpp) is thrown where a model, an option or a tool is wrong, with line and
// column of the model where there is a place.
//
// Threads: any thread may call, on the same or on different models. The computer algebra underneath is not made for
// threads, so calls wait for one another; a call from within a function that another call was handed does not.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "eomgen/certificate.hpp"
#include "eomgen/definition.hpp"
#include "eomgen/error.hpp"
#include "eomgen/examination.hpp"
#include "eomgen/formulas.hpp"
#include "eomgen/measures.hpp"
#include "eomgen/motion.hpp"
#include "eomgen/sources.hpp"
#include "eomgen/steady.hpp"
#include "eomgen/task.hpp"

namespace eomgen {

namespace model {
struct Model;
}

/// Read and checked; it does not change. Copies share it.
class Model {
 public:
  /// A model file (docs/model-format.md). Throws Error{stage "model"}.
  static Model from_file(const std::string& path);
  /// The same from a text; `name` is the model's, and the file's in errors.
  static Model from_text(const std::string& text, const std::string& name = "model");
  /// One that was made in code.
  static Model from(const Definition& definition, const std::string& name = "model");

  std::string id() const;
  std::string title() const;
  std::vector<std::string> coordinates() const;
  std::vector<std::string> parameters() const;
  std::vector<std::string> inputs() const;
  std::vector<std::string> scenes() const;
  /// What the reader warns of, with place and remedy.
  std::vector<std::string> warnings() const;

  /// Degrees of freedom, classes of constraints and forces, what is conserved, singular sets.
  Examination examine(const Task& task = {}) const;
  /// The equations as one reads them.
  Equations equations(const EquationsOptions& options = {}, const Task& task = {}) const;
  /// The equations as data, by Lagrange's equations in the fast form. `automatic` is II here.
  Derivation derivation(Approach approach = Approach::two, const Task& task = {}) const;
  /// The whole derivation as a LaTeX document.
  std::string article(const Task& task = {}, std::uint64_t seed = 1) const;
  /// Every route against the judge, in many digits. A verdict that is negative is no error.
  Certificate verify(const VerifyOptions& options = {}, const Task& task = {}) const;
  /// Verified sources. Throws Error{Fault::check} where the derivations disagree.
  Sources emit(const EmitOptions& options = {}, const Task& task = {}) const;
  /// Derives, verifies, compiles (with a C compiler; cached by content) and integrates a scene.
  Motion run(const RunOptions& options = {}, const Task& task = {}) const;
  InverseDynamics inverse_dynamics(const InverseOptions& options = {}, const Task& task = {}) const;
  Linearisation linearise(const LineariseOptions& options = {}, const Task& task = {}) const;
  SteadyMotions steady_motions(const SteadyOptions& options = {}, const Task& task = {}) const;
  Benchmark benchmark(const BenchmarkOptions& options = {}, const Task& task = {}) const;
  StressTest stress_test(const StressOptions& options = {}, const Task& task = {}) const;

 private:
  explicit Model(std::shared_ptr<const model::Model> read) : read_(std::move(read)) {}
  std::shared_ptr<const model::Model> read_;
};

}  // namespace eomgen
