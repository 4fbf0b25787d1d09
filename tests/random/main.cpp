// SPDX-License-Identifier: GPL-3.0-or-later
// random_mechanisms PROGRAM FROM TO [N]: runs the program on the model of every seed; prints a line for each finding,
// and the total. Every N-th model (each, if N is omitted) is also compiled, run and linearised.
// random_mechanisms PROGRAM --found FOLDER: the same for models of earlier findings. Models with names run_* are also
// run; models with names check_* are only checked, in a tenth of the time; a run of models with names refused_* is
// refused. random_mechanisms PROGRAM --print SEED | --shrink SEED: prints the text of a model; prints the smallest text
// with the same finding.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "random/trial.hpp"

namespace {

using namespace eomgen::random_models;

std::uint64_t number(const char* text) { return std::strtoull(text, nullptr, 10); }

// 0: no findings, 1: findings.
int try_seeds(const std::string& program, const std::string& folder, std::uint64_t from, std::uint64_t to,
              std::uint64_t every) {
  std::map<std::string, std::size_t> features;
  std::size_t tried = 0, refused = 0, failed = 0;
  double slowest = 0;
  for (std::uint64_t seed = from; seed <= to; ++seed) {
    const Mechanism m = mechanism(seed);
    Limits limits;
    limits.moved = seed % every == 0;
    const Trial trial = try_model(program, folder, m.text, limits);
    ++tried;
    refused += !trial.refusal.empty() && trial.findings.empty() ? 1 : 0;
    if (trial.refusal.empty()) {
      for (const std::string& feature : m.features) ++features[feature];
    }
    slowest = std::max(slowest, trial.slowest);
    if (tried % 100 == 0) std::fprintf(stderr, "%zu tried, %zu failed\n", tried, failed);
    if (trial.findings.empty()) continue;
    ++failed;
    for (const Finding& finding : trial.findings)
      std::printf("seed %llu: %s: %s\n", static_cast<unsigned long long>(seed), finding.command.c_str(),
                  finding.what.c_str());
    std::fflush(stdout);
  }
  std::printf("features of those that are mechanisms:");
  for (const auto& [feature, count] : features) std::printf(" %s %zu;", feature.c_str(), count);
  std::printf(
      "\n%zu random mechanisms: %zu kept every promise, %zu are no mechanism and were refused, %zu failed; slowest "
      "command %.1f s\n",
      tried, tried - refused - failed, refused, failed, slowest);
  // If most models are rejected, the generator tests nothing.
  return failed == 0 && 4 * refused <= tried ? 0 : 1;
}

int replay_found(const std::string& program, const std::string& folder, const std::filesystem::path& found) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(found)) files.insert(entry.path());
  std::size_t failed = 0;
  for (const std::filesystem::path& file : files) {
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    Limits limits;
    const bool is_refused = file.filename().string().starts_with("refused_");
    limits.moved = is_refused || file.filename().string().starts_with("run_");
    limits.only_checked = file.filename().string().starts_with("check_");
    if (limits.only_checked) limits.seconds = seconds_of_a_check;
    const Trial trial = try_model(program, folder, text, limits);
    if (!trial.refusal.empty()) std::printf("%s: refused: %s\n", file.filename().c_str(), trial.refusal.c_str());
    for (const Finding& finding : trial.findings)
      std::printf("%s: %s: %s\n", file.filename().c_str(), finding.command.c_str(), finding.what.c_str());
    failed += trial.refusal.empty() != is_refused && trial.findings.empty() ? 0 : 1;
  }
  std::printf("%zu models of former findings, %zu fail\n", files.size(), failed);
  return failed == 0 && !files.empty() ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  if (count != 4 && count != 5) {
    std::fputs(
        "usage: random_mechanisms PROGRAM FROM TO [N]\n       random_mechanisms PROGRAM --found FOLDER\n       "
        "random_mechanisms PROGRAM --print SEED\n       random_mechanisms PROGRAM --shrink SEED\n",
        stderr);
    return 2;
  }
  const std::string program = std::filesystem::absolute(words[1]).string(), second = words[2];
  std::string folder = (std::filesystem::temp_directory_path() / "random_mechanisms_XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) return 4;
  int status = 0;
  if (second == "--print") {
    std::fputs(mechanism(number(words[3])).text.c_str(), stdout);
  } else if (second == "--shrink") {
    std::fputs(shrink(program, folder, mechanism(number(words[3])).text, {}).c_str(), stdout);
  } else if (second == "--found") {
    status = replay_found(program, folder, words[3]);
  } else {
    status = try_seeds(program, folder, number(words[2]), number(words[3]),
                       count == 5 ? std::max<std::uint64_t>(1, number(words[4])) : 1);
  }
  std::filesystem::remove_all(folder);
  return status;
}
