// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <stdio.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>

#include "cli/declaration.hpp"
#include "error.hpp"
#include "mutate.hpp"
#include "support/folders.hpp"
#include "support/schema.hpp"

namespace eomgen::fuzz {
namespace {

namespace fs = std::filesystem;

/// Captures the output to a stream. glibc allows a stream to be replaced.
class Caught {
 public:
  explicit Caught(FILE*& stream) : stream_(stream), before_(stream) { stream = open_memstream(&text_, &size_); }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;
  ~Caught() {
    std::fclose(std::exchange(stream_, before_));
    std::free(text_);
  }
  std::string text() {
    std::fflush(stream_);
    return {text_, size_};
  }

 private:
  FILE*& stream_;
  FILE* before_;
  char* text_ = nullptr;
  std::size_t size_ = 0;
};

/// The folder of the models and results of this process, and of compiled code, which is not reused.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (fs::temp_directory_path() / "eomgen-fuzz-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    folder_ = pattern;
    setenv("EOMGEN_CACHE_DIR", (folder_ / "cache").c_str(), 1);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  void clear() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) fs::remove_all(entry);
  }
  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

[[noreturn]] void found(const std::string& what, const Words& words) {
  std::string call = "eomgen";
  for (const std::string& word : words) call += " " + word;
  std::cerr << "found: " << what << "\n  by: " << call << "\n" << std::flush;
  std::abort();
}

struct Result {
  int code = 0;
  std::string out;
};

Result call(const Words& words) {
  Caught out(stdout), err(stderr);
  cli::Declaration declared("eomgen", cli::commands());
  std::vector<std::string> typed{"eomgen"};
  typed.insert(typed.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : typed) pointers.push_back(word.data());
  const std::optional<int> printed = declared.read(pointers);
  const int code = printed ? *printed : declared.execute();
  return {code, out.text()};
}

void check_document(const Result& result, const Words& words) {
  const nlohmann::json document = nlohmann::json::parse(result.out, nullptr, false);
  if (document.is_discarded()) found("no JSON document: " + result.out, words);
  for (const std::string& error : support::schema_errors(document, words.front())) found("schema: " + error, words);
}

/// Whether the error is a defect of this program for any model: derivations disagree, or code cannot be compiled.
bool is_ours(const Error& error) {
  return error.fault() == ErrorKind::tool || error.remedy().find("defect of eomgen") != std::string::npos ||
         error.message().find("internal") != std::string::npos;
}

/// The call of a text, and the position at which its model begins.
std::size_t chosen(const std::vector<Words>& calls, std::string_view text) {
  std::size_t number = text.size();
  if (text.size() > 1 && text[0] == '#' && text[1] >= '0' && text[1] <= '9')
    number = static_cast<std::size_t>(text[1] - '0');
  return number % calls.size();
}

std::vector<std::string> shipped() {
  std::vector<std::string> result;
  std::vector<fs::path> files;
  for (const char* folder : {"models", "tests/fuzz/seeds"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(test::source_folder()) / folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    result.push_back(text.str());
  }
  return result;
}

}  // namespace

const std::vector<Words>& derive_calls() {
  static const std::vector<Words> all{
      {"check", "--json"},
      {"derive", "--show", "all", "--json"},
      {"derive", "--show", "equations,constraints,reactions,friction,conserved,routh", "--approach", "I", "--format",
       "text"},
      {"verify", "--no-compile", "--points", "3", "--json"},
      {"emit", "-o", "OUT", "--with",
       "jac,jac_p,jac_u,jvp,vjp,adjoint,hvp,inverse,coriolis,gravity,mass,energy_gradients,frames,constraints,"
       "reactions,outputs,events,energy,regressor,momentum,reactions_jac,reactions_jac_p,outputs_jac,outputs_jac_u",
       "--json"},
      {"emit", "-o", "OUT", "--target", "python", "--approach", "I", "--json"},
      {"emit", "-o", "OUT", "--target", "latex", "--json"},
      {"emit", "-o", "OUT", "--target", "c", "--with", "taylor,momenta_jac,momenta_jac_p,momenta_jac_u", "--json"},
  };
  return all;
}

const std::vector<Words>& run_calls() {
  static const std::vector<Words> all{
      {"run", "--max-steps", "2000", "--out", "OUT.csv", "--every", "0.1", "--json"},
      {"run", "--max-steps", "2000", "--no-error-estimate", "--plot", "OUT.svg", "--json"},
      {"run", "--max-steps", "500", "--solver", "radau5", "--no-error-estimate", "--json"},
      {"run", "--max-steps", "500", "--t-end", "1", "--solver", "ggl", "--json"},
      {"linearize", "--json"},
      {"equilibria", "--json"},
      {"inverse", "--max-steps", "2000", "--out", "OUT.csv", "--json"},
      {"verify", "--points", "3", "--json"},
  };
  return all;
}

std::string try_command(const std::vector<Words>& calls, const std::string& text) {
  static const Scratch scratch;
  scratch.clear();
  Words words = calls[chosen(calls, text)];
  const std::string model = scratch / "model.toml";
  std::ofstream(model) << text;
  for (std::string& word : words) {
    if (word.starts_with("OUT")) word = scratch / ("out" + word.substr(3));
  }
  words.insert(words.begin() + 1, model);
  try {
    const Result result = call(words);
    if (result.code != 0 && result.code != 3)
      found("exit code " + std::to_string(result.code) + "\n" + result.out, words);
    if (std::find(words.begin(), words.end(), "--json") != words.end()) check_document(result, words);
    return "";
  } catch (const Error& error) {
    if (error.message().empty() || error.remedy().empty())
      found(std::string("an error without a remedy: ") + error.what(), words);
    if (is_ours(error)) found(error.what(), words);
    return error.what();
  } catch (const std::exception& error) {
    found(std::string("internal: ") + error.what(), words);
  }
}

std::string mutate(const std::vector<Words>& calls, const std::string& text, unsigned seed) {
  static const Mutator mutator(shipped());
  Random random(seed);
  random.discard(3);  // consecutive seeds give similar first numbers
  const bool numbered = text.size() > 3 && text[0] == '#' && text[2] == '\n';
  const std::string first =
      numbered && random() % 4 != 0 ? text.substr(0, 3) : "#" + std::to_string(random() % calls.size()) + "\n";
  return first + mutator(numbered ? text.substr(3) : text, random);
}

}  // namespace eomgen::fuzz
