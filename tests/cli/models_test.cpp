// SPDX-License-Identifier: GPL-3.0-or-later
// The MODEL argument: `new`, paths, names, hostile names.
#include <doctest/doctest.h>

#include "program.hpp"
#include "support/folders.hpp"

using namespace eomgen::test;

TEST_CASE("new: the starter can be checked, verified and run, and overwrites no file") {
  const Folder folder;
  CHECK(expect(0, folder, {"new", "my_pendulum"}).out == "wrote my_pendulum.toml\n");
  const std::string text = folder.read("my_pendulum.toml");
  CHECK_FALSE(contains(text, "NAME."));
  CHECK(document(folder, {"check", "my_pendulum.toml"})["dof"] == 2);
  expect(0, folder, {"verify", "my_pendulum.toml", "--points", "2", "--no-compile"});
  CHECK(document(folder, {"run", "my_pendulum", "--out", "a.csv"})["outcome"] == "done");
  folder.write("my_pendulum.toml", "mine");
  const ChildResult again = expect(2, folder, {"new", "my_pendulum"});
  CHECK(contains(again.err, "my_pendulum.toml: error: this file exists already"));
  CHECK(folder.read("my_pendulum.toml") == "mine");
}

TEST_CASE("new: invalid names are refused, and nothing is written") {
  const Folder folder;
  for (const char* name : {"", "1abc", "../up", "a/b", "a b", "a.toml", "; rm", "a\nb", "\xc3\xa9"}) {
    CAPTURE(name);
    CHECK(contains(expect(2, folder, {"new", name}).err, "a model's name has letters, digits, _ and -"));
  }
  expect(2, folder, {"new", std::string(65, 'a')});
  CHECK(folder.names().empty());
}

TEST_CASE("MODEL is a path, with or without .toml, or a name in models/, even if a folder has that name") {
  const Folder folder;
  const std::string path = source_folder() + "/models/P2_planar_pendulum";
  for (const std::string& model :
       {std::string("P2_planar_pendulum"), std::string("P2_planar_pendulum.toml"), path, path + ".toml"}) {
    CHECK(document(folder, {"check", model})["model"] == "P2_planar_pendulum");
  }
  expect(0, folder, {"emit", "P2_planar_pendulum", "-o", "P2_planar_pendulum"});
  CHECK(document(folder, {"check", "P2_planar_pendulum"})["dof"] == 1);
  CHECK(contains(expect(2, folder, {"check", "P2_planar_pendulum/P2_planar_pendulum.tml"}).err,
                 "there is no such model file"));
}

TEST_CASE("hostile file names are mangled, never executed") {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> names{
      {"my model-1", "my_model_1"},
      {"1abc", "model_1abc"},
      {"int", "int_"},
      {"a;$(touch pwned)`touch pwned`", "a___touch_pwned__touch_pwned_"},
      {"two\nlines", "two_lines"},
      {"q\"uote'", "q_uote_"},
      {"bad\xff", "bad_"},
      {"back\\", "back_"},
      {"tri??", "tri__"},
      {"%s%n", "model__s_n"}};
  for (const auto& [id, name] : names) {
    const auto& shown = name;
    CAPTURE(shown);
    folder.write(id + ".toml", diverging_text());
    document(folder, {"check", "./" + id + ".toml"});
    const Json emitted = document(folder, {"emit", "./" + id + ".toml", "-o", "out", "--with", "jac"});
    CHECK(emitted["files"][0] == "out/" + name + ".hpp");
    const ChildResult compiled =
        run_child({{"gcc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror", "-c",
                    "-o", "out/" + name + ".o", "out/" + name + ".c"},
                   folder.path()});
    CAPTURE(compiled.err);
    CHECK(compiled.status == 0);
    CHECK(document(folder, {"run", "./" + id + ".toml", "--t-end", "1"})["outcome"] == "done");
  }
  CHECK_FALSE(folder.has("pwned"));
}

TEST_CASE("invalid UTF-8 in a path does not break a document") {
  const Folder folder;
  const Json emitted = document(folder, {"emit", "P2_planar_pendulum", "-o", "bad\xff"});
  CHECK(emitted["files"].size() == 3);
  CHECK(folder.has("bad\xff/P2_planar_pendulum.c"));
}

TEST_CASE("import: the model of a robot can be checked, verified, run and emitted, and JSON has what was left out") {
  const Folder folder;
  folder.write("arm.urdf", R"(<robot name="arm">
  <link name="base"/>
  <link name="upper-arm"><inertial><origin xyz="0 0 0.3"/><mass value="2"/>
    <inertia ixx="0.1" ixy="0.01" iyy="0.12" izz="0.03"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper-arm"/>
    <origin xyz="0 0 1" rpy="0.1 0 1.5708"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9"/></joint>
  <gazebo/>
</robot>)");
  const Json found = document(folder, {"import", "arm.urdf", "-o", "arm.toml", "--actuators", "all"});
  CHECK(found["coordinates"] == Json::array({"shoulder"}));
  CHECK(found["inputs"] == Json::array({"u_shoulder"}));
  CHECK(found["renamed"][0]["to"] == "upper_arm");
  CHECK(found["left_out"].size() == 2);  // <gazebo>, and 1.5708 as pi/2
  CHECK(document(folder, {"check", "arm.toml"})["dof"] == 1);
  expect(0, folder, {"verify", "arm.toml", "--points", "2", "--no-compile"});
  CHECK(document(folder, {"run", "arm.toml"})["outcome"] == "done");
  expect(0, folder, {"emit", "arm.toml", "-o", "code"});
  const ChildResult printed = expect(0, folder, {"import", "arm.urdf", "--actuators", "all"});
  CHECK(printed.out == folder.read("arm.toml"));
  CHECK(contains(printed.err, "arm.urdf:7:4: warning: not as in the file"));
  CHECK(
      document(folder, {"import", "arm.urdf", "--floating", "--attitude", "euler_parameters"})["coordinates"].size() ==
      8);
  CHECK(contains(expect(2, folder, {"import", "arm.urdf", "--friction", "dri"}).err, "did you mean 'dry'?"));
  CHECK(contains(expect(2, folder, {"import", "none.urdf"}).err, "there is no such file"));
  CHECK(contains(expect(2, folder, {"import", "arm.urdf", "-o", "arm.urdf"}).err, "error"));
}
