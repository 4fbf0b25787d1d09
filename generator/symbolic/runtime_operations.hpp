// SPDX-License-Identifier: GPL-3.0-or-later
// The operations of the graph as those of expressions that a run evaluates (eom/expressions/operations.hpp): both stand
// in one order.
#pragma once

#include <eom/expressions/operations.hpp>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Not for leaves: constants, pi and symbols are numbers, variables or parameters there.
constexpr eom::expressions::Op runtime_op(Op op) { return static_cast<eom::expressions::Op>(op); }
constexpr Op function_at(eom::expressions::Op op) { return static_cast<Op>(op); }

namespace detail {
// The name of one operation is that of the other; a name that either lacks does not compile.
#define EOMGEN_SAME(op) static_assert(runtime_op(Op::op) == eom::expressions::Op::op)
EOMGEN_SAME(add);
EOMGEN_SAME(sub);
EOMGEN_SAME(mul);
EOMGEN_SAME(div);
EOMGEN_SAME(neg);
EOMGEN_SAME(power);
EOMGEN_SAME(pow);
EOMGEN_SAME(sqrt);
EOMGEN_SAME(sin);
EOMGEN_SAME(cos);
EOMGEN_SAME(tan);
EOMGEN_SAME(asin);
EOMGEN_SAME(acos);
EOMGEN_SAME(atan);
EOMGEN_SAME(sinh);
EOMGEN_SAME(cosh);
EOMGEN_SAME(tanh);
EOMGEN_SAME(exp);
EOMGEN_SAME(log);
EOMGEN_SAME(abs);
EOMGEN_SAME(sign);
EOMGEN_SAME(atan2);
EOMGEN_SAME(min);
EOMGEN_SAME(max);
EOMGEN_SAME(select);
#undef EOMGEN_SAME
}  // namespace detail

}  // namespace eomgen::symbolic
