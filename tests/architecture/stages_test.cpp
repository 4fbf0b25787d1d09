#include "architecture/stages.hpp"

#include <doctest/doctest.h>

using namespace architecture;

TEST_CASE("the stages of a CMakeLists.txt are parsed with their lists, without comments") {
  const std::vector<Stage> stages = parse_stages("verify", R"(
# eomgen_stage(ghost NEEDS everything)
eomgen_stage(oracle SOURCES a.cpp  # the oracle
  b.cpp NEEDS error
  LINKS GiNaC::cln)
eomgen_stage(verify SOURCES c.cpp NEEDS oracle program)
)");
  REQUIRE(stages.size() == 2);
  CHECK(stages[0].name == "oracle");
  CHECK(stages[0].sources == std::vector<std::string>{"a.cpp", "b.cpp"});
  CHECK(stages[0].needs == std::vector<std::string>{"error"});
  CHECK(stages[0].links == std::vector<std::string>{"GiNaC::cln"});
  CHECK(stages[1].needs == std::vector<std::string>{"oracle", "program"});
}

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

TEST_CASE("a stage reaches everything that its needs reach, and no stage that needs it") {
  const std::map<std::string, Stage> stages = {
      {"model", {"model", "model", {}, {"error"}, {}}},
      {"symbolic", {"symbolic", "symbolic", {}, {}, {"GiNaC::cln"}}},
      {"derive", {"derive", "derive", {}, {"model"}, {"eomgen_symbolic"}}},
  };
  CHECK(reachable("derive", stages) == std::set<std::string>{"derive", "model", "error", "symbolic", "GiNaC::cln"});
  CHECK(reachable("model", stages) == std::set<std::string>{"model", "error"});
}
