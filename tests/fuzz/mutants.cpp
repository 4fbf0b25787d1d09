// SPDX-License-Identifier: GPL-3.0-or-later
// The harnesses without libFuzzer, for any compiler: mutated models in a fixed order, each in a separate process with
// limited time and memory.
//   mutants derive|run FIRST COUNT [SECONDS]: models of the seeds FIRST, FIRST + 1 ..; findings are saved in this
//   folder mutants derive|run FILE...: these models, or those in these folders
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "commands.hpp"
#include "support/sanitized.hpp"

namespace {

using namespace eomgen::fuzz;

constexpr rlim_t most_seconds =
    eomgen::test::sanitized ? 600 : 60;  // processor time, so that a busy machine has no effect
constexpr rlim_t most_memory = eomgen::test::sanitized ? RLIM_INFINITY : rlim_t{2} << 30;
constexpr int refused = 2;

bool has_exited(int status, int code) { return WIFEXITED(status) && WEXITSTATUS(status) == code; }

std::string verdict(int status) {
  if (has_exited(status, 0) || has_exited(status, refused)) return "";
  if (WIFEXITED(status)) return "exit " + std::to_string(WEXITSTATUS(status));
  return WTERMSIG(status) == SIGXCPU ? "timeout" : "signal " + std::to_string(WTERMSIG(status));
}

int run_in_child(const std::vector<Words>& calls, const std::string& text) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) std::abort();
  if (child == 0) {
    const rlimit seconds{most_seconds, most_seconds + 2}, memory{most_memory, most_memory};
    setrlimit(RLIMIT_CPU, &seconds);
    setrlimit(RLIMIT_AS, &memory);
    std::exit(try_command(calls, text).empty() ? 0 : refused);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
  }
  return status;
}

/// A sequence of models with their results.
class Trial {
 public:
  explicit Trial(std::string_view kind) : kind_(kind), calls_(kind == "derive" ? derive_calls() : run_calls()) {}

  void fresh(unsigned seed) {
    // Mutates an accepted model, so that changes accumulate, or a shipped one.
    const std::string from = seed % 3 == 0 || taken_.empty() ? "" : taken_[seed / 3 % taken_.size()];
    const std::string text = mutate(calls_, from, seed), name = kind_ + "-" + std::to_string(seed) + ".toml";
    if (!holds(name, text)) std::ofstream(name) << text;
  }
  void file(const std::filesystem::path& path) {
    std::ifstream stream(path);
    holds(path.string(), {std::istreambuf_iterator<char>(stream), {}});
  }
  int result() const {
    std::printf("%u models, %zu taken, %u findings\n", models_, taken_.size(), findings_);
    return findings_ == 0 ? 0 : 1;
  }

 private:
  bool holds(const std::string& name, const std::string& text) {
    const int status = run_in_child(calls_, text);
    const std::string what = verdict(status);
    ++models_;
    if (has_exited(status, 0)) taken_.push_back(text);
    if (what.empty()) return true;
    ++findings_;
    std::fprintf(stderr, "%s: %s\n", name.c_str(), what.c_str());
    return false;
  }

  std::string kind_;
  const std::vector<Words>& calls_;
  std::vector<std::string> taken_;
  unsigned models_ = 0, findings_ = 0;
};

bool is_number(std::string_view word) { return word.find_first_not_of("0123456789") == std::string_view::npos; }

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {path};
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    if (entry.is_regular_file()) result.push_back(entry.path());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2 || (words[0] != "derive" && words[0] != "run") || (is_number(words[1]) && words.size() < 3)) {
    std::fputs("usage: mutants derive|run FIRST COUNT [SECONDS], or mutants derive|run FILE...\n", stderr);
    return 2;
  }
  setenv("EOMGEN_CC", EOMGEN_FUZZ_CC, 1);
  Trial trial(words[0]);
  if (is_number(words[1])) {
    const auto first = static_cast<unsigned>(std::stoul(words[1])), count = static_cast<unsigned>(std::stoul(words[2]));
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::seconds(words.size() > 3 ? std::stol(words[3]) : 1000000);
    for (unsigned seed = first; seed < first + count && std::chrono::steady_clock::now() < end; ++seed)
      trial.fresh(seed);
  } else {
    for (std::size_t i = 1; i < words.size(); ++i) {
      for (const std::filesystem::path& path : files_of(words[i])) trial.file(path);
    }
  }
  return trial.result();
}
