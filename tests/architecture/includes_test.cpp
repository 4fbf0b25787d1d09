// What the include directories of the build (cmake/eomgen_stage.cmake) do not enforce of the dependency rule of
// docs/architecture.md, checked on the include lines.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "architecture/sources.hpp"
#include "support/folders.hpp"

using namespace architecture;
namespace fs = std::filesystem;

namespace {

const fs::path source_root = eomgen::test::source_folder();

/// The products of the stages. They are plain data.
const std::set<std::string> products = {
    "forces/registry.inc",    "model/expression.hpp",   "model/model.hpp",         "mechanics/mechanics.hpp",
    "system/output.hpp",      "system/expressions.hpp", "system/chart_change.hpp", "system/equation_system.hpp",
    "system/array_loops.hpp", "program/program.hpp",
};

/// Libraries by the prefix of their headers' paths, with the folders of generator/ that may include them.
const std::vector<std::pair<std::string, std::set<std::string>>> libraries = {
    {"ginac/", {"reading"}},
    {"cln/",
     {"analysis", "cli", "emit", "eomgen", "jit", "linear", "mechanics", "model", "numeric", "oracle", "pipeline",
      "print", "program", "reading", "reference", "run", "stress", "symbolic", "verify"}},
    {"eom/",
     {"analysis", "bench", "cli", "emit", "eomgen", "import", "jit", "linear", "mechanics", "model", "pipeline",
      "print", "program", "run", "stress", "symbolic", "system", "verify"}},
    {"fmt/", {"analysis", "bench",     "cli",   "derive", "emit",     "eomgen", "error.cpp",
              "import",   "mechanics", "model", "oracle", "pipeline", "print",  "program",
              "reading",  "reference", "run",   "stress", "symbolic", "verify"}},
    {"Eigen/", {"analysis", "linear", "numeric", "pipeline", "run", "stress"}},
    {"nlohmann/", {"cli", "emit", "pipeline"}},
    {"CLI/", {"cli"}},
    {"toml++/", {"model"}},
    {"pugixml.hpp", {"cli", "import"}},
    {"asmjit/", {"jit"}},
    {"minizip/", {"emit"}},
    {"zlib.h", {"cli"}},
    {"cairo/", {"cli"}},
};

std::string place(const fs::path& file, const Include& include) {
  return fs::relative(file, source_root).generic_string() + ":" + std::to_string(include.line) + " includes " +
         include.path;
}

std::string first_part(const std::string& path) { return path.substr(0, path.find('/')); }

}  // namespace

TEST_CASE("the build shows each stage the headers of its needs alone") {
  // A compiler's search path with all of generator/ would make every include possible.
  for (const char* folder : {"cmake", "generator", "lib", "python", "tests"}) {
    for (const fs::path& list : files_below(source_root / folder, {".txt", ".cmake"})) {
      INFO(fs::relative(list, source_root).generic_string());
      const std::string text = read_text(list);
      for (const char* wide : {"SOURCE_DIR}/generator)", "SOURCE_DIR}/generator>", "SOURCE_DIR}/generator "})
        CHECK(text.find(wide) == std::string::npos);
    }
  }
}

TEST_CASE("a library is included by the folders that need it alone") {
  for (const auto& [prefix, folders] : libraries) {
    std::set<std::string> found;
    for (const fs::path& file : files_below(source_root / "generator", {".cpp", ".hpp"})) {
      for (const Include& include : parse_includes(read_text(file))) {
        if (!include.path.starts_with(prefix)) continue;
        const std::string folder = first_part(fs::relative(file, source_root / "generator").generic_string());
        INFO(place(file, include));
        CHECK(folders.count(folder) == 1);
        found.insert(folder);
      }
    }
    CAPTURE(prefix);
    CHECK(found == folders);
  }
}

TEST_CASE("every test includes doctest, directly or by a header of its folder, as plain builds require") {
  const auto names_doctest = [](const fs::path& file) {
    const std::vector<Include> includes = parse_includes(read_text(file));
    return std::any_of(includes.begin(), includes.end(),
                       [](const Include& i) { return i.path == "doctest/doctest.h"; });
  };
  std::size_t seen = 0;
  for (const fs::path& file : files_below(source_root / "tests", {".cpp"})) {
    if (!file.filename().string().ends_with("_test.cpp")) continue;
    ++seen;
    bool named = names_doctest(file);
    for (const Include& include : parse_includes(read_text(file))) {
      const fs::path header = source_root / "tests" / include.path;
      named = named || (include.quoted && fs::exists(header) && names_doctest(header));
    }
    INFO(file.string());
    CHECK(named);
  }
  CHECK(seen > 200);
}

TEST_CASE("products include only products and the graph, no implementation of a stage") {
  for (const std::string& header : products) {
    const fs::path file = source_root / "generator" / header;
    for (const Include& include : parse_includes(read_text(file))) {
      if (!include.quoted) continue;
      INFO(place(file, include));
      CHECK((products.count(include.path) == 1 || include.path.starts_with("symbolic/") ||
             include.path == "error.hpp" || include.path == "lists.hpp" || include.path == "results.hpp" ||
             include.path == "work.hpp"));
    }
  }
}

TEST_CASE("the oracle includes only the Model and its own files") {
  const std::set<std::string> others = {
      "model/model.hpp", "model/expression.hpp", "forces/registry.inc", "error.hpp", "lists.hpp", "results.hpp",
      "work.hpp"};
  std::size_t seen = 0;
  for (const fs::path& file : files_below(source_root / "generator/oracle", {".cpp", ".hpp"})) {
    for (const Include& include : parse_includes(read_text(file))) {
      if (!include.quoted) continue;
      ++seen;
      INFO(place(file, include));
      CHECK((include.path.starts_with("oracle/") || others.count(include.path) == 1));
    }
  }
  CHECK(seen > 50);
}

TEST_CASE("the runtime and emitted code include neither the generator nor computer algebra") {
  const std::set<std::string> code = {".hpp", ".h", ".cpp", ".c", ".mustache", ".in"};
  std::size_t seen = 0;
  for (const char* folder : {"lib", "templates", "generated", "examples"}) {
    for (const fs::path& file : files_below(source_root / folder, code)) {
      for (const Include& include : parse_includes(read_text(file))) {
        ++seen;
        INFO(place(file, include));
        CHECK_FALSE(include.path.starts_with("ginac/"));
        CHECK_FALSE(include.path.starts_with("cln/"));
        // Except for the library's public headers in its own example.
        if (!include.path.starts_with("eomgen/")) CHECK_FALSE(fs::exists(source_root / "generator" / include.path));
      }
    }
  }
  CHECK(seen > 20);
}

TEST_CASE("the command line includes only registries and values of the computing stages, no formulas") {
  const std::set<std::string> stages = {"cli",      "abi",   "analysis", "emit",  "model",
                                        "pipeline", "print", "run",      "system"};
  const std::set<std::string> headers = {"error.hpp",
                                         "utf8.hpp",
                                         "lists.hpp",
                                         "results.hpp",
                                         "work.hpp",
                                         "symbolic/dag.hpp",
                                         "symbolic/decimal.hpp",
                                         "program/program.hpp",
                                         "coordinates/coordinate_system.hpp",
                                         "couplings/coupling.hpp",
                                         "derive/formulations.hpp",
                                         "forces/kind.hpp",
                                         "import/import.hpp",
                                         "import/option_words.hpp",
                                         "joints/joint.hpp",
                                         "rotations/rotation.hpp"};
  for (const fs::path& file : files_below(source_root / "generator" / "cli", {".cpp", ".hpp"})) {
    for (const Include& include : parse_includes(read_text(file))) {
      const std::string first = first_part(include.path);
      if (!include.quoted || first == "eom") continue;
      INFO(place(file, include));
      CHECK((stages.count(first) == 1 || headers.count(include.path) == 1));
    }
  }
}

TEST_CASE("commands and the library get compiled code and runs from pipeline::Compilation and BoundRun, nowhere else") {
  // The headers that make code, load it, bind it to a run or integrate it. Each with the files of clients that may
  // include it.
  const std::map<std::string, std::set<std::string>> headers = {
      {"pipeline/code.hpp", {}},
      {"jit/machine_code.hpp", {}},
      {"jit/lanes.hpp", {"eomgen/rhs_lanes.hpp"}},  // batches of CompiledModel
      {"emit/shared_library/loaded_model.hpp", {}},
      {"emit/shared_library/loaded_batch.hpp", {}},
      {"emit/shared_library/build.hpp", {"bench/libraries.cpp"}},  // adapters of other libraries, no models
      {"run/bind.hpp", {}},
      // Requests of BoundRun, observed step by step.
      {"run/integration.hpp",
       {"analysis/benchmark.cpp", "analysis/stress_test.cpp", "bench/measure.cpp", "stress/reference_solution.hpp"}},
      {"eom/hybrid/run.hpp", {}},
      {"eom/hybrid/stepwise_run.hpp", {"eomgen/simulation.cpp"}},  // simulations in pieces
  };
  std::map<std::string, std::set<std::string>> found;
  for (const char* folder : {"cli", "analysis", "bench", "stress", "eomgen"}) {
    for (const fs::path& file : files_below(source_root / "generator" / folder, {".cpp", ".hpp"})) {
      for (const Include& include : parse_includes(read_text(file)))
        if (headers.count(include.path) == 1)
          found[include.path].insert(fs::relative(file, source_root / "generator").generic_string());
    }
  }
  for (const auto& [header, clients] : headers) {
    CAPTURE(header);
    CHECK((fs::exists(source_root / "generator" / header) || fs::exists(source_root / "lib" / header)));
    CHECK(found[header] == clients);
  }
}

TEST_CASE("no file contains a path of the machine on which it was written or built") {
  // Split into two parts, because the test checks this file too.
  const std::vector<std::string> never = {
      "/wo"
      "rk/",
      "/ho"
      "me/",
      "/ro"
      "ot/",
      "/Us"
      "ers/",
      "C:"
      "\\"};
  std::vector<fs::path> files;
  for (const char* folder : {".ci", "bench", "cmake", "docs", "examples", "generated", "generator", "lib", "models",
                             "scripts", "templates", "tests"}) {
    const std::vector<fs::path> more = files_below(source_root / folder);
    files.insert(files.end(), more.begin(), more.end());
  }
  for (const char* file : {"CMakeLists.txt", "CMakePresets.json", "README.md"}) files.push_back(source_root / file);
  for (const fs::path& file : files) {
    const std::string text = read_text(file);
    INFO(fs::relative(file, source_root).generic_string());
    for (const std::string& folder : never) {
      const std::size_t at = text.find(folder);
      INFO("names " << folder << " in: " << (at == std::string::npos ? "" : text.substr(at, 60)));
      CHECK(at == std::string::npos);
    }
  }
}
