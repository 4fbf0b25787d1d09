// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/animation_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/drawing/animation.hpp"
#include "cli/picture/glb_file.hpp"

namespace eomgen::cli {
namespace {

constexpr double most_keyframes = 2e4;

}  // namespace

std::vector<std::string> AnimationFile::prepare(pipeline::DerivedModel& derived) {
  drawing_.emplace(derived.mechanics);
  if (drawing_->parts().places.empty())
    throw Error("run", {}, "the model has no position of a particle or body, so that there is nothing to animate",
                "give positions, or leave --animation out");
  for (system::EquationSystem& candidate : derived.candidates) drawing_->add_outputs(candidate);
  return drawing_->outputs();
}

void AnimationFile::begin(const std::vector<std::string>& names, double expected_rows) {
  for (const std::string& name : drawing_->outputs())
    index_.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
  stride_ = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(expected_rows / most_keyframes)));
}

void AnimationFile::row(double t, std::span<const double> values) {
  if (count_++ % stride_ != 0) return;
  t_.push_back(t);
  std::vector<double>& row = rows_.emplace_back();
  for (const std::size_t i : index_) row.push_back(values[i]);
}

std::uint64_t AnimationFile::write(const pipeline::Simulation& simulation, const std::string& title) const {
  const std::vector<double>& parameters = simulation.scene.parameters;
  mechanics::Mechanics& m = simulation.derived->mechanics;
  const analysis::Animation motion =
      analysis::animation(drawing_->parts(), analysis::sizes_of(*drawing_, *m.dag, parameters), t_, rows_,
                          analysis::gravity_direction(m, parameters));
  if (motion.nodes.empty())
    throw Error("run", {}, "no part has a finite position at every keyframe, so that there is nothing to animate",
                "end the run before the motion diverges: --t-end", ErrorKind::numerical);
  if (!motion.left_out.empty())
    print_message(fmt::format("note: not in the animation, without a finite position at every keyframe: {}\n",
                              fmt::join(motion.left_out, ", ")));
  return write_text(path_, encode_glb(motion, title));
}

}  // namespace eomgen::cli
