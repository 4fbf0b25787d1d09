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

/// Seconds of each step. The caller that reads the model sets `read`.
struct Timings {
  double read = 0, derive = 0, optimise = 0, verify = 0, print = 0;
};

enum class ApproachChoice { automatic, one, two };
std::vector<std::string> approach_names();               // "auto", "I", "II"
ApproachChoice parse_approach(const std::string& text);  // from one of these names; throws Error

/// A form of the equations; nothing for the cheapest one that holds everywhere.
using FormChoice = std::optional<system::Form>;
std::vector<std::string> form_names();           // "auto", and the names of system::Form
FormChoice parse_form(const std::string& text);  // from one of these names; throws Error

/// A model and its equations. It cannot be moved: products refer to it.
struct DerivedModel {
  explicit DerivedModel(std::shared_ptr<const model::Model> read);
  ~DerivedModel();
  DerivedModel(const DerivedModel&) = delete;
  DerivedModel& operator=(const DerivedModel&) = delete;

  std::shared_ptr<const model::Model> shared;
  const model::Model& model;
  mechanics::Mechanics mechanics;
  std::vector<system::EquationSystem> candidates;  // applicable formulations, in the requested approaches
  std::vector<conservation::ConservedQuantity> conserved;
  run::SceneTables scene_tables;  // of the first candidate
  Timings seconds;
  bool certificate_from_cache = false;  // the certificate comes from an earlier command for the same model and program
};

/// Builds the mechanics and derives the equations. Throws Error.
std::unique_ptr<DerivedModel> derive_model(std::shared_ptr<const model::Model> model, ApproachChoice approach,
                                           FormChoice form = std::nullopt);

/// The cheapest program of the candidates; adds its time to `seconds`.
program::Program make_program(DerivedModel& derived, const program::Request& request);

/// Adds both display forms, if they are written out.
void add_display_forms(mechanics::Mechanics& mechanics, verify::Subjects& subjects);

/// Options of the comparison of every formulation, both display forms and the optimised program with the oracle.
struct Verification {
  int digits = 50;
  std::size_t points = 20;
  std::uint64_t seed = 1;
  const verify::CompiledForm* compiled = nullptr;
  std::map<std::uint32_t, symbolic::Rational> fixed = {};  // as in the request of the program
  bool reductions = false;                                 // also Routh's reduction, which code is not made of
  std::vector<double> default_inputs = {};  // of the emitted code, for mass and constraints; none: arbitrary values
  bool partial = false;                     // accept a certificate that an interruption cut short
  bool use_cache = true;                    // use the cache of certificates
};
verify::Certificate certify(DerivedModel& derived, const program::Program& program, const Verification& options);

/// Throws Error{ErrorKind::check} with the failures if the certificate is negative: such a model is not emitted.
void require_pass(const verify::Certificate& certificate, const model::Model& model);

/// The data of the model for code in memory: values of parameters, inputs and start, and the test vectors.
emit::EmissionContext code_context(const DerivedModel& derived, const program::Program& program,
                                   const run::Scene& scene);

/// The same with the description of the model in the sources, with start and parameters of the default scene.
emit::EmissionContext emission_context(DerivedModel& derived, const program::Program& program, const run::Scene& scene,
                                       const verify::Certificate& certificate);

/// Number of states that are checked each time code is emitted; `verify` checks more.
inline constexpr std::size_t emission_points = 5;

}  // namespace eomgen::pipeline
