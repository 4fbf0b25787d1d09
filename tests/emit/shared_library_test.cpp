// SPDX-License-Identifier: GPL-3.0-or-later
// The cache of compiled code, also when something is wrong with it.
#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

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
emit::Compiled load() { return emit::compile_and_load(sources().c, sources().h, "pendulum"); }

std::string failure(const std::string& c) {
  try {
    emit::compile_and_load(c, sources().h, "pendulum");
  } catch (const Error& error) {
    CHECK(error.fault() == Fault::tool);
    return error.message() + " / " + error.remedy();
  }
  return "";
}

}  // namespace

TEST_CASE("cache: compiled once, found the second time, made again for another source") {
  const Folder cache;
  const Setting setting("EOMGEN_CACHE_DIR", cache.path);
  CHECK_FALSE(load().cached);
  const auto again = load();
  CHECK(again.cached);
  CHECK((again.model.jac != nullptr));
  CHECK(again.model.info.starts_with("{\"model\":\"pendulum\""));
  CHECK_FALSE(emit::compile_and_load(sources().c + "\n", sources().h, "pendulum").cached);
  // nothing is left of the making
  for (const auto& entry : std::filesystem::directory_iterator(cache.path)) {
    CHECK(entry.path().filename().string().size() == 32);
  }
}

TEST_CASE("cache: a broken entry is noticed and made again") {
  const Folder cache;
  const Setting setting("EOMGEN_CACHE_DIR", cache.path);
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
  const Setting setting("EOMGEN_CACHE_DIR", cache.path);
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

TEST_CASE("compiler: one that is missing is told with the command that installs one") {
  const Folder cache;
  const Setting folder("EOMGEN_CACHE_DIR", cache.path);
  const Setting compiler("EOMGEN_CC", "no-such-compiler");
  CHECK(failure(sources().c) ==
        "the C compiler `no-such-compiler` does not run / sudo apt-get install gcc libc6-dev, or unset EOMGEN_CC and CC");
}

TEST_CASE("compiler: what it says about code that does not compile is shown, and nothing is kept") {
  const Folder cache;
  const Setting folder("EOMGEN_CACHE_DIR", cache.path);
  const std::string said = failure("int pendulum_abi(void) { return mistake; }\n");
  CHECK(said.find("mistake") != std::string::npos);
  CHECK(said.find("failed on emitted code") != std::string::npos);
  CHECK(std::filesystem::is_empty(cache.path));
}

TEST_CASE("compiled code that fails its self test is refused and not kept") {
  const Folder cache;
  const Setting folder("EOMGEN_CACHE_DIR", cache.path);
  std::string c = sources().c;
  const std::size_t place = c.find("sin(theta)");
  REQUIRE(place != std::string::npos);
  c.replace(place, 3, "cos");
  CHECK(failure(c).find("fails its self test, vector 1") != std::string::npos);
  CHECK(std::filesystem::is_empty(cache.path));
}

TEST_CASE("cache: a folder that cannot be used is told") {
  const Setting folder("EOMGEN_CACHE_DIR", "/proc/no-such-folder");
  CHECK(failure(sources().c).find("cannot use the cache folder /proc/no-such-folder") != std::string::npos);
}

TEST_CASE("processes: arguments are arguments, never a shell's") {
  const auto finished = emit::run_process({"echo", "$(id)", "; ls", "*"});
  CHECK(finished.output == "$(id) ; ls *\n");
  CHECK_FALSE(emit::run_process({"no-such-program"}).started);
}
