// SPDX-License-Identifier: GPL-3.0-or-later
// The tables that the shards of a sweep wrote, joined: the bytes of the sweep that one call makes.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/commands/commands.hpp"
#include "cli/output.hpp"
#include "cli/sweep/points.hpp"
#include "cli/sweep/statistics.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

struct Options {
  std::vector<std::string> tables;
  std::string out;
  bool statistics = false;
};

[[noreturn]] void fail(const std::string& what, const std::string& remedy) { throw Error("merge", {}, what, remedy); }

class Tables {
 public:
  void add(const std::string& path) {
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path)) fail(fmt::format("cannot read {}", model::quote(path)), "name the tables that sweep --shard wrote");
    std::string line;
    std::getline(file, line);
    const std::optional<ShardNote> note = read_shard_note(line);
    if (!note) fail(fmt::format("{} is not the table of a shard", model::quote(path)), "name the tables that sweep --shard wrote");
    if (tables_.empty()) note_ = *note;
    if (note->key != note_.key || note->shard.count != note_.shard.count || note->runs != note_.runs) {
      fail(fmt::format("{} and {} are of different sweeps", model::quote(tables_.begin()->second), model::quote(path)),
           "merge the shards of one sweep: the same model, options and number of shards");
    }
    const auto [place, fresh] = tables_.emplace(note->shard.number, path);
    if (!fresh) fail(fmt::format("{} and {} are the same shard", model::quote(place->second), model::quote(path)), "name each shard once");
    std::getline(file, line);
    if (header_.empty()) header_ = line;
    if (line != header_) fail(fmt::format("{} has other columns", model::quote(path)), "make that shard again");
    while (std::getline(file, line)) take(path, line, note->shard);
  }

  std::string text() const {
    std::string result = note_.key + "\n" + header_ + "\n";
    for (const auto& [run, line] : rows_) result += line + "\n";
    return result;
  }
  void require_all() const {
    for (std::size_t shard = 1; shard <= note_.shard.count; ++shard) {
      if (!tables_.contains(shard)) fail(fmt::format("shard {}/{} is missing", shard, note_.shard.count), "name the tables of all shards");
    }
    for (std::size_t run = 0; run < note_.runs; ++run) {
      if (rows_.contains(run)) continue;
      const std::size_t shard = run % note_.shard.count + 1;
      fail(fmt::format("run {} is missing, and {} of {} in all", run, note_.runs - rows_.size(), note_.runs),
           fmt::format("sweep --shard {}/{} goes on where it was interrupted", shard, note_.shard.count));
    }
  }

  std::size_t runs() const { return rows_.size(); }
  std::size_t shards() const { return tables_.size(); }
  std::vector<ColumnStatistics> statistics() const {
    std::vector<const std::string*> rows;
    for (const auto& [run, line] : rows_) rows.push_back(&line);
    return statistics_of_table(header_, rows);
  }

 private:
  void take(const std::string& path, const std::string& line, const Shard& shard) {
    std::size_t run = 0;
    const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), run);
    const bool whole = error == std::errc() && stop != line.data() + line.size() && *stop == ',' && run < note_.runs && shard.has(run);
    if (!whole || !rows_.emplace(run, line).second) {
      fail(fmt::format("{} has a line that is no run of that shard: {}", model::quote(path), model::quote(line.substr(0, 60))), "make that shard again");
    }
  }

  ShardNote note_;
  std::string header_;
  std::map<std::size_t, std::string> tables_;
  std::map<std::size_t, std::string> rows_;
};

int execute(const Options& options, const Common& common) {
  require_places({{"--out", options.out, ".csv"}}, "", common.json);
  Tables tables;
  for (const std::string& path : options.tables) tables.add(path);
  tables.require_all();
  write_text(options.out, tables.text());
  if (common.json) {
    nlohmann::ordered_json found{{"format", 1}, {"shards", tables.shards()}, {"runs", tables.runs()}, {"file", options.out}};
    if (options.statistics) found["statistics"] = to_json(tables.statistics());
    print_document(found);
  } else {
    std::string text = fmt::format("shards {}\nruns   {}\nwrote  {}\n", tables.shards(), tables.runs(), options.out);
    if (options.statistics) text += "\n" + to_text(tables.statistics());
    print_readable(text, is_standard_output(options.out));
  }
  return 0;
}

}  // namespace

Execute declare_merge(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("TABLES", options->tables, "what sweep --shard wrote, every shard of one sweep")->required();
  add_place(app, "-o,--out", options->out, "the whole table, a CSV file")->required();
  app.add_flag("--statistics", options->statistics, "mean, deviation, extremes and quantiles of every column");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
