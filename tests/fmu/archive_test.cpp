// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of FMUs: the archive, modelDescription.xml, sources, documentation.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <set>

#include "../cli/program.hpp"
#include "emit/fmu/xml.hpp"
#include "emit/fmu/zip.hpp"
#include "importer.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

std::map<std::string, std::string> contents(const Folder& folder, const std::string& model, int version) {
  const std::string out = fmt::format("out{}", version);
  const Json emitted =
      document(folder, {"emit", model, "-o", out, "--target", "fmu", "--fmi", fmt::format("{}", version)});
  REQUIRE(emitted["files"].size() == 1);
  std::map<std::string, std::string> result;
  for (auto& [name, text] : read_archive(folder.read(std::string(emitted["files"][0])))) result[name] = text;
  return result;
}

/// Names that would break out of an attribute, an element, a comment or a literal.
const char* const hostile_model = R"(format = 1
title = "</title><script>alert(1)</script> & \" ' \\ */"

[parameters]
m = { value = "1 kg", note = "a\"/><Float64 name=\"evil\" & <b>" }

[inputs]
F = { unit = "N", default = 0 }

[[particle]]
name = "P"
mass = "m"
position = ["x", 0, 0]

[coordinates]
x = "m"

[[force]]
on = "P"
force = "F*E1"

[scene.default]
t = [0, 1]
initial = { x = 1 }
outputs = ["energy"]
)";

}  // namespace

TEST_CASE("zip: an archive is read back, and its checksums are those of the standard") {
  const std::vector<emit::EmittedFile> files{{"a.txt", "one"}, {"b/c.bin", std::string("\0\xff\n", 3)}, {"empty", ""}};
  const std::string bytes = emit::zip(files);
  const auto read = read_archive(bytes);
  REQUIRE(read.size() == files.size());
  for (std::size_t k = 0; k < files.size(); ++k) {
    CHECK(read[k].first == files[k].name);
    CHECK(read[k].second == files[k].text);
  }
  CHECK(bytes == emit::zip(files));
}

TEST_CASE("xml_text: everything that has a meaning in XML is escaped, and what XML cannot contain is replaced") {
  CHECK(emit::xml_text("a<b>&\"'") == "a&lt;b&gt;&amp;&quot;&#39;");
  CHECK(emit::xml_text("line\n\ttab") == "line  tab");
  CHECK(emit::xml_text(std::string("nul\0bell\x07", 9)) == "nul?bell?");
  CHECK(emit::xml_text("\xc3\xa4\xff\xed\xa0\x80") == "\xc3\xa4????");
  CHECK(emit::xml_text("a\xef\xbf\xbe\xef\xbf\xbf"
                       "b\xef\xbf\xbd") == "a??b\xef\xbf\xbd");
}

TEST_CASE("fmu: the contents are those of the standard, equal in every emission, and nothing of a user escapes") {
  const Folder folder;
  folder.write("hostile.toml", hostile_model);
  for (const int version : {2, 3}) {
    CAPTURE(version);
    const auto files = contents(folder, "hostile.toml", version);
    for (const char* name : {"modelDescription.xml", "documentation/index.html", "sources/hostile.c",
                             "sources/hostile_fmu.cpp", "sources/eom/fmi/instance.hpp", "sources/Eigen/Core"})
      CHECK(files.contains(name));
    CHECK(files.at(version == 3 ? "terminalsAndIcons/icon.png" : "model.png").starts_with("\x89PNG\r\n\x1a\n"));
    CHECK(files.contains("sources/buildDescription.xml") == (version == 3));
    for (const auto& [name, text] : files) {
      CAPTURE(name);
      CHECK(text.find("GPL-3.0") == std::string::npos);
      CHECK(text.find(folder.path()) == std::string::npos);
    }
    pugi::xml_document description, page;
    REQUIRE(description.load_string(files.at("modelDescription.xml").c_str()));
    CHECK(description.select_node("//*[@name='evil']").node().empty());
    const std::string note = "a\"/><Float64 name=\"evil\" & <b>";
    CHECK(description.select_node("//ModelVariables//*[@name='m']").node().attribute("description").value() == note);
    CHECK(files.at("documentation/index.html").find("<script") == std::string::npos);
    CHECK(contents(folder, "hostile.toml", version) == files);
  }
}

TEST_CASE("fmu: modelDescription.xml satisfies the rules of variables and of the model structure") {
  const Folder folder;
  for (const char* model : {"bouncing_ball", "S5_double_pendulum_cartesian", "sampled_cart_pole", "dc_motor"}) {
    CAPTURE(model);
    const auto files = contents(folder, model, 3);
    pugi::xml_document document;
    REQUIRE(document.load_string(files.at("modelDescription.xml").c_str()));
    const pugi::xml_node root = document.child("fmiModelDescription");
    std::set<std::string> names, units;
    for (const pugi::xml_node unit : root.child("UnitDefinitions").children())
      units.insert(unit.attribute("name").value());
    std::map<unsigned, pugi::xml_node> by_reference;
    for (const pugi::xml_node v : root.child("ModelVariables").children()) {
      CAPTURE(v.attribute("name").value());
      CHECK(names.insert(v.attribute("name").value()).second);
      CHECK(by_reference.emplace(v.attribute("valueReference").as_uint(), v).second);
      const std::string causality = v.attribute("causality").value(), initial = v.attribute("initial").value();
      const bool needs_start = causality == "input" || causality == "parameter" || initial == "exact";
      CHECK(v.attribute("start").empty() != needs_start);
      if (const auto unit = v.attribute("unit"); !unit.empty()) CHECK(units.contains(unit.value()));
      if (causality == "parameter") CHECK((v.attribute("variability").value() == std::string("tunable")));
    }
    std::size_t derivatives = 0, outputs = 0, wanted_outputs = 0;
    for (const auto& [reference, v] : by_reference) {
      if (v.attribute("causality").value() == std::string("output")) ++wanted_outputs;
      if (const auto of = v.attribute("derivative"); !of.empty()) {
        REQUIRE(by_reference.contains(of.as_uint()));
        const pugi::xml_node state = by_reference.at(of.as_uint());
        CHECK((state.attribute("variability").value() == std::string("continuous")));
        CHECK_FALSE(state.attribute("start").empty());
        CHECK(state.attribute("nominal").as_double() > 0);
      }
    }
    const pugi::xml_node structure = root.child("ModelStructure");
    for (const pugi::xml_node entry : structure.children()) {
      const unsigned reference = entry.attribute("valueReference").as_uint();
      REQUIRE(by_reference.contains(reference));
      const pugi::xml_node v = by_reference.at(reference);
      const std::string kind = entry.name();
      if (kind == "Output") ++outputs;
      if (kind == "Output") CHECK((v.attribute("causality").value() == std::string("output")));
      if (kind == "ContinuousStateDerivative") CHECK_FALSE(v.attribute("derivative").empty());
      if (kind == "ContinuousStateDerivative") ++derivatives;
      if (kind == "InitialUnknown") CHECK((v.attribute("initial").value() == std::string("calculated")));
    }
    CHECK(outputs == wanted_outputs);
    CHECK(derivatives > 0);
  }
}
