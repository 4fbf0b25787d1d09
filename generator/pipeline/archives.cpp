// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/archives.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <eom/hybrid/jumps.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "emit/fmu/compiled_functions.hpp"
#include "emit/fmu/fmu.hpp"
#include "emit/fmu/zip.hpp"
#include "emit/shared_library/build.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "model/units.hpp"

namespace eomgen::pipeline {
namespace {

// The archive of an FMU: its contents (emit/fmu), compiled for this machine and packed. Out: one file, NAME.fmu.

namespace fs = std::filesystem;

constexpr const char* compiler_remedy = "look at the compiler's message; EOMGEN_CC, EOMGEN_CXX select other compilers";

/// The folder that contains Eigen/.
std::string eigen_folder() {
  std::vector<fs::path> folders;
  const char* given = std::getenv("EOMGEN_INCLUDE");
  std::istringstream list(given == nullptr ? "" : given);
  for (std::string part; std::getline(list, part, ':');) {
    if (!part.empty()) folders.emplace_back(part);
  }
  for (const char* system : {"/usr/local/include", "/usr/include"}) {
    folders.emplace_back(system);
    folders.push_back(folders.back() / "eigen3");
  }
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / "Eigen" / "Dense", ignored)) return folder.string();
  }
  throw Error("emit", {}, "there is no header Eigen/Dense, which the runtime in an FMU needs",
              "sudo apt-get install libeigen3-dev, or name its folder in EOMGEN_INCLUDE", ErrorKind::tool);
}

std::string read_whole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error("emit", {}, "cannot read " + path.string(), "run the command again", ErrorKind::tool);
  return text.str();
}

emit::Recipe cpp_recipe(const std::string& what) {
  emit::Recipe recipe;
  recipe.language = "C++";
  recipe.package = "g++";
  recipe.variables = {"EOMGEN_CXX", "CXX"};
  recipe.compilers = {"c++", "g++"};
  recipe.flags = {"-std=c++20",        "-O2",   "-DNDEBUG",           "-DEIGEN_MPL2_ONLY",
                  "-ffp-contract=off", "-fPIC", "-fvisibility=hidden"};
  recipe.uses_own_headers = true;
  recipe.what = what;
  recipe.remedy = compiler_remedy;
  return recipe;
}

/// "m" -> "m/s" -> "m/s^2"
std::string rate_text(const std::string& unit, const model::Dimension& rate) {
  if (unit.ends_with("/s")) return unit + "^2";
  return unit == "1" || unit.find('/') != std::string::npos ? model::text_of(rate) : unit + "/s";
}

/// The units of a quantity and of its rates, by their texts.
void describe_unit(const std::string& text, std::map<std::string, emit::UnitDescription>& units) {
  const auto meaning = model::parse_unit(text);
  if (!meaning) return;
  std::string unit = text;
  model::Dimension dimension = meaning->dimension;
  for (int order = 0; order < 4; ++order) {
    const model::Dimension rate = model::quotient(dimension, model::dimension_of("s"));
    emit::UnitDescription description{{}, rate_text(unit, rate)};
    bool whole = true;
    for (std::size_t k = 0; k < description.powers.size(); ++k) {
      const model::Rational& power = dimension.exponents[k];
      whole = whole && cln::denominator(power) == 1 && cln::abs(power) < 100;
      if (whole) description.powers[k] = cln::cl_I_to_int(cln::numerator(power));
    }
    if (!whole) return;
    units.emplace(unit, description);
    unit = description.rate;
    dimension = rate;
  }
}

emit::FmuDescription describe(const ArchiveContents& contents) {
  emit::FmuDescription result;
  result.version = contents.version;
  result.jump_surfaces = eom::hybrid::Jumps(*contents.context.run->problem).surfaces();
  describe_unit("s", result.units);
  for (const std::string& name : contents.program.outputs) {
    const system::Output* output = system::find(contents.derived.candidates.front().outputs, name);
    result.output_units.push_back(output == nullptr ? "" : output->unit);
    describe_unit(result.output_units.back(), result.units);
  }
  const emit::EmissionContext& context = contents.context;
  for (const auto* list : {&context.coordinates, &context.states, &context.inputs, &context.parameters}) {
    for (const emit::Quantity& quantity : *list) describe_unit(quantity.unit, result.units);
  }
  return result;
}

std::string platform([[maybe_unused]] int version) {
#if defined(__x86_64__)
  return version == 2 ? "linux64" : "x86_64-linux";
#elif defined(__aarch64__)
  return "aarch64-linux";
#else
  throw Error("emit", {}, "FMI has no name for this machine", "emit the FMU on x86-64 or aarch64", ErrorKind::tool);
#endif
}

/// Throws Error{ErrorKind::tool} without a C or C++ compiler, or without Eigen.
std::vector<emit::EmittedFile> make_fmu(const ArchiveContents& contents) {
  const emit::EmissionContext& context = contents.context;
  std::vector<emit::EmittedFile> files = emit::emit_fmu(contents.program, context, describe(contents));
  const std::string name = emit::mangled_id(context.id), functions = fmt::format("fmi{}", contents.version);
  std::vector<std::pair<std::string, std::string>> of_model, runtime;
  for (const emit::EmittedFile& file : files) {
    if (!file.name.starts_with(emit::fmu_sources) || file.name.ends_with(".xml")) continue;
    const std::string source = file.name.substr(std::string(emit::fmu_sources).size());
    (source.starts_with("eom/") || source == functions + ".cpp" ? runtime : of_model).emplace_back(source, file.text);
  }
  const auto first = [](std::vector<std::pair<std::string, std::string>> list, const std::string& name_of_first) {
    std::stable_partition(list.begin(), list.end(), [&](const auto& file) { return file.first == name_of_first; });
    return list;
  };
  const std::string eigen = eigen_folder();

  emit::Recipe equations;
  equations.name = name;
  equations.suffix = ".o";
  equations.files = first(of_model, name + ".c");
  equations.flags = {"-std=c11", "-O2", "-fno-math-errno", "-ffp-contract=off", "-fPIC", "-fvisibility=hidden", "-c"};
  equations.uses_own_headers = true;
  equations.what = "the equations";
  equations.remedy = compiler_remedy;
  const emit::BuiltLibrary equations_object = emit::build_library(equations);

  emit::Recipe whole = cpp_recipe("the description of the model");
  whole.name = name;
  whole.files = first(of_model, name + "_fmu.cpp");
  whole.files.insert(whole.files.end(), runtime.begin(), runtime.end());
  whole.files.emplace_back("fmi.o", emit::compiled_fmi_functions());
  whole.objects = {"fmi.o"};
  whole.flags.insert(whole.flags.end(), {"-I", eigen, "-shared", "-s", "-static-libstdc++", "-static-libgcc",
                                         "-Wl,--build-id=none", "-Wl,--exclude-libs,ALL"});
  whole.libraries = {equations_object.path, "-lm"};
  const emit::BuiltLibrary binary = emit::build_library(whole);

  for (const std::string& header : emit::headers_of_fmi_functions())
    files.push_back({emit::fmu_sources + header, read_whole(fs::path(eigen) / header)});
  files.push_back({fmt::format("binaries/{}/{}.so", platform(contents.version), name), read_whole(binary.path)});
  return {{name + ".fmu", emit::zip(files)}};
}

constexpr const char* of_fmu[] = {"run", "start", "jac", "jac_u"};
constexpr int versions_of_fmi[] = {3, 2};

constexpr Archive registry[] = {
    {"fmu", "Functional Mock-up Unit (FMI): model exchange and co-simulation, with sources and binary", of_fmu,
     versions_of_fmi, make_fmu},
};

}  // namespace

std::span<const Archive> archives() { return registry; }

const Archive* find_archive(const std::string& name) { return find_named(registry, name); }

std::vector<std::string> target_names() {
  std::vector<std::string> names = emit::target_names();
  for (const Archive& archive : registry) names.emplace_back(archive.name);
  return names;
}

}  // namespace eomgen::pipeline
