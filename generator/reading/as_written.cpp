// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions of the model without rewriting: constraints and functions of time keep their author's form.
#include <cln/integer_io.h>

#include <sstream>

#include "mechanics/lowering.hpp"
#include "reading/reading.hpp"

namespace eomgen::reading {
namespace {

constexpr int deepest = 200;

// No value if the expression contains a vector or is too deep. It is then displayed in expanded form.
using Written = std::optional<Formula>;

// 981/100 -> 9.81: numbers of a model are decimals, stored exactly.
Formula decimal(const Rational& value) {
  constexpr int most_digits = 12;
  Formula f = number(value);
  Formula& inside = f.kind == FormulaKind::negative ? f.args[0] : f;
  cln::cl_I scaled = 0;
  int digits = 0;
  for (Rational x = cln::abs(value); digits <= most_digits; x = x * 10, ++digits) {
    scaled = cln::numerator(x);
    if (cln::denominator(x) == 1) break;
  }
  if (digits == 0 || digits > most_digits) return f;
  std::ostringstream text;
  text << scaled;
  std::string all = text.str();
  if (all.size() <= static_cast<std::size_t>(digits))
    all.insert(0, static_cast<std::size_t>(digits) + 1 - all.size(), '0');
  inside.word = all.insert(all.size() - static_cast<std::size_t>(digits), ".");
  return f;
}

class Writer {
 public:
  explicit Writer(const model::Model& model) : model_(model) {}

  Written operator()(model::NodeId id) {
    if (id == model::no_node || ++depth_ > deepest) return std::nullopt;
    const model::Node& node = model_.arena[id];
    Written result = node.vector ? std::nullopt : leaf(node);
    if (!result && !node.vector) result = operation(node);
    --depth_;
    return result;
  }

 private:
  Written leaf(const model::Node& node) {
    using model::Op;
    const auto of = [&](SymbolKind kind) { return symbol({kind, node.index, node.order}); };
    switch (node.op) {
      case Op::number: return decimal(node.value);
      case Op::pi: return make_formula(FormulaKind::pi, {});
      case Op::time: return symbol({SymbolKind::time, 0, 0});
      case Op::parameter: return of(SymbolKind::parameter);
      case Op::function: return of(SymbolKind::function);
      case Op::input: return of(SymbolKind::input);
      case Op::coordinate: return of(SymbolKind::coordinate);
      case Op::integral: return of(SymbolKind::integral);
      case Op::state: return of(SymbolKind::state);
      case Op::definition: return (*this)(model_.definitions[node.index].expression);
      default: return std::nullopt;
    }
  }

  Written operation(const model::Node& node) {
    using model::Op;
    std::vector<Formula> args;
    for (const model::NodeId id : node.args) {
      if (id == model::no_node) break;
      Written arg = (*this)(id);
      if (!arg) return std::nullopt;
      args.push_back(std::move(*arg));
    }
    switch (node.op) {
      case Op::add: return sum(std::move(args));
      case Op::subtract: {
        // a - (b + c) keeps its bracket
        Formula right = negative(args[1]);
        return is_zero(args[0]) ? right : sum({args[0], right});
      }
      case Op::negate: return negative(args[0]);
      case Op::multiply: return product(std::move(args));
      case Op::divide: return fraction(args[0], args[1]);
      case Op::power: return make_formula(FormulaKind::power, std::move(args));
      case Op::call: {
        Formula call = make_formula(FormulaKind::call, std::move(args));
        call.op = mechanics::op_of(node.fn);
        return call;
      }
      case Op::conditional: {
        Formula call = make_formula(FormulaKind::call, std::move(args));
        call.op = reading::Op::select;
        return call;
      }
      default: return std::nullopt;
    }
  }

  const model::Model& model_;
  int depth_ = 0;
};

}  // namespace

std::optional<Formula> as_written(const model::Model& model, model::NodeId expression) {
  return Writer(model)(expression);
}

}  // namespace eomgen::reading
