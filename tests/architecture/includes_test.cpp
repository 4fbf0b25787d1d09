// The dependency rule of docs/architecture.md, checked on the include lines. All stages share one include path, so the
// compiler does not enforce it.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "architecture/stages.hpp"
#include "support/folders.hpp"

using namespace architecture;
namespace fs = std::filesystem;

namespace {

const fs::path source_root = eomgen::test::source_folder();

/// The products of the stages in the order of the data flow. They are plain data: a later stage may read them without
/// depending on the stage that creates them.
const std::vector<std::pair<std::string, std::string>> products = {
    {"forces", "forces/registry.inc"},    {"model", "model/expression.hpp"},
    {"model", "model/model.hpp"},         {"mechanics", "mechanics/mechanics.hpp"},
    {"system", "system/output.hpp"},      {"system", "system/equation_system.hpp"},
    {"system", "system/expressions.hpp"}, {"system", "system/chart_change.hpp"},
    {"system", "system/array_loops.hpp"}, {"program", "program/program.hpp"},
};
const std::vector<std::string> data_flow = {"forces", "model",  "coordinates",  "symbolic", "mechanics",
                                            "derive", "system", "conservation", "reading",  "program",
                                            "verify", "print",  "emit",         "run",      "cli"};

/// Libraries by the prefix of their headers' paths, with the targets that provide them.
const std::vector<std::pair<std::string, std::set<std::string>>> libraries = {
    {"ginac/", {"GiNaC::ginac"}},
    {"cln/", {"GiNaC::cln", "GiNaC::ginac"}},
    {"Eigen/", {"Eigen3::Eigen"}},
    {"eom/", {"eomgen::runtime", "eomgen_runtime"}},
    {"fmt/", {"fmt::fmt", "error"}},  // error links fmt publicly
    {"nlohmann/", {"nlohmann_json::nlohmann_json"}},
    {"CLI/", {"CLI11::CLI11"}},
    {"toml++/", {"tomlplusplus::tomlplusplus"}},
    {"pugixml.hpp", {"pugixml::pugixml"}},
    {"asmjit/", {"asmjit::asmjit"}},
    {"minizip/", {"Minizip::minizip"}},
    {"zlib.h", {"Minizip::minizip"}},
    {"cairo/", {"Cairo::cairo"}},
};

std::string place(const fs::path& file, const Include& include) {
  return fs::relative(file, source_root).generic_string() + ":" + std::to_string(include.line) + " includes " +
         include.path;
}

std::string first_part(const std::string& path) { return path.substr(0, path.find('/')); }

bool is_product(const std::string& path) {
  return std::any_of(products.begin(), products.end(), [&](const auto& product) { return product.second == path; });
}

bool comes_before(const std::string& a, const std::string& b) {
  const auto end = data_flow.end();
  const auto at_a = std::find(data_flow.begin(), end, a), at_b = std::find(data_flow.begin(), end, b);
  return at_a != end && at_b != end && at_a < at_b;
}

struct Generator {
  std::map<std::string, Stage> stages;                   // by name
  std::map<std::string, std::set<std::string>> folders;  // folder -> names of its stages

  std::set<std::string> reached_from(const std::string& folder) const {
    std::set<std::string> reached;
    for (const std::string& stage : folders.at(folder)) reached.merge(reachable(stage, stages));
    return reached;
  }
};

Generator read_generator() {
  Generator generator;
  for (const fs::directory_entry& entry : fs::directory_iterator(source_root / "generator")) {
    const fs::path list = entry.path() / "CMakeLists.txt";
    if (!fs::exists(list)) continue;
    const std::string folder = entry.path().filename().string();
    const std::string text = read_text(list);
    for (Stage& stage : parse_stages(folder, text)) {
      generator.folders[folder].insert(stage.name);
      // A folder whose sources are compiled by the stage of another folder belongs to that stage too.
      std::vector<std::string> sources = stage.sources;
      for (const std::vector<std::string>& arguments : cmake_calls(text, "target_sources"))
        if (!arguments.empty() && arguments.front() == "eomgen_" + stage.name)
          sources.insert(sources.end(), arguments.begin() + 1, arguments.end());
      for (const std::string& source : sources)
        if (source.starts_with("../")) generator.folders[first_part(source.substr(3))].insert(stage.name);
      generator.stages.emplace(stage.name, std::move(stage));
    }
  }
  return generator;
}

}  // namespace

TEST_CASE("a stage includes its own folder, the stages under NEEDS, and products of earlier stages only") {
  const Generator generator = read_generator();
  REQUIRE(generator.stages.size() >= 8);
  for (const auto& [folder, owners] : generator.folders) {
    const std::set<std::string> reached = generator.reached_from(folder);
    std::set<std::string> allowed{folder};
    if (reached.count("error") == 1) allowed.insert({"error.hpp", "lists.hpp", "results.hpp", "utf8.hpp", "work.hpp"});
    for (const auto& [other, stages] : generator.folders)
      for (const std::string& stage : stages)
        if (reached.count(stage) == 1) allowed.insert(other);

    for (const fs::path& file : files_below(source_root / "generator" / folder, {".cpp", ".hpp"})) {
      for (const Include& include : parse_includes(read_text(file))) {
        const std::string first = first_part(include.path);
        if (!include.quoted || first == "eom") continue;
        INFO(place(file, include));
        if (is_product(include.path) && comes_before(first, folder)) continue;
        if (first == "skeletons" && (folder == "emit" || folder == "bench" || folder == "jit"))
          continue;  // generated from templates/ during the build
        CHECK(allowed.count(first) == 1);
      }
    }
  }
}

TEST_CASE("a stage includes the libraries that its CMakeLists.txt links, and no others") {
  const Generator generator = read_generator();
  for (const auto& [folder, owners] : generator.folders) {
    const std::set<std::string> reached = generator.reached_from(folder);
    for (const fs::path& file : files_below(source_root / "generator" / folder, {".cpp", ".hpp"})) {
      for (const Include& include : parse_includes(read_text(file))) {
        for (const auto& [prefix, targets] : libraries) {
          if (!include.path.starts_with(prefix)) continue;
          INFO(place(file, include));
          CHECK(
              std::any_of(targets.begin(), targets.end(), [&](const auto& name) { return reached.count(name) == 1; }));
        }
      }
    }
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

TEST_CASE("the dependencies of stages have no cycles") {
  const Generator generator = read_generator();
  for (const auto& entry : generator.stages) {
    const Stage& stage = entry.second;
    for (const std::string& need : stage.needs) {
      CAPTURE(stage.name);
      CAPTURE(need);
      CHECK(reachable(need, generator.stages).count(stage.name) == 0);
    }
  }
}

TEST_CASE("products include only products and the graph, no implementation of a stage") {
  for (const auto& [folder, header] : products) {
    const fs::path file = source_root / "generator" / header;
    for (const Include& include : parse_includes(read_text(file))) {
      if (!include.quoted) continue;
      INFO(place(file, include));
      CHECK((is_product(include.path) || include.path.starts_with("symbolic/") || include.path == "error.hpp" ||
             include.path == "lists.hpp" || include.path == "results.hpp" || include.path == "work.hpp"));
    }
  }
}

TEST_CASE("the oracle includes only the Model and its own files") {
  const Generator generator = read_generator();
  REQUIRE(generator.stages.count("oracle") == 1);
  const Stage& oracle = generator.stages.at("oracle");
  CHECK(reachable("oracle", generator.stages) == std::set<std::string>{"oracle", "error", "GiNaC::cln"});
  std::set<std::string> own;  // "verify/jet" for jet.cpp and jet.hpp
  for (const std::string& source : oracle.sources)
    own.insert(oracle.folder + "/" + fs::path(source).replace_extension().string());
  for (const fs::path& file : files_below(source_root / "generator/verify/forces", {".cpp", ".hpp"}))
    own.insert("verify/forces/" + file.stem().string());
  REQUIRE(own.count("verify/forces/spring") == 1);
  for (const std::string& stem : own) {
    for (const char* ending : {".hpp", ".cpp"}) {
      const fs::path file = source_root / "generator" / (stem + ending);
      if (!fs::exists(file)) continue;
      for (const Include& include : parse_includes(read_text(file))) {
        if (!include.quoted) continue;
        INFO(place(file, include));
        const std::string included_stem = fs::path(include.path).replace_extension().string();
        CHECK((own.count(included_stem) == 1 || include.path == "model/model.hpp" ||
               include.path == "model/expression.hpp" || include.path == "forces/registry.inc" ||
               include.path == "error.hpp" || include.path == "lists.hpp" || include.path == "results.hpp" ||
               include.path == "work.hpp"));
      }
    }
  }
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
      {"run/bind.hpp", {"stress/start.cpp"}},                      // constraints of a start
      // Requests of BoundRun, observed step by step, and simulations in pieces.
      {"run/integration.hpp",
       {"analysis/benchmark.cpp", "analysis/stress_test.cpp", "bench/measure.cpp", "eomgen/simulation.cpp",
        "stress/reference_solution.hpp"}},
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
    CHECK(fs::exists(source_root / "generator" / header));
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
