#include "architecture/sources.hpp"

#include <doctest/doctest.h>

using namespace architecture;

TEST_CASE("include lines are found with their line number; those in comments and strings are ignored") {
  const std::vector<Include> includes =
      parse_includes("#include <vector>\n// #include <list>\n#  include \"model/model.hpp\"\n\"#include <map>\";\n");
  REQUIRE(includes.size() == 2);
  CHECK(includes[0].path == "vector");
  CHECK_FALSE(includes[0].quoted);
  CHECK(includes[1].path == "model/model.hpp");
  CHECK(includes[1].quoted);
  CHECK(includes[1].line == 3);
}
