// SPDX-License-Identifier: GPL-3.0-or-later
// Cache of positive certificates: the key has everything that the certificate depends on.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "program.hpp"

using namespace eomgen::test;

namespace {

std::vector<std::filesystem::path> cached_files(const Folder& folder) {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "cache")) {
    if (entry.path().filename().string().starts_with("certificate-")) result.push_back(entry.path());
  }
  return result;
}

ChildResult with_cache(const Folder& folder, const Words& words) {
  ChildCommand call = command(folder, words);
  call.environment["EOMGEN_CACHE_DIR"] = folder / "cache";
  return Child(call).finish();
}

/// Changes a formulation and a difference in a cached certificate.
void overwrite_verdict(const std::filesystem::path& path) {
  std::ifstream in(path);
  Json document = Json::parse(in);
  document["comparisons"][0][0] = "another formulation";
  document["comparisons"][0][3] = 1.25e-50;
  std::ofstream(path) << document.dump();
}

}  // namespace

TEST_CASE(
    "cached certificates: a command uses the result of an earlier one for the same model, program and options only") {
  const Folder folder;
  folder.write("p.toml", pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0 }"));
  const Words emit{"emit", "p.toml", "-o", "out"};
  const ChildResult first = with_cache(folder, emit);
  REQUIRE(first.status == 0);
  REQUIRE(cached_files(folder).size() == 1);
  CHECK(with_cache(folder, emit).out == first.out);
  CHECK(cached_files(folder).size() == 1);
  overwrite_verdict(cached_files(folder).front());
  CHECK(contains(with_cache(folder, emit).out, "worst 1.2e-50 (another formulation"));
  // Another seed, function, byte of the model or other code: each is verified again.
  for (const Words& other :
       {Words{"emit", "p.toml", "-o", "out", "--seed", "2"}, Words{"emit", "p.toml", "-o", "out", "--with", "jac"},
        Words{"emit", "p.toml", "-o", "out", "--fix", "g"},
        Words{"emit", "p.toml", "-o", "out", "--form", "nullspace"}}) {
    const std::size_t before = cached_files(folder).size();
    const ChildResult result = with_cache(folder, other);
    CHECK(result.status == 0);
    CHECK_FALSE(contains(result.out, "another formulation"));
    CHECK(cached_files(folder).size() == before + 1);
  }
  folder.write("p.toml", folder.read("p.toml") + "# the same\n");
  CHECK_FALSE(contains(with_cache(folder, emit).out, "another formulation"));
}

TEST_CASE("cached certificates: a document has that of an earlier one") {
  const Folder folder;
  folder.write("p.toml", pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0 }"));
  const Words emit{"emit", "p.toml", "-o", "out", "--target", "latex"};
  REQUIRE(with_cache(folder, emit).status == 0);
  const std::string first = folder.read("out/p.tex");
  REQUIRE(cached_files(folder).size() == 1);
  CHECK(with_cache(folder, emit).status == 0);
  CHECK(folder.read("out/p.tex") == first);
  overwrite_verdict(cached_files(folder).front());
  CHECK(with_cache(folder, emit).status == 0);
  CHECK(contains(folder.read("out/p.tex"), "another formulation"));
  CHECK(with_cache(folder, with(emit, {"--seed", "2"})).status == 0);
  CHECK_FALSE(contains(folder.read("out/p.tex"), "another formulation"));
}

TEST_CASE("cached certificates: verify ignores the cache, and damaged entries are replaced") {
  const Folder folder;
  folder.write("p.toml", pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0 }"));
  REQUIRE(with_cache(folder, {"run", "p.toml"}).status == 0);
  REQUIRE(cached_files(folder).size() == 1);
  CHECK(contains(with_cache(folder, {"run", "p.toml"}).out, "(kept)"));
  overwrite_verdict(cached_files(folder).front());
  CHECK_FALSE(contains(with_cache(folder, {"verify", "p.toml", "--points", "5"}).out, "another formulation"));
  for (const char* damaged :
       {"", "{", "[]", "{\"key\": 1}",
        "{\"key\": \"x\", \"points\": -1, \"rejected\": {}, \"comparisons\": [[1]], \"left_out\": []}"}) {
    std::ofstream(cached_files(folder).front()) << damaged;
    const ChildResult result = with_cache(folder, {"run", "p.toml"});
    CHECK(result.status == 0);
    CHECK_FALSE(contains(result.out, "(kept)"));
  }
  CHECK(contains(with_cache(folder, {"run", "p.toml"}).out, "(kept)"));
}

TEST_CASE("cached certificates: commands work without a cache folder") {
  const Folder folder;
  folder.write("p.toml", pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0 }"));
  std::filesystem::create_directory(folder / "open");
  std::filesystem::permissions(folder / "open", std::filesystem::perms::all);
  for (const std::string& cache : {std::string("/proc/no-such-folder"), folder / "open"}) {
    CAPTURE(cache);
    ChildCommand call = command(folder, {"emit", "p.toml", "-o", "out"});
    call.environment["EOMGEN_CACHE_DIR"] = cache;
    const ChildResult result = Child(call).finish();
    CHECK(result.status == 0);
    CHECK(contains(result.out, "certificate pass"));
  }
  ChildCommand call = command(folder, {"run", "p.toml", "--tier", "compiled"});
  call.environment["EOMGEN_CACHE_DIR"] = folder / "open";
  const ChildResult reply = Child(call).finish();
  CHECK(reply.status == 0);
  CHECK(contains(reply.err, "what is compiled now is kept in a private one"));
  CHECK(std::filesystem::is_empty(folder / "open"));
}
