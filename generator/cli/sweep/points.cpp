// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "cli/sweep/axes.hpp"
#include "cli/sweep/points_file.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

using analysis::Shard;

constexpr const char* note = " shard ";

std::optional<std::size_t> whole(const std::string& text) {
  std::size_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<Shard> shard_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto number = whole(text.substr(0, slash)), count = whole(text.substr(slash + 1));
  if (!number || !count || *number < 1 || *number > *count) return std::nullopt;
  return Shard{*number, *count};
}

}  // namespace

analysis::SweepPoints points_of(const SweepOptions& options, std::uint64_t seed, std::string& file_hash) {
  const bool sampled = !options.sample.empty() || options.samples > 0, listed = !options.points.empty();
  if (options.design && !sampled)
    throw Error("sweep", {}, "--design is of samples, and there are none",
                "add --sample NAME=FROM:TO and --samples N, or leave it out");
  std::optional<analysis::Sampling> samples;
  std::optional<analysis::ListedPoints> list;
  std::optional<analysis::Grid> grid;
  if (sampled) samples = parse_sampling(options.sample, options.samples, options.design.value_or("random"), seed);
  if (listed) {
    PointsFile file = read_points(options.points);
    file_hash = file.content_hash;
    list = std::move(file.points);
  }
  if (sampled && listed)
    throw Error("sweep", {}, "--sample and --points both say what changes fastest", "leave one of them out");
  if (!options.grid.empty() || (!sampled && !listed)) grid = parse_grid(options.grid);
  for (const std::string& name : samples ? samples->names() : list ? list->names : std::vector<std::string>{}) {
    const auto named = [&name](const analysis::GridAxis& axis) { return axis.parameter == name; };
    if (!grid || std::none_of(grid->axes().begin(), grid->axes().end(), named)) continue;
    throw Error(
        "sweep", {},
        fmt::format("{} has a grid and is {}", model::quote(name), sampled ? "sampled" : "a column of --points"),
        "leave one of them out");
  }
  return {std::move(grid), std::move(samples), std::move(list)};
}

analysis::Shard parse_shard(const std::string& text) {
  if (const auto shard = shard_of(text)) return *shard;
  throw Error("sweep", {}, fmt::format("{} is no shard", model::quote(text)),
              "write --shard NUMBER/COUNT, such as 2/8; numbers begin with 1");
}

std::string shard_header(const analysis::Shard& shard, std::size_t runs) {
  return fmt::format("{}{}/{} of {}", note, shard.number, shard.count, runs);
}

std::optional<ShardHeader> parse_shard_header(const std::string& line) {
  const std::size_t at = line.find(note);
  if (at == std::string::npos) return std::nullopt;
  const std::string rest = line.substr(at + std::string(note).size());
  const std::size_t of = rest.find(" of ");
  if (of == std::string::npos) return std::nullopt;
  const auto shard = shard_of(rest.substr(0, of));
  const auto runs = whole(rest.substr(of + 4));
  if (!shard || !runs) return std::nullopt;
  return ShardHeader{line.substr(0, at), *shard, *runs};
}

}  // namespace eomgen::cli
