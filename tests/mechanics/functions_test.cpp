// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of the model language and those of the graph: two tables, since the independent oracle reads only one
// of them.
#include "symbolic/functions.hpp"

#include <doctest/doctest.h>

#include <string>

#include "mechanics/lowering.hpp"
#include "model/names.hpp"

using namespace eomgen;

TEST_CASE("functions: each named row of the table is a function of the language with as many arguments") {
  std::size_t functions = 0;
  for (const symbolic::Function& row : symbolic::function_table) {
    if (row.op == symbolic::Op::pow || row.op == symbolic::Op::select) continue;  // ^ and if are no calls
    CAPTURE(row.name);
    const model::FunctionSignature* found = model::find_function(row.name);
    REQUIRE(found != nullptr);
    CHECK(mechanics::op_of(found->fn) == row.op);
    CHECK(found->min_arguments == row.arity);
    ++functions;
  }
  CHECK(functions == static_cast<std::size_t>(model::Fn::max) + 1);  // and there are no others
}
