// SPDX-License-Identifier: GPL-3.0-or-later
// The table of wrong models of tests/model through the program: exit code 2, same message, less than a second.
#include "wrong_models.hpp"

#include <doctest/doctest.h>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("every wrong model is refused by the program, with the same message, in less than a second") {
  using namespace eomgen::model;
  const Folder folder;
  std::size_t count = 0;
  for (const auto& table : {wrong_names(), wrong_structure(), wrong_units(), wrong_expressions(), wrong_scenes(),
                            wrong_hostile(), wrong_bodies(), wrong_forces(), wrong_resets(), wrong_states()}) {
    for (const WrongModel& wrong : table) {
      CAPTURE(wrong.name);
      folder.write("model.toml", wrong.text);
      const ChildResult result = expect(2, folder, {"check", "model.toml"});
      CHECK(result.out.empty());
      CHECK(result.seconds < 1.0);
      ++count;
      if (wrong.text.size() > (std::size_t{1} << 20)) {  // not read completely, so its size is unknown
        CHECK(contains(result.err, "the file has more than 1048576 bytes"));
        continue;
      }
      CHECK(result.err.starts_with("model.toml:" + (wrong.place.empty() ? "" : wrong.place + ":") +
                                   " error: " + wrong.message + "\n"));
      CHECK(contains(result.err, "  remedy: " + wrong.remedy));
    }
  }
  CHECK(count > 100);
}
