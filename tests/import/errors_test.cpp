// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong and hostile robot files, and what an import reports of right ones.
#include <doctest/doctest.h>

#include <string>

#include "import/import.hpp"
#include "import/xml.hpp"
#include "model/model.hpp"

using namespace eomgen;
using import::ImportedModel;
using import::ImportOptions;

namespace {

const std::string inertial = "<inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\"/></inertial>";

std::string link_text(const std::string& name, const std::string& inside = inertial) {
  return "<link name=\"" + name + "\">" + inside + "</link>\n";
}
std::string joint_text(const std::string& name, const std::string& parent, const std::string& child,
                       const std::string& inside = "", const std::string& type = "revolute") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + inside + "</joint>\n";
}
std::string robot_text(const std::string& inside) { return "<robot name=\"r\">\n" + inside + "</robot>\n"; }
std::string arm_text(const std::string& inside) {
  return robot_text(link_text("a") + link_text("b") + joint_text("j", "a", "b", inside));
}

std::string error_of(const std::string& bytes, const ImportOptions& options = {}) {
  try {
    import::import_text("r.urdf", bytes, options);
  } catch (const Error& error) {
    CHECK_FALSE(error.remedy().empty());
    return error.what();
  }
  return "";
}

struct WrongFile {
  const char* what;
  std::string bytes;
  const char* message;
};

bool reports(const ImportedModel& model, const std::string& what) {
  for (const import::Finding& finding : model.findings.entries())
    if (finding.what == what) return true;
  return false;
}

/// Requires that the text is a model without warnings.
model::Model read(const ImportedModel& imported) {
  CAPTURE(imported.text);
  const model::Model model = model::read_model_text(imported.text, "r.toml");
  CHECK(model.warnings.empty());
  return model;
}

}  // namespace

TEST_CASE("import: every wrong file is refused with its place and a remedy") {
  const WrongFile files[] = {
      {"tags", "<robot name=\"r\">\n<link></robot>", "r.urdf:2:"},
      {"no element", "text", "this is not XML"},
      {"empty", "", "this is not XML"},
      {"other root", "<sdf/>", "r.urdf:1:2: error: <sdf> is not the root of a robot file"},
      {"document type", "<!DOCTYPE r [<!ENTITY a \"b\">]><robot name=\"r\"/>",
       "r.urdf:1:1: error: a robot file has no document type"},
      {"control character", "<robot name=\"\x01\"/>", "r.urdf:1:14: error: byte 0x01"},
      {"no UTF-8", "<robot name=\"\xff\"/>", "byte 0xff is no text"},
      {"no link", robot_text(""), "the robot has no link"},
      {"repeated attribute", "<robot name=\"r\" name=\"s\"/>", "r.urdf:1:17: error: the attribute 'name' comes twice"},
      {"missing link", robot_text(link_text("base") + joint_text("j", "bse", "base")),
       "r.urdf:3:41: error: there is no link 'bse'"},
      {"two roots", robot_text(link_text("a") + link_text("b")),
       "r.urdf:3:2: error: the links 'a' (line 2) and 'b' are both roots"},
      {"cycle without root",
       robot_text(link_text("a") + link_text("b") + joint_text("j", "a", "b") + joint_text("k", "b", "a")),
       "the joints form a cycle"},
      {"cycle beside the root",
       robot_text(link_text("r") + link_text("a") + link_text("b") + joint_text("j", "a", "b") +
                  joint_text("k", "b", "a")),
       "is in a cycle of joints"},
      {"two parents",
       robot_text(link_text("a") + link_text("b") + link_text("c") + joint_text("i", "a", "c") +
                  joint_text("j", "a", "b") + joint_text("k", "b", "c")),
       "is the child of two joints, 'i' and 'k'"},
      {"two links of one name", robot_text(link_text("a") + link_text("a")), "there are two links 'a'"},
      {"negative mass",
       robot_text(link_text("a", "<inertial><mass value=\"-1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>")),
       "r.urdf:2:32: error: the mass of the link 'a' is negative"},
      {"indefinite tensor",
       robot_text(link_text(
           "a", "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"2\" iyy=\"1\" izz=\"1\"/></inertial>")),
       "is not positive definite"},
      {"inertia without mass",
       robot_text(link_text("a") +
                  link_text("b", "<inertial><mass value=\"0\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>") +
                  joint_text("j", "a", "b")),
       "has an inertia and no mass"},
      {"joint type", robot_text(link_text("a") + link_text("b") + joint_text("j", "a", "b", "", "revolut")),
       "did you mean 'revolute'?"},
      {"unknown master", arm_text("<mimic joint=\"k\"/>"), "there is no joint 'k'"},
      {"own master", arm_text("<mimic joint=\"j\"/>"), "the joint 'j' follows itself"},
      {"axis of no length", arm_text("<axis xyz=\"0 0 0\"/>"), "has no direction"},
      {"two numbers", arm_text("<axis xyz=\"0 0\"/>"), "'xyz' has 2 numbers"},
      {"macro", arm_text("<axis xyz=\"${x} 0 0\"/>"), "expand macros first"},
      {"limits exchanged", arm_text("<limit lower=\"1\" upper=\"-1\"/>"), "is above the upper one"},
      {"negative damping", arm_text("<dynamics damping=\"-1\"/>"), "the damping of the joint 'j' is negative"},
      {"nothing moves", robot_text(link_text("a") + link_text("b") + joint_text("j", "a", "b", "", "fixed")),
       "nothing moves"},
      {"transmission of nothing",
       robot_text(link_text("a") + link_text("b") + joint_text("j", "a", "b") +
                  "<transmission name=\"t\"><joint name=\"k\"/></transmission>"),
       "there is no joint 'k'"},
  };
  for (const WrongFile& file : files) {
    CAPTURE(file.what);
    const std::string message = error_of(file.bytes);
    CAPTURE(message);
    CHECK(message.find(file.message) != std::string::npos);
  }
}

TEST_CASE("import: deep, large and numerous files are refused") {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 100000; ++i) deep += "</a>";
  CHECK(error_of(deep).find("nested more than 200 deep") != std::string::npos);
  CHECK(error_of(std::string(import::max_xml_bytes + 1, ' ')).find("has more than 4194304 bytes") != std::string::npos);
  std::string many;
  for (std::size_t i = 0; i < import::max_xml_elements; ++i) many += "<a/>";
  CHECK(error_of(robot_text(many)).find("more than 100000 elements") != std::string::npos);
}

TEST_CASE("import: names become legal and unique, and are reported") {
  const std::string text =
      robot_text(link_text("base link") + link_text("energy") + link_text("j\"\\") +
                 joint_text("1.sin", "base link", "energy") + joint_text("energy", "energy", "j\"\\"));
  // A quotation mark in XML.
  std::string bytes = text;
  for (std::size_t at; (at = bytes.find("j\"\\")) != std::string::npos;) bytes.replace(at, 2, "j&quot;");
  const ImportedModel imported = import::import_text("r.urdf", bytes, {});
  CHECK(read(imported).coordinates.size() == 2);
  CHECK(imported.coordinates == std::vector<std::string>{"n1_sin", "energy_joint"});
  CHECK(imported.renamings.size() == 5);
}

TEST_CASE("import: limits, friction, drives, stops, shapes and what is left out stand in the model") {
  const std::string shapes =
      "<visual><origin xyz=\"0 0 0.1\" rpy=\"1.5708 0 0\"/><geometry><box size=\"1 2 3\"/></geometry></visual>"
      "<visual><geometry><cylinder radius=\"0.1\" length=\"0.5\"/></geometry></visual>"
      "<visual><geometry><mesh filename=\"m.stl\"/></geometry></visual><collision/><collision/>";
  const std::string text = robot_text(
      link_text("a") + link_text("b", inertial + shapes) + link_text("empty", "") +
      joint_text("j", "a", "b", "<limit lower=\"1\" upper=\"2\" effort=\"5\"/><dynamics friction=\"0.5\"/>") +
      joint_text("free", "b", "empty", "", "continuous") + "<gazebo/>" +
      "<transmission name=\"t\"><joint name=\"j\"/></transmission>");
  ImportOptions options;
  options.stops = {"j"};
  const ImportedModel imported = import::import_text("r.urdf", text, options);
  const model::Model model = read(imported);
  CHECK(imported.coordinates == std::vector<std::string>{"j"});  // `free` moves no mass
  CHECK(imported.inputs == std::vector<std::string>{"u_j"});
  CHECK(imported.constraints == 2);
  for (const char* what : {"meshes that are not drawn", "<collision>", "<gazebo> of <robot>",
                           "joints that move no mass", "friction", "decimals of pi"}) {
    CAPTURE(what);
    CHECK(reports(imported, what));
    CHECK(imported.text.find(what) != std::string::npos);
  }
  const auto has = [&](const char* part) { return imported.text.find(part) != std::string::npos; };
  CHECK(has("lower 1, upper 2, effort 5"));
  CHECK(has("box = [\"1 m\", \"3 m\", \"2 m\"]"));
  CHECK(has("cylinder = [\"0.1 m\", \"0.5 m\"], axis = \"e3\""));
  CHECK(has("j = 1.5\n"));  // within its limits
  options.stops = {"free"};
  CHECK(error_of(text, options).find("there is no joint 'free' that moves") != std::string::npos);
}

TEST_CASE("import: planar and floating joints have three and six coordinates") {
  ImportOptions options;
  for (const auto attitude : {import::Attitude::euler, import::Attitude::euler_parameters}) {
    options.attitude = attitude;
    const std::string text = robot_text(link_text("a") + link_text("b") + link_text("c") +
                                        joint_text("p", "a", "b", "<axis xyz=\"0 0 1\"/>", "planar") +
                                        joint_text("f", "b", "c", "", "floating"));
    const ImportedModel imported = import::import_text("r.urdf", text, options);
    CHECK(read(imported).coordinates.size() == (attitude == import::Attitude::euler ? 9 : 10));
    CHECK(imported.coordinates[0] == "p_u");
    CHECK(imported.coordinates[3] == "f_x");
  }
}
