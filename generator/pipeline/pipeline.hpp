// SPDX-License-Identifier: GPL-3.0-or-later
// The program in a few lines: model -> mechanics -> equation systems -> certificate -> program -> sources.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conservation/conserved.hpp"
#include "emit/context.hpp"
#include "emit/targets.hpp"
#include "mechanics/mechanics.hpp"
#include "program/build.hpp"
#include "run/scene.hpp"
#include "verify/certificate.hpp"

namespace eomgen::pipeline {

/// Seconds of each step. `read` is for who reads the model to fill in.
struct Timings {
  double read = 0, derive = 0, optimise = 0, verify = 0, print = 0;
};

enum class ApproachChoice { automatic, one, two };
std::vector<std::string> approach_words();                // "auto", "I", "II"
ApproachChoice approach_choice(const std::string& text);  // of one of them; throws Error

/// Nothing: the cheapest of those that hold everywhere.
using FormChoice = std::optional<system::Form>;
std::vector<std::string> form_words();            // "auto", and the names of system::Form
FormChoice form_choice(const std::string& text);  // of one of them; throws Error

/// A model and its equations. It stays where it is: what is made from it refers to it.
struct Derived {
  explicit Derived(std::shared_ptr<const model::Model> read);
  ~Derived();
  Derived(const Derived&) = delete;
  Derived& operator=(const Derived&) = delete;

  std::shared_ptr<const model::Model> shared;
  const model::Model& model;
  mechanics::Mechanics mechanics;
  std::vector<system::EquationSystem> candidates;  // routes that apply, in the approaches asked for
  std::vector<conservation::Conserved> conserved;
  Timings seconds;
  bool kept_certificate = false;  // of an earlier command, for the same model and program
};

/// Builds and derives. Throws Error.
std::unique_ptr<Derived> derive_model(std::shared_ptr<const model::Model> model, ApproachChoice approach,
                                      FormChoice form = std::nullopt);

/// The cheapest program of the candidates; counts its time.
program::Program make_program(Derived& derived, const program::Request& request);

/// Both reading forms, where they are written out.
void add_reading_forms(mechanics::Mechanics& mechanics, verify::Subjects& subjects);

/// Every route, both reading forms and the optimised program against the judge.
struct Verification {
  int digits = 50;
  std::size_t points = 20;
  std::uint64_t seed = 1;
  const verify::CompiledForm* compiled = nullptr;
  std::map<std::uint32_t, symbolic::Rational> fixed = {};  // as the program was asked for
  bool reductions = false;                                 // Routh's too, which no code is made of
  std::vector<double> default_inputs = {};  // of the emitted code, which mass and constraints see; none: any will do
  bool partial = false;                     // what an interruption leaves will do
  bool keep = true;                         // false: it is compared anew, whatever was kept
};
verify::Certificate certify(Derived& derived, const program::Program& program, const Verification& options);

/// Shows the certificate and throws Error{Fault::check} where it is negative: such a model is not emitted.
void require_pass(const verify::Certificate& certificate, const model::Model& model);

/// What the sources say about the model; start and parameters of the default scene.
emit::EmissionContext emission_context(Derived& derived, const program::Program& program, const run::Scene& scene,
                                       const verify::Certificate& certificate);

/// How many points are checked each time that code is emitted; `verify` checks more.
inline constexpr std::size_t emission_points = 5;

}  // namespace eomgen::pipeline
