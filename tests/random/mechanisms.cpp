// SPDX-License-Identifier: GPL-3.0-or-later
#include "random/mechanisms.hpp"

#include "random/between_bodies.hpp"
#include "random/mechanism_builder.hpp"

namespace eomgen::random_models {
namespace {

// First seeds with newer kinds of models. The models of smaller seeds stay the same, since findings are identified by
// their seeds.
constexpr std::uint64_t first_with_contacts = 1001, first_with_forces_between_bodies = 2001,
                        first_small = 10001,  // one or two places, otherwise the same: many models in a short time
    first_with_states = 20001,                // small ones with states and resets in place of contacts
    first_with_armatures = 1000001,           // of any size, with armatures and without states
    first_with_times = 2000001;  // small, with states, kinks at the start, inputs over time, coupled starts

}  // namespace

MechanismBuilder::MechanismBuilder(std::uint64_t seed)
    : dice_(seed),
      contacts_(seed >= first_with_contacts),
      between_(seed >= first_with_forces_between_bodies),
      small_((seed >= first_small && seed < first_with_armatures) || seed >= first_with_times),
      states_((seed >= first_with_states && seed < first_with_armatures) || seed >= first_with_times),
      armatures_(seed >= first_with_armatures && seed < first_with_times),
      times_(seed >= first_with_times) {}

Mechanism MechanismBuilder::build() {
  planar_ = dice_.chance(35);
  feature(planar_ ? "planar" : "spatial");
  named_parameters_ = static_cast<int>(dice_.below(3)) * 50;
  equal_ = dice_.chance(25);
  const std::size_t places = 1 + dice_.below(small_ ? 2 : planar_ ? 5 : 4);
  for (std::size_t i = 0; i < places; ++i) {
    if (dice_.chance(60))
      add_body();
    else
      add_particle();
  }
  while (coordinates_.empty()) add_particle();
  add_forces();
  add_energies();
  add_constraints();
  if (contacts_) {
    if (dice_.chance(35)) add_joint_of_all_axes();
    if (!states_ && dice_.chance(75)) add_contacts();
  }
  if (between_) {
    std::vector<std::string> turning;
    for (const Place& place : places_) {
      if (place.body && !place.angles.empty()) turning.push_back(place.name);
    }
    force_lines_ += forces_between(dice_, turning, planar_, result_.features);
  }
  if (states_) add_states();
  if (armatures_) add_armatures();
  if (times_) add_times();
  return finish();
}

void MechanismBuilder::add_armatures() {
  std::string lines;
  for (const std::string& q : coordinates_) {
    const bool declared = coordinate_lines_.find(q + " = {}\n") != std::string::npos;
    if (dice_.chance(50)) {
      feature("armature");
      lines += q + " = { armature = \"" + value(10, 90) + "\" }\n";
    } else if (declared) {
      lines += q + " = {}\n";
    }
  }
  coordinate_lines_ = lines;
}

Mechanism MechanismBuilder::finish() {
  std::string& t = result_.text;
  t = "format = 1\n";
  const auto section = [&](const char* name, const std::string& lines) {
    if (!lines.empty()) t += std::string("[") + name + "]\n" + lines;
  };
  section("parameters", parameter_lines_);
  section("functions", function_lines_);
  section("inputs", input_lines_);
  section("coordinates", coordinate_lines_);
  section("energy", energy_);
  section("discrete", discrete_lines_);
  t += place_lines_ + force_lines_ + constraint_lines_ + joint_lines_ + event_lines_;
  t += "[scene.default]\nt = [0, 0.3]\n";
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const auto& [value, rate] = starts_[i];
    const std::string& q = coordinates_[i];
    if (follows_.contains(q)) {
      guess_ += (guess_.empty() ? "" : ", ") + q + " = " + value;
      continue;
    }
    if (!value.empty()) start_ += (start_.empty() ? "" : ", ") + q + " = " + start_value(i, false, value);
    // Constraints determine coupled rates: the start is at rest except for prescribed motions.
    if (!rate.empty() && !result_.constrained && constraints_ == 0)
      start_ += (start_.empty() ? "" : ", ") + q + "_dot = " + start_value(i, true, rate);
  }
  if (result_.constrained || constraints_ > 0) spins_.clear();
  for (const std::string& body : spins_)
    start_ += (start_.empty() ? "" : ", ") + ("\"" + body + ".omega\" = [" + dice_.decimal(-90, 90) + ", " +
                                              dice_.decimal(-90, 90) + ", " + dice_.decimal(-90, 90) + "]");
  t += "initial = { " + start_ + " }\n";
  if (!guess_.empty()) t += "guess = { " + guess_ + " }\n";
  std::string signals;
  for (int i = 1; times_ && i <= inputs_; ++i) signals += (i > 1 ? ", u" : "u") + std::to_string(i) + " = " + signal();
  if (!signals.empty()) t += "inputs = { " + signals + " }\n";
  return result_;
}

Mechanism mechanism(std::uint64_t seed) { return MechanismBuilder(seed).build(); }

}  // namespace eomgen::random_models
