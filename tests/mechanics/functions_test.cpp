// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the model language and those of the graph: two tables, as the judge reads one of them only.
#include "symbolic/functions.hpp"

#include <doctest/doctest.h>

#include <string>

#include "mechanics/lowering.hpp"
#include "model/names.hpp"

using namespace eomgen;

TEST_CASE("functions: what a row of the table calls itself is a function of the language, on as many arguments") {
  std::size_t functions = 0;
  for (const symbolic::Function& row : symbolic::function_table) {
    if (row.op == symbolic::Op::pow || row.op == symbolic::Op::select) continue;  // ^ and if, which are no calls
    CAPTURE(row.name);
    const model::FunctionName* found = model::find_function(row.name);
    REQUIRE(found != nullptr);
    CHECK(mechanics::op_of(found->fn) == row.op);
    CHECK(found->least == row.arity);
    ++functions;
  }
  CHECK(functions == static_cast<std::size_t>(model::Fn::max) + 1);  // and there are no others
}
