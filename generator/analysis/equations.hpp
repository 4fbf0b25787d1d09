// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of motion as shown by `derive`: printed formulas, skipped results, meaning of the multipliers.
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
  /// Keys out of equation_keys(). "all": every key with is_part_of_all().
  std::vector<std::string> show{"equations", "constraints", "reactions", "friction"};
  /// The scene whose start is the equilibrium of "linear"; empty: any motion, and any equilibrium.
  std::string about;
};

const std::vector<std::string>& equation_keys();
/// Whether "all" shows this key. Other forms of what it shows, and long tables, are shown on request only.
bool is_part_of_all(const std::string& key);

struct Equations {
  system::Approach approach = system::Approach::two;
  std::vector<print::PrintedFormula> items;
  std::vector<work::LeftOut> left_out;
  std::vector<Multiplier> multipliers;  // if forces are shown
  std::vector<std::string> notes;       // reasons why a requested result is empty
  bool interrupted = false;
};

/// Derives the display form by the default approach. Approach I also yields constraint forces; it is chosen if a
/// constraint eliminates something or a contact has a force.
reading::DisplayForm displayed_form(const mechanics::Mechanics& mechanics);

/// Throws Error{stage "derive"} for an unknown key. On interruption returns a partial result with `interrupted` set.
Equations equations(std::shared_ptr<const model::Model> model, const EquationsRequest& request);

}  // namespace eomgen::analysis
