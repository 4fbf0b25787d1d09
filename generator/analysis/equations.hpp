// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion as `derive` shows them: printed formulas, what was left out, which multiplier is which.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "pipeline/pipeline.hpp"
#include "print/render.hpp"
#include "work.hpp"

namespace eomgen::analysis {

struct EquationsRequest {
  pipeline::ApproachChoice approach = pipeline::ApproachChoice::automatic;
  /// Of equation_keys(); "all" for all but "linear" and "routh".
  std::vector<std::string> show{"equations", "constraints", "reactions", "friction"};
};

const std::vector<std::string>& equation_keys();

struct Multiplier {
  std::string name, latex;
  std::string of;       // label of the constraint
  std::string meaning;  // in words
};

struct Equations {
  system::Approach approach = system::Approach::two;
  std::vector<print::Item> items;
  std::vector<work::LeftOut> left_out;
  std::vector<Multiplier> multipliers;  // where forces are shown
  std::vector<std::string> notes;       // why what was asked for is empty
  bool interrupted = false;
};

/// The equations as they are shown where no approach is asked for: those of approach I show the constraint forces too,
/// and stand wherever something is eliminated or a contact has a force.
reading::ReadingForm form_to_show(const mechanics::Mechanics& mechanics);

/// Throws Error{stage "derive"}: an unknown key. Where it is interrupted it says so, and gives what is there.
Equations equations(std::shared_ptr<const model::Model> model, const EquationsRequest& request);

}  // namespace eomgen::analysis
