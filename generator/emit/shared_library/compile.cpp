// SPDX-License-Identifier: GPL-3.0-or-later
// The cache: KEY/ holds the library and its checksum. A key's folder is made beside and renamed, so that it is there
// whole or not at all, whoever else is at it; what is in it is believed only if the checksum is right.
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "emit/shared_library/checksum.hpp"
#include "emit/shared_library/loaded_model.hpp"
#include "emit/shared_library/process.hpp"
#include "error.hpp"

namespace eomgen::emit {
namespace {

namespace fs = std::filesystem;

// Nobody reads errno, so that sqrt is one instruction; products and sums are rounded separately everywhere, so that
// every processor computes the same numbers.
const std::vector<std::string>& flags() {
  static const std::vector<std::string> list = {"-std=c11", "-O2",    "-fno-math-errno", "-ffp-contract=off",
                                                "-fPIC",    "-shared"};
  return list;
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path cache_folder() {
  if (const std::string own = environment("EOMGEN_CACHE_DIR"); !own.empty()) return own;
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) return fs::path(xdg) / "eomgen";
  if (const std::string home = environment("HOME"); !home.empty()) return fs::path(home) / ".cache" / "eomgen";
  return fs::temp_directory_path() / ("eomgen-" + std::to_string(::getuid()));
}

[[noreturn]] void fail(const std::string& what, const std::string& remedy) { throw Error("compile", {}, what, remedy, Fault::tool); }

struct Compiler {
  std::vector<std::string> command;  // the program and what it is always given ("ccache gcc")
  std::string name, version;
};

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string word; in >> word;) result.push_back(word);
  return result;
}

bool runs(const std::vector<std::string>& command, std::string& version) {
  if (command.empty()) return false;
  std::vector<std::string> question = command;
  question.push_back("--version");
  const Finished finished = run_process(question);
  version = finished.output;
  return finished.started && finished.status == 0;
}

Compiler find_compiler() {
  std::vector<std::string> candidates;
  std::string asked;
  for (const char* name : {"EOMGEN_CC", "CC"}) {
    asked = environment(name);
    if (!asked.empty()) {
      candidates = {asked};
      break;
    }
  }
  if (candidates.empty()) candidates = {"cc", "gcc"};
  for (const std::string& candidate : candidates) {
    for (const std::vector<std::string>& command : {std::vector<std::string>{candidate}, words(candidate)}) {
      std::string version;
      if (runs(command, version)) return {command, candidate, version};
    }
  }
  fail(asked.empty() ? "there is no C compiler" : "the C compiler `" + asked + "` does not run",
       "sudo apt-get install gcc libc6-dev" + std::string(asked.empty() ? "" : ", or unset EOMGEN_CC and CC"));
}

std::optional<std::string> read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) fail("cannot write " + path.string(), "set EOMGEN_CACHE_DIR to a folder that you may write to, with space left");
}

/// The library of a cache entry that is whole.
bool is_whole(const fs::path& entry, const std::string& name) {
  const auto library = read_file(entry / (name + ".so"));
  const auto sum = read_file(entry / "checksum");
  return library && sum && checksum(*library) == *sum;
}

/// A folder that is removed again unless it is handed on.
struct Workplace {
  fs::path path;
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

void compile_into(const fs::path& folder, const Compiler& compiler, const std::string& source, const std::string& header,
                  const std::string& name) {
  write_file(folder / (name + ".c"), source);
  write_file(folder / (name + ".h"), header);
  const fs::path library = folder / (name + ".so");
  std::vector<std::string> command = compiler.command;
  command.insert(command.end(), flags().begin(), flags().end());
  for (const std::string& argument : {(folder / (name + ".c")).string(), std::string("-o"), library.string(), std::string("-lm")}) {
    command.push_back(argument);
  }
  const Finished finished = run_process(command);
  if (!finished.started || finished.status != 0) {
    constexpr std::size_t shown = 4000;
    fail("`" + compiler.name + "` failed on emitted code:\n" + finished.output.substr(0, shown),
         "check the compiler (EOMGEN_CC, CC); if it is in order, please report the model");
  }
  write_file(folder / "checksum", checksum(read_file(library).value_or("")));
}

/// Puts `made` in the place of `entry`; another process that was faster has made the same.
void put_in_place(const fs::path& made, const fs::path& entry, const std::string& name) {
  std::error_code failed;
  fs::rename(made, entry, failed);
  if (!failed || is_whole(entry, name)) return;
  // What is there is broken: out of the way, then again.
  fs::path broken = made;
  broken += ".broken";
  std::error_code ignored;
  fs::rename(entry, broken, ignored);
  fs::remove_all(broken, ignored);
  fs::rename(made, entry, failed);
  if (failed && !is_whole(entry, name)) {
    fail("cannot put compiled code into " + entry.string() + ": " + failed.message(),
         "set EOMGEN_CACHE_DIR to a folder that you may write to");
  }
}

}  // namespace

Compiled compile_and_load(const std::string& c_source, const std::string& header, const std::string& name) {
  const Compiler compiler = find_compiler();
  std::string key = c_source + '\0' + header + '\0' + compiler.name + '\0' + compiler.version;
  for (const std::string& flag : flags()) key += '\0' + flag;
  const fs::path folder = cache_folder();
  const fs::path entry = folder / checksum(key);
  const std::string library = (entry / (name + ".so")).string();

  if (is_whole(entry, name)) return {LoadedModel(library, name), library, true, 0};
  std::error_code failed;
  fs::create_directories(folder, failed);
  std::string place = (folder / "make-XXXXXX").string();
  if (failed || ::mkdtemp(place.data()) == nullptr) {
    fail("cannot use the cache folder " + folder.string(), "set EOMGEN_CACHE_DIR to a folder that you may write to");
  }
  const Workplace workplace{place};
  const auto begin = std::chrono::steady_clock::now();
  compile_into(workplace.path, compiler, c_source, header, name);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Loaded once before it is kept: code that fails its self test does not reach the cache.
  LoadedModel((workplace.path / (name + ".so")).string(), name);
  put_in_place(workplace.path, entry, name);
  return {LoadedModel(library, name), library, false, seconds};
}

}  // namespace eomgen::emit
