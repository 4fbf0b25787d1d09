// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "cli/output.hpp"
#include "model/content_hash.hpp"

namespace eomgen::cli {

std::string sweep_key(const SweepOptions& options, const model::Model& model, std::uint64_t seed,
                      const std::string& points_hash) {
  std::string text = model.content_hash + '\n' + options.scene + '\n' +
                     (options.no_error_estimate || options.ensemble ? "plain" : "estimate " + options.estimate);
  for (const auto* list : {&options.grid, &options.set, &options.outputs}) {
    text += '\n';
    for (const std::string& entry : *list) text += entry + '\x1f';
  }
  for (const auto& value : {options.rtol, options.atol, options.step, options.t_end})
    text += '\n' + (value ? shortest(*value) : "");
  if (options.ensemble) text += "\nensemble";
  if (!options.sample.empty()) {
    text += fmt::format("\n{} {} {}", options.samples, options.design.value_or("random"), seed);
    for (const std::string& entry : options.sample) text += '\x1f' + entry;
  }
  if (!points_hash.empty()) text += "\npoints " + points_hash;
  std::string name = model.id;  // the key is one line of the table
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '_');
  return name + " " + model::content_hash(text + '\n' + options.solver.value_or("")).substr(0, 16);
}

}  // namespace eomgen::cli
