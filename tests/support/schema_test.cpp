#include "support/schema.hpp"

#include <doctest/doctest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace {

using nlohmann::json;

// A minimal valid document for each schema.
const std::map<std::string, json>& right_documents() {
  static const std::map<std::string, json> documents = [] {
    const json operations = {{"add", 4}, {"mul", 9}, {"div", 1}, {"sqrt", 0}, {"trig", 2}, {"other", 0}};
    const json formula = {{"latex", "m \\ddot{x} = 0"}, {"text", "m*x_ddot = 0"}};
    json equation = formula, reaction = formula;
    equation["coordinate"] = "x";
    reaction["name"] = "sphere";
    return std::map<std::string, json>{
        {"list",
         {{"format", 1},
          {"coordinates", {{{"name", "cartesian"}}}},
          {"rotations", json::array()},
          {"joints", json::array()},
          {"solvers", {{{"name", "dop853"}, {"order", 8}}}},
          {"targets", {{{"name", "cpp"}}}}}},
        {"check",
         {{"format", 1},
          {"coordinates", {{{"name", "R"}}, {{"name", "phi"}}}},
          {"dof", 1},
          {"parameters", {{{"name", "m"}}}},
          {"constraints",
           {{{"name", "sphere"},
             {"kind", "holonomic"},
             {"integrable", "yes"},
             {"integral", "R - d"},
             {"redundant", false}}}},
          {"forces", {{{"name", "gravity"}, {"conservative", "yes"}, {"potential", "m*g*z"}}}},
          {"conserved", {{{"name", "h_theta"}, {"expression", "m*R^2*theta_dot"}}}},
          {"singular", {{{"set", "sin(phi) = 0"}, {"approach", "II"}}}},
          {"units", "checked"},
          {"warnings", json::array()}}},
        {"derive",
         {{"format", 1},
          {"approach", "I"},
          {"equations", {equation}},
          {"reactions", {reaction}},
          {"constraints", {formula}}}},
        {"verify",
         {{"format", 1},
          {"formulations",
           {{{"a", "lagrange"}, {"b", "oracle"}, {"shares_code", false}, {"max_relative_difference", 1e-48}}}},
          {"points", 20},
          {"rejected", 0},
          {"verdict", "pass"}}},
        {"emit",
         {{"format", 1},
          {"files", {"P7.hpp", "P7.c", "P7.h"}},
          {"formulation", "lagrange"},
          {"tried", {{{"formulation", "lagrange"}, {"operations", operations}}}},
          {"operations", operations},
          {"seconds", {{"read", 0.1}, {"derive", 0.1}, {"optimise", 0.1}, {"verify", 0.1}, {"print", 0.1}}}}},
        {"run",
         {{"format", 1},
          {"solver", "dop853"},
          {"solver_changes",
           json::array({{{"t", 0.5}, {"from", "radau5"}, {"to", "dop853"}, {"reason", "no longer stiff"}}})},
          {"outcome", "done"},
          {"steps", 100},
          {"rejected", 3},
          {"rhs_evaluations", 1236},
          {"seconds", {{"derive", 0.1}, {"emit", 0.1}, {"compile", 1.0}, {"integrate", 1e-4}, {"estimate", 1e-4}}},
          {"final", {{"x", 1.0}, {"x_dot", -2}}},
          {"error_estimate", {{"x", 1e-9}, {"x_dot", 1e-9}, {"max", 1e-9}}},
          {"invariants", {{"energy", {{"initial", 0.5}, {"max_relative_drift", 1e-12}}}}},
          {"power_balance", 1e-12},
          {"constraint_drift", 1e-14},
          {"events", {{{"t", 0.5}, {"kind", "stop"}, {"name", "floor"}}}}}},
        {"equilibria",
         {{"format", 1},
          {"points", json::array({{{"values", {{"q", 0.5}}},
                                   {"eigenvalues", json::array({{{"re", -1}, {"im", 0}}})},
                                   {"stable", true}}})}}},
        {"linearize",
         {{"format", 1},
          {"states", {"q", "q_dot"}},
          {"A", {{0, 1}, {-1, 0}}},
          {"B", json::array({json::array(), json::array()})},
          {"eigenvalues", json::array({{{"re", 0}, {"im", 1}}, {{"re", 0}, {"im", -1}}})},
          {"structural_zeros", 0}}},
        {"sweep", {{"format", 1}, {"runs", 6}, {"done", 5}, {"failed", 1}, {"file", "P7_sweep.csv"}}},
        {"merge", {{"format", 1}, {"shards", 2}, {"runs", 6}, {"file", "all.csv"}}},
        {"report", {{"format", 1}, {"file", "report.html"}}},
        {"stress",
         {{"format", 1},
          {"rows", json::array({{{"case", "k x 1e+06"},
                                 {"solver", "dop853"},
                                 {"verdict", "pass"},
                                 {"error", 1e-10},
                                 {"estimate", nullptr},
                                 {"seconds", 0.1}}})},
          {"verdict", "pass"}}},
        {"bench",
         {{"format", 1},
          {"model", "P7_moving_sphere"},
          {"scene", "default"},
          {"t", {0, 10}},
          {"reference",
           {{"method", "Taylor"},
            {"digits", 32},
            {"digits_at_end", 33},
            {"steps", 80},
            {"seconds", 1.5},
            {"end", {{"x", 1.0}}}}},
          {"rows", json::array({{{"solver", "dop853"},
                                 {"rtol", 1e-9},
                                 {"step", nullptr},
                                 {"error", 1e-10},
                                 {"error_along", 1e-9},
                                 {"errors", {{"x", 1e-10}}},
                                 {"seconds", 1e-4},
                                 {"repeats", 31},
                                 {"steps", 40},
                                 {"rejected", 1},
                                 {"rhs_evaluations", 480},
                                 {"outcome", "done"}}})},
          {"left_out", json::array()},
          {"machine", {{"processor", "one"}, {"cores", 2}, {"compiler", "g++"}, {"code", "-O2"}}},
          {"advice", "for 1e-9 dop853"}}},
        {"inverse", {{"format", 1}, {"columns", {"t", "R", "R_dot", "force.R"}}, {"file", "P10_rocket_inverse.csv"}}},
        {"import",
         {{"format", 1},
          {"source", "arm.urdf"},
          {"source_format", "urdf"},
          {"robot", "arm"},
          {"links", 3},
          {"joints", 2},
          {"bodies", 2},
          {"constraints", 0},
          {"coordinates", {"shoulder", "elbow"}},
          {"inputs", {"u_shoulder"}},
          {"renamed", json::array({{{"kind", "joint"}, {"from", "elbow-1"}, {"to", "elbow"}}})},
          {"left_out", json::array({{{"what", "<mesh>"}, {"why", "not read"}, {"count", 3}, {"line", 28}}})},
          {"left_out_unlisted", 0}}},
        {"docs",
         {{"format", 1},
          {"pages", json::array({{{"topic", "abi"}, {"title", "The C ABI of emitted code"}}})},
          {"texts", json::array({{{"topic", "abi"}, {"heading", "Kinks"}, {"text", "## Kinks"}}})}}},
    };
  }();
  return documents;
}

// A valid document with the value at `pointer` replaced.
json changed(const std::string& schema, const std::string& pointer, json value) {
  json document = right_documents().at(schema);
  document.at(json::json_pointer(pointer)) = std::move(value);
  return document;
}

}  // namespace

TEST_CASE("every schema of docs/schema accepts a valid document and rejects it without any one of its required keys") {
  for (const std::string& schema : support::schema_names()) {
    CAPTURE(schema);
    REQUIRE(right_documents().count(schema) == 1);
    const json& right = right_documents().at(schema);
    support::check_schema(right, schema);
    std::size_t refused = 0;
    for (const auto& [key, value] : right.items()) {
      json without = right;
      without.erase(key);
      refused += support::schema_errors(without, schema).empty() ? 0 : 1;
    }
    const std::size_t free = schema == "run"      ? 2
                             : schema == "derive" ? 1
                                                  : 0;  // error_estimate, solver_changes; constraints
    CHECK(refused == right.size() - free);
  }
}

TEST_CASE("every schema accepts keys of later versions, and rejects another format") {
  for (const auto& entry : right_documents()) {
    const std::string& schema = entry.first;
    CAPTURE(schema);
    json more = entry.second;
    more["later"] = true;
    CHECK(support::schema_errors(more, schema).empty());
    for (const json& format : {json(2), json("1"), json(nullptr)}) {
      CAPTURE(format.dump());
      CHECK_FALSE(support::schema_errors(changed(schema, "/format", format), schema).empty());
    }
    CHECK_FALSE(support::schema_errors(json::array(), schema).empty());
  }
}

TEST_CASE("wrong values are rejected, each at its location") {
  struct Wrong {
    const char* schema;
    const char* pointer;
    json value;
  };
  const Wrong cases[] = {
      {"list", "/solvers", json::array()},
      {"list", "/solvers/0", "dop853"},
      {"list", "/coordinates/0/name", ""},
      {"check", "/dof", -1},
      {"check", "/coordinates/0", "R"},
      {"check", "/dof", 1.5},
      {"check", "/constraints/0/kind", "Holonomic"},
      {"check", "/constraints/0/integrable", true},
      {"check", "/constraints/0/redundant", "no"},
      {"check", "/forces/0/conservative", "maybe"},
      {"check", "/singular/0/approach", "III"},
      {"derive", "/approach", "auto"},
      {"derive", "/equations/0/latex", ""},
      {"derive", "/equations/0", "m*x_ddot = 0"},
      {"derive", "/constraints/0/text", ""},
      {"verify", "/verdict", "told"},
      {"verify", "/points", 0},
      {"verify", "/formulations", json::array()},
      {"verify", "/formulations/0/max_relative_difference", nullptr},
      {"emit", "/files", json::array()},
      {"emit", "/files", {"a.c", "a.c"}},
      {"emit", "/formulation", "fastest"},
      {"emit", "/operations/mul", -3},
      {"emit", "/operations", json::object()},
      {"emit", "/tried/0/operations", 14},
      {"emit", "/seconds/derive", "0.1"},
      {"run", "/solver", "auto"},
      {"run", "/outcome", "ok"},
      {"run", "/steps", -1},
      {"run", "/final", json::object()},
      {"run", "/final/x", nullptr},
      {"run", "/final/x", "1.0"},
      {"run", "/error_estimate", {{"x", 1e-9}}},
      {"run", "/error_estimate/max", -1e-9},
      {"run", "/invariants/energy/max_relative_drift", nullptr},
      {"run", "/constraint_drift", -1.0},
      {"run", "/events/0/kind", "bounce"},
  };
  for (const Wrong& wrong : cases) {
    CAPTURE(wrong.schema);
    CAPTURE(wrong.pointer);
    CAPTURE(wrong.value.dump());
    CHECK_FALSE(support::schema_errors(changed(wrong.schema, wrong.pointer, wrong.value), wrong.schema).empty());
  }
}

TEST_CASE("a run that failed numerically may contain values that are not finite") {
  json failed = changed("run", "/final/x", nullptr);
  failed["outcome"] = "not_finite";
  CHECK(support::schema_errors(failed, "run").empty());
}

TEST_CASE("emit: operation counts are required for sources, but not for a document") {
  CHECK(support::schema_errors({{"format", 1}, {"files", {"P7.tex"}}}, "emit").empty());
  CHECK_FALSE(support::schema_errors({{"format", 1}, {"files", {"code/P7.c"}}}, "emit").empty());
}

TEST_CASE("a missing schema is an error, not a pass") {
  CHECK_THROWS_AS(support::schema_errors(json::object(), "no_such_command"), std::runtime_error);
}

TEST_CASE("an error names the location in the document") {
  const std::vector<std::string> errors = support::schema_errors(changed("run", "/outcome", "ok"), "run");
  REQUIRE_FALSE(errors.empty());
  CHECK(errors.back().find("outcome") != std::string::npos);
}
