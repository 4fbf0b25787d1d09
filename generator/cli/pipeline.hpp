// SPDX-License-Identifier: GPL-3.0-or-later
// The program in a few lines: model -> mechanics -> equation systems -> certificate -> program -> sources.
#pragma once

#include <string>
#include <vector>

#include "derive/conserved.hpp"
#include "derive/routes.hpp"
#include "emit/context.hpp"
#include "mechanics/mechanics.hpp"
#include "program/build.hpp"
#include "reading/reading.hpp"
#include "run/scene.hpp"
#include "verify/certificate.hpp"

namespace eomgen::cli {

/// Seconds of each step, as `emit` and `run` report them.
struct Timings {
  double read = 0, derive = 0, optimise = 0, verify = 0, print = 0;
};

enum class ApproachChoice { automatic, one, two };
ApproachChoice approach_choice(const std::string& text);  // "auto", "I", "II"; throws Error

struct Derived {
  model::Model model;
  mechanics::Mechanics mechanics;
  std::vector<system::EquationSystem> candidates;
  std::vector<derive::Conserved> conserved;  // of the first candidate
  Timings seconds;
};
/// Reads, builds, derives by every route that applies, in the approaches asked for.
std::unique_ptr<Derived> derive_model(const std::string& name, ApproachChoice approach);

/// Every route against the judge; reading form, optimised program included.
verify::Certificate certify(Derived& derived, int digits, int points, std::uint64_t seed, const program::Program* program);

/// Throws Error{Fault::check} that shows the certificate where it is negative: such a model is not emitted.
void require_pass(const verify::Certificate& certificate, const model::Model& model);

}  // namespace eomgen::cli
