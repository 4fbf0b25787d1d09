// SPDX-License-Identifier: GPL-3.0-or-later
// Every function of the table is present on the page of the ABI, in the header, in NAME_info and in compiled code.
#include "abi/functions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "abi/compiled.hpp"
#include "emit/names.hpp"
#include "emit/shared_library/loaded_model.hpp"
#include "pipeline/emission.hpp"
#include "support/folders.hpp"

using namespace eomgen;

namespace {

std::string read(const std::string& file) {
  std::ifstream in(eomgen::test::source_folder() + "/" + file);
  REQUIRE(in);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The text with single blanks between words, because long prototypes have several lines.
std::string in_one_line(const std::string& text) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

/// The header, NAME_info and compiled code of one emission.
struct Emitted {
  std::string name, header;
  nlohmann::json info;
  std::set<std::string> loaded;

  Emitted(const std::string& model, const std::vector<std::string>& with, const std::vector<std::string>& outputs) {
    pipeline::EmissionRequest request;
    request.target = "c";
    request.with = with;
    request.outputs = outputs;
    const std::string path = eomgen::test::source_folder() + "/models/" + model + ".toml";
    const pipeline::Emission emission =
        pipeline::emit_model(std::make_shared<const model::Model>(model::read_model(path)), request);
    name = emit::mangled_id(model);
    std::string source, header_text;
    for (const emit::EmittedFile& file : emission.files) {
      if (file.name == name + ".c") source = file.text;
      if (file.name == name + ".h") header_text = file.text;
    }
    header = in_one_line(header_text);
    const emit::CompiledModel compiled = emit::compile_and_load(source, header_text, name);
    info = nlohmann::json::parse(compiled.model.info);
    for (const abi::Function& function : abi::functions()) {
      if (compiled.model.has(function.name)) loaded.insert(function.name);
    }
  }

  /// Whether NAME_info lists a function.
  bool tells_of(const abi::Function& function) const {
    if (function.name == "taylor") return info.contains("taylor_order");
    if (function.availability == abi::Availability::with_charts)
      return info.contains("charts") && info.contains("chart_operations");
    return info["operations"].contains(function.name);
  }
};

/// Two emissions that together have every function, because charts and a Taylor series exclude one another.
const std::vector<Emitted>& emissions() {
  static const std::vector<Emitted> all = [] {
    std::vector<std::string> with = abi::optional_functions(), in_charts = with;
    std::erase(with, "outputs");
    std::erase(in_charts, "outputs");
    std::erase(in_charts, "taylor");
    in_charts.emplace_back("charts");
    std::vector<Emitted> made;
    made.emplace_back("S5_double_pendulum", with, std::vector<std::string>{"energy"});
    made.emplace_back("R1_free_body", in_charts, std::vector<std::string>{"energy"});
    return made;
  }();
  return all;
}

}  // namespace

TEST_CASE("abi: every function has its prototype on the page of the ABI, and a table lists the names for --with") {
  const std::string page = in_one_line(read("docs/abi.md"));
  for (const abi::Function& function : abi::functions()) {
    const std::string prototype = abi::prototype(function, "NAME");
    CAPTURE(prototype);
    CHECK(page.find(prototype + ";") != std::string::npos);
  }
  const std::string commands = read("docs/commands.md");
  const std::size_t rows = commands.find("\n| function | contents |");
  REQUIRE(rows != std::string::npos);
  std::string words;  // of the first column
  for (std::size_t at = rows + 1; commands[at] == '|'; at = commands.find('\n', at) + 1)
    words += commands.substr(at, commands.find('|', at + 1) - at) + " ";
  std::replace_if(
      words.begin(), words.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; }, ' ');
  for (const std::string& name : pipeline::emitted_functions()) {
    CAPTURE(name);
    CHECK((words + " ").find(" " + name + " ") != std::string::npos);
  }
}

TEST_CASE("abi: every emitted function is in the header with its purpose, in NAME_info and in compiled code") {
  for (const abi::Function& function : abi::functions()) {
    CAPTURE(function.name);
    bool somewhere = false;
    for (const Emitted& emitted : emissions()) {
      CAPTURE(emitted.name);
      const bool declared = emitted.header.find(abi::prototype(function, emitted.name) + ";") != std::string::npos;
      CHECK(declared == (emitted.header.find(" " + emitted.name + "_" + function.name + "(") != std::string::npos));
      CHECK(declared == emitted.loaded.contains(function.name));
      somewhere = somewhere || declared;
      if (!declared) continue;
      CHECK(emitted.tells_of(function));
      CHECK(emitted.header.find(in_one_line(function.purpose)) != std::string::npos);
    }
    CHECK(somewhere);
  }
}

TEST_CASE("abi: exactly the requested functions are emitted") {
  for (const Emitted& emitted : emissions()) {
    const bool charts = emitted.info.contains("charts");
    for (const abi::Function& function : abi::functions()) {
      CAPTURE(function.name);
      if (function.availability == abi::Availability::when_beneficial) continue;
      const bool expected =
          function.name == "taylor" ? !charts : function.availability != abi::Availability::with_charts || charts;
      CHECK(emitted.loaded.contains(function.name) == expected);
    }
  }
}

TEST_CASE("abi: names are unique, and a call passes the arguments of the function") {
  std::set<std::string> names;
  for (const abi::Function& function : abi::functions()) {
    CHECK(names.insert(function.name).second);
    CHECK(abi::find(function.name) == &function);
    CHECK_FALSE(function.results.empty());
    CHECK(function.results.size() <= abi::CallArguments{}.results.size());
  }
  CHECK(abi::find("nothing") == nullptr);
  abi::CompiledFunctions code;
  code.jac = [](double t, const double* x, const double* p, const double* u, const int* mode, double* dfdx,
                double* dfdt) {
    *dfdx = t + 10 * *x + 100 * *p;
    return mode[1] + (u == nullptr ? 10 : 0) + (dfdt == nullptr ? 100 : 0);
  };
  const double x = 2, p = 3;
  const int mode[] = {0, 4};
  double dfdx = 0;
  abi::CallArguments given;
  given.t = 1, given.x = &x, given.p = &p, given.mode = mode, given.results[0] = &dfdx;
  CHECK(code.call("jac", given) == 114);
  CHECK(dfdx == 321);
  CHECK(code.has("jac"));
  CHECK_FALSE(code.has("rhs"));
}
