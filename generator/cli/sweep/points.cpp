// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

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

Points::Points(const std::vector<std::string>& grid, std::optional<Sampling> samples, std::optional<PointsFile> file)
    : samples_(std::move(samples)), file_(std::move(file)) {
  if (samples_ && file_)
    throw Error("sweep", {}, "--sample and --points both say what changes fastest", "leave one of them out");
  if (!grid.empty() || (!samples_ && !file_)) grid_.emplace(grid);
  if (grid_) {
    size_ = grid_->size();
    for (const Axis& axis : grid_->axes()) names_.push_back(axis.parameter);
  }
  if (!samples_ && !file_) return;
  for (const std::string& name : samples_ ? samples_->names() : file_->names()) {
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) {
      throw Error(
          "sweep", {},
          fmt::format("{} has a grid and is {}", model::quote(name), samples_ ? "sampled" : "a column of --points"),
          "leave one of them out");
    }
    names_.push_back(name);
  }
  const std::size_t each = samples_ ? samples_->size() : file_->size();
  if (each > most_points / size_) {
    throw Error("sweep", {}, fmt::format("the grid with its samples has more than {} points", most_points),
                "take fewer");
  }
  size_ *= each;
}

std::map<std::string, symbolic::Rational> Points::point(std::size_t index) const {
  std::map<std::string, symbolic::Rational> result;
  const std::size_t each = samples_ ? samples_->size() : file_ ? file_->size() : 1;
  if (grid_) result = grid_->point(index / each);
  if (!samples_ && !file_) return result;
  const std::vector<symbolic::Rational> values = samples_ ? samples_->point(index % each) : file_->point(index % each);
  const std::size_t first = names_.size() - values.size();
  for (std::size_t i = 0; i < values.size(); ++i) result[names_[first + i]] = values[i];
  return result;
}

Shard parse_shard(const std::string& text) {
  if (const auto shard = shard_of(text)) return *shard;
  throw Error("sweep", {}, fmt::format("{} is no shard", model::quote(text)),
              "write --shard NUMBER/COUNT, such as 2/8; numbers begin with 1");
}

std::string shard_note(const Shard& shard, std::size_t runs) {
  return fmt::format("{}{}/{} of {}", note, shard.number, shard.count, runs);
}

std::optional<ShardNote> read_shard_note(const std::string& line) {
  const std::size_t at = line.find(note);
  if (at == std::string::npos) return std::nullopt;
  const std::string rest = line.substr(at + std::string(note).size());
  const std::size_t of = rest.find(" of ");
  if (of == std::string::npos) return std::nullopt;
  const auto shard = shard_of(rest.substr(0, of));
  const auto runs = whole(rest.substr(of + 4));
  if (!shard || !runs) return std::nullopt;
  return ShardNote{line.substr(0, at), *shard, *runs};
}

}  // namespace eomgen::cli
