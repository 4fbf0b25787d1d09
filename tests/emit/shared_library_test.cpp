// SPDX-License-Identifier: GPL-3.0-or-later
// The cache of compiled code, including damaged and untrusted caches.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>

#include "emit/examples.hpp"
#include "error.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

struct Sources {
  std::string c, h;
};
const Sources& sources() {
  static const Sources made = [] {
    const Example e = examples()[0];
    const auto files = emit::emit(e.program, e.context, "c");
    return Sources{files[0].text, files[1].text};
  }();
  return made;
}
emit::CompiledModel load() { return emit::compile_and_load(sources().c, sources().h, "pendulum"); }

std::string failure(const std::string& c) {
  try {
    emit::compile_and_load(c, sources().h, "pendulum");
  } catch (const Error& error) {
    CHECK(error.fault() == ErrorKind::tool);
    return error.message() + " / " + error.remedy();
  }
  return "";
}

}  // namespace

TEST_CASE("cache: compiled once, found the second time, and compiled again for another source") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  CHECK_FALSE(load().cached);
  const auto again = load();
  CHECK(again.cached);
  CHECK((again.model.jac != nullptr));
  CHECK(again.model.info.starts_with("{\"model\":\"pendulum\""));
  CHECK_FALSE(emit::compile_and_load(sources().c + "\n", sources().h, "pendulum").cached);
  // no temporary files remain
  for (const auto& entry : std::filesystem::directory_iterator(cache.path)) {
    CHECK(entry.path().filename().string().size() == 64);
  }
}

TEST_CASE("cache: a damaged entry is detected and replaced") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  const std::string path = load().path;
  for (const std::string& damage : {std::string("garbage"), std::string()}) {
    std::filesystem::remove(path);
    std::ofstream(path) << damage;
    const auto made = load();
    CHECK_FALSE(made.cached);
    double x[2], p[3], dx[2];
    made.model.defaults(x, p);
    CHECK(made.model.rhs(0, x, p, nullptr, 0, dx) == 0);
    CHECK(load().cached);
  }
  std::filesystem::remove(std::filesystem::path(path).parent_path() / "checksum");
  CHECK_FALSE(load().cached);
  CHECK(load().cached);
}

TEST_CASE("cache: several processes at once all get their code") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  (void)sources();
  std::vector<pid_t> children;
  for (int i = 0; i < 4; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      int code = 1;
      try {
        double x[2], p[3], dx[2];
        const auto compiled = load();
        compiled.model.defaults(x, p);
        code = compiled.model.rhs(0, x, p, nullptr, 0, dx);
      } catch (...) {
      }
      ::_exit(code);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 1;
    ::waitpid(child, &status, 0);
    CHECK(status == 0);
  }
  CHECK(load().cached);
}

TEST_CASE("compiler: a missing one is reported with the install command") {
  const Folder cache;
  const ScopedEnvironmentVariable folder("EOMGEN_CACHE_DIR", cache.path);
  const ScopedEnvironmentVariable compiler("EOMGEN_CC", "no-such-compiler");
  CHECK(
      failure(sources().c) ==
      "the C compiler `no-such-compiler` does not run / sudo apt-get install gcc libc6-dev, or unset EOMGEN_CC and CC");
}

TEST_CASE("compiler: its messages about invalid code are shown, and nothing is cached") {
  const Folder cache;
  const ScopedEnvironmentVariable folder("EOMGEN_CACHE_DIR", cache.path);
  const std::string said = failure("int pendulum_abi(void) { return mistake; }\n");
  CHECK(said.find("mistake") != std::string::npos);
  CHECK(said.find("failed on emitted code") != std::string::npos);
  CHECK(std::filesystem::is_empty(cache.path));
}

TEST_CASE("compiled code that fails its self-test is rejected and not cached") {
  const Folder cache;
  const ScopedEnvironmentVariable folder("EOMGEN_CACHE_DIR", cache.path);
  std::string c = sources().c;
  const std::size_t place = c.find("sin(theta)");
  REQUIRE(place != std::string::npos);
  c.replace(place, 3, "cos");
  CHECK(failure(c).find("fails its self test, vector 1") != std::string::npos);
  CHECK(std::filesystem::is_empty(cache.path));
}

TEST_CASE("cache: an unusable folder is reported") {
  const ScopedEnvironmentVariable folder("EOMGEN_CACHE_DIR", "/proc/no-such-folder");
  CHECK(failure(sources().c).find("cannot use the cache folder /proc/no-such-folder") != std::string::npos);
}

TEST_CASE("cache: a folder that another user could write to is not used, and this is reported") {
  const Folder place;
  const std::string cache = place.path + "/cache";
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache);
  CHECK(load().note.empty());
  CHECK(std::filesystem::status(cache).permissions() == std::filesystem::perms::owner_all);
  CHECK(load().cached);
  const auto refused = [&](const std::string& why) {
    std::string path;
    {
      const emit::CompiledModel code = load();
      CHECK_FALSE(code.cached);
      CHECK(code.note.find(cache) != std::string::npos);
      CHECK(code.note.find(why) != std::string::npos);
      CHECK_FALSE(code.path.starts_with(cache));
      path = code.path;
      CHECK(std::filesystem::status(std::filesystem::path(path).parent_path()).permissions() ==
            std::filesystem::perms::owner_all);
    }
    CHECK_FALSE(std::filesystem::exists(path));  // removed with the code
  };
  for (const int mode : {0755, 0770, 0701, 0777}) {
    REQUIRE(::chmod(cache.c_str(), static_cast<mode_t>(mode)) == 0);
    refused("others may enter it");
  }
  REQUIRE(::chmod(cache.c_str(), 0700) == 0);
  CHECK(load().cached);
  std::filesystem::rename(cache, place.path + "/real");
  std::filesystem::create_symlink("real", cache);
  refused("it is a link");
  std::filesystem::remove(cache);
  if (::geteuid() == 0) {
    std::filesystem::create_directory(cache);
    REQUIRE(::chmod(cache.c_str(), 0700) == 0);
    REQUIRE(::chown(cache.c_str(), 12345, 12345) == 0);
    refused("it belongs to another user");
    REQUIRE(::chown(cache.c_str(), 0, 0) == 0);
    std::filesystem::remove_all(cache);
  }
  std::filesystem::rename(place.path + "/real", cache);
  REQUIRE(::chmod(place.path.c_str(), 0777) == 0);
  refused("others may put another one in its place");
  REQUIRE(::chmod(place.path.c_str(), 0700) == 0);
  // An entry or library that is a link is replaced.
  const std::filesystem::path library = load().path;
  std::filesystem::rename(library, place.path + "/planted.so");
  std::filesystem::create_symlink(place.path + "/planted.so", library);
  CHECK_FALSE(load().cached);
  CHECK_FALSE(std::filesystem::is_symlink(library));
}

TEST_CASE(
    "cache: without a home it is in the temporary folder, also if TMPDIR is not a folder, and never in one that "
    "existed before") {
  const Folder temporary;
  const ScopedEnvironmentVariable none("EOMGEN_CACHE_DIR", ""), xdg("XDG_CACHE_HOME", ""), home("HOME", "");
  const ScopedEnvironmentVariable there("TMPDIR", temporary.path);
  const std::string predictable = temporary.path + "/eomgen-" + std::to_string(::geteuid());
  std::filesystem::create_directory(predictable);
  REQUIRE(::chmod(predictable.c_str(), 0777) == 0);
  const emit::CompiledModel code = load();
  CHECK_FALSE(code.note.empty());
  CHECK(std::filesystem::is_empty(predictable));
  CHECK_FALSE(load().cached);
  const ScopedEnvironmentVariable missing("TMPDIR", temporary.path + "/nowhere");
  CHECK((load().model.rhs != nullptr));
}

TEST_CASE("cache: leftovers of killed runs are removed, folders in use are not") {
  const Folder cache;
  const ScopedEnvironmentVariable setting("EOMGEN_CACHE_DIR", cache.path);
  const auto make = [&](const std::string& name, bool old) {
    const std::string path = cache.path + "/" + name;
    std::filesystem::create_directory(path);
    std::ofstream(path + "/half.c") << "int";
    if (old)
      std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
    return path;
  };
  const std::string left = make("make-killed", true), new_one = make("make-newone", false),
                    held = make("make-beheld", true);
  const int file = ::open(held.c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(::flock(file, LOCK_EX) == 0);
  (void)load();
  CHECK_FALSE(std::filesystem::exists(left));
  CHECK(std::filesystem::exists(new_one));
  CHECK(std::filesystem::exists(held));
  ::close(file);
}

TEST_CASE("processes: a hanging process is terminated with its children") {
  const Folder folder;
  const std::atomic<bool> raised{true};
  const auto begin = std::chrono::steady_clock::now();
  const emit::ProcessResult finished = emit::run_process({"/bin/sh", "-c", "sleep 100 & sleep 100"}, &raised);
  CHECK(finished.interrupted);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));
}

TEST_CASE("processes: arguments are never interpreted by a shell") {
  const auto finished = emit::run_process({"echo", "$(id)", "; ls", "*"});
  CHECK(finished.output == "$(id) ; ls *\n");
  CHECK_FALSE(emit::run_process({"no-such-program"}).started);
}
