// SPDX-License-Identifier: GPL-3.0-or-later
// The cache: KEY/ contains the library and its SHA-256, which detects damage. cache_folder ensures that no other user
// can write to it. The folder of a key is created under a temporary name and renamed, so that concurrent processes
// never see a partial entry.
#include "emit/shared_library/build.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "emit/shared_library/cache_folder.hpp"
#include "emit/shared_library/environment.hpp"
#include "emit/shared_library/process.hpp"
#include "error.hpp"
#include "model/content_hash.hpp"

namespace eomgen::emit {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const std::string& remedy) {
  throw Error("compile", {}, what, remedy, ErrorKind::tool);
}

struct Compiler {
  std::vector<std::string> command;  // the program and its fixed arguments ("ccache gcc")
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
  const ProcessResult finished = run_process(question);
  version = finished.output;
  return finished.started && finished.status == 0;
}

/// The first compiler of the recipe that runs; if none does, `refusal` is the reason and `remedy` what to do.
std::optional<Compiler> search_compiler(const Recipe& recipe, std::string& refusal, std::string& remedy) {
  std::vector<std::string> candidates;
  std::string asked;
  for (const std::string& name : recipe.variables) {
    asked = environment(name.c_str());
    if (!asked.empty()) {
      candidates = {asked};
      break;
    }
  }
  if (candidates.empty()) candidates = recipe.compilers;
  for (const std::string& candidate : candidates) {
    for (const std::vector<std::string>& command : {std::vector<std::string>{candidate}, words(candidate)}) {
      std::string version;
      if (runs(command, version)) return Compiler{command, candidate, version};
    }
  }
  std::string unset;
  for (const std::string& name : recipe.variables) unset += (unset.empty() ? "" : " and ") + name;
  refusal = asked.empty() ? "there is no " + recipe.language + " compiler"
                          : "the " + recipe.language + " compiler `" + asked + "` does not run";
  remedy = "sudo apt-get install " + recipe.package + (asked.empty() ? "" : ", or unset " + unset);
  if (!can_start_programs()) remedy = "this eomgen starts no other programs; use one for Linux";
  return std::nullopt;
}

Compiler find_compiler(const Recipe& recipe) {
  std::string refusal, remedy;
  if (std::optional<Compiler> found = search_compiler(recipe, refusal, remedy)) return *found;
  fail(refusal, remedy);
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
  if (!out)
    fail("cannot write " + path.string(), "set EOMGEN_CACHE_DIR to a folder that you may write to, with space left");
}

/// Whether a cache entry contains an intact library.
bool is_whole(const fs::path& entry, const std::string& name) {
  if (!is_own_folder(entry) || !is_own_file(entry / name)) return false;
  const auto library = read_file(entry / name);
  const auto sum = read_file(entry / "checksum");
  return library && sum && model::content_hash(*library) == *sum;
}

void compile_into(const fs::path& folder, const Compiler& compiler, const Recipe& recipe) {
  for (const auto& [name, text] : recipe.files) {
    fs::create_directories((folder / name).parent_path());
    write_file(folder / name, text);
  }
  const fs::path library = folder / (recipe.name + recipe.suffix);
  std::vector<std::string> command = compiler.command;
  command.insert(command.end(), recipe.flags.begin(), recipe.flags.end());
  if (recipe.uses_own_headers)
    command.insert(command.end(), {"-I", folder.string(), "-ffile-prefix-map=" + folder.string() + "=."});
  for (const std::string& argument :
       {(folder / recipe.files.front().first).string(), std::string("-o"), library.string()})
    command.push_back(argument);
  for (const std::string& object : recipe.objects) command.push_back((folder / object).string());
  command.insert(command.end(), recipe.libraries.begin(), recipe.libraries.end());
  const ProcessResult finished = run_process(command, recipe.interrupt);
  if (finished.interrupted)
    throw Error("compile", {}, "interrupted during compilation", "nothing was computed that could be kept",
                ErrorKind::numerical);
  if (!finished.started || finished.status != 0) {
    constexpr std::size_t shown = 4000;
    fail("`" + compiler.name + "` failed on " + recipe.what + ":\n" + finished.output.substr(0, shown), recipe.remedy);
  }
  write_file(folder / "checksum", model::content_hash(read_file(library).value_or("")));
}

/// Renames `made` to `entry`. If another process was faster, its identical entry is used.
void put_in_place(const fs::path& made, const fs::path& entry, const std::string& name) {
  std::error_code failed;
  fs::rename(made, entry, failed);
  if (!failed || is_whole(entry, name)) return;
  // The existing entry is damaged: it is moved away and replaced.
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

BuiltLibrary build_library(const Recipe& recipe, const std::function<void(const std::string& path)>& examine) {
  const Compiler compiler = find_compiler(recipe);
  std::string key;
  for (const auto& [name, text] : recipe.files) key += text + '\0';
  key += compiler.name + '\0' + compiler.version;
  for (const std::string& flag : recipe.flags) key += '\0' + flag;
  for (const std::string& library : recipe.libraries) key += '\0' + library;
  const CacheFolder cache = cache_folder();
  const fs::path entry = cache.path / model::content_hash(key);
  const std::string file = recipe.name + recipe.suffix;
  const std::string library = (entry / file).string();
  BuiltLibrary built{library, true, 0, cache.scratch, cache.reason};

  if (!cache.scratch && is_whole(entry, file)) return built;
  if (!cache.scratch) clear_leftovers(cache.path, scratch_prefix);
  try {
    const ScratchFolder workplace(cache.path, scratch_prefix);
    const auto begin = std::chrono::steady_clock::now();
    compile_into(workplace.path(), compiler, recipe);
    built.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (examine) examine((workplace.path() / file).string());
    put_in_place(workplace.path(), entry, file);
  } catch (const std::system_error&) {
    fail("cannot use the cache folder " + cache.path.string(),
         "set EOMGEN_CACHE_DIR to a folder that you may write to");
  }
  built.cached = false;
  return built;
}

std::string compiler_refusal(const Recipe& recipe) {
  std::string refusal, remedy;
  search_compiler(recipe, refusal, remedy);
  return refusal;
}

}  // namespace eomgen::emit
