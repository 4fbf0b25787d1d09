// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/taylor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "error.hpp"
#include "program/series_builder.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::program {
namespace {

using symbolic::Rational;
using symbolic::Slope;

constexpr std::size_t stack_budget = std::size_t{1} << 21;  // bytes for the series of all products

class Recurrences : private SeriesBuilder {
 public:
  explicit Recurrences(const Function& rhs) : SeriesBuilder(rhs), rhs_(rhs) {}

  Taylor run() {
    for (const Instruction& instruction : rhs_.code) {
      section_ = instruction.section.empty() ? section_ : instruction.section;
      const std::size_t first = start_.code.size();
      values_.push_back(of(instruction));
      if (first < start_.code.size()) start_.code[first].section = instruction.section;
    }
    return finished(rhs_);
  }

 private:
  Series copied(const Instruction& instruction) {
    Instruction copy = instruction;
    for (Operand& operand : copy.operands) operand = read(operand).zero;
    start_.code.push_back(std::move(copy));
    return {false, {Slot::value, static_cast<std::uint32_t>(start_.code.size() - 1)}, {}};
  }

  Series of(const Instruction& instruction) {
    std::vector<Series> a;
    bool varies = false;
    for (const Operand& operand : instruction.operands) {
      a.push_back(read(operand));
      varies = varies || a.back().varies;
    }
    if (!varies) return copied(instruction);
    const std::string& name = instruction.name;
    switch (instruction.op) {  // operations other than functions of one argument with a known derivative
      case Op::add: return total(a, name);
      case Op::mul: return product(a, name);
      case Op::div: return quotient(a[0], a[1], name);
      case Op::sin: return trig(a[0], instruction)[0];
      case Op::cos: return trig(a[0], instruction)[1];
      case Op::sqrt: return root(a[0], name);
      case Op::pow: return general_power(a[0], a[1], instruction);
      case Op::abs:
      case Op::sign:
      case Op::min:
      case Op::max:
      case Op::select: return branch(a, instruction);
      default: return function(a, instruction);
    }
  }

  Series total(const std::vector<Series>& a, const std::string& name = {}) {
    std::vector<Operand> zero, next;
    for (const Series& s : a) {
      zero.push_back(s.zero);
      if (s.varies) next.push_back(s.next);
    }
    return {true, at_start(Op::add, zero, name), at_next(Op::add, next)};
  }

  Series times(const Series& a, const Series& b, const std::string& name = {}) {
    const auto [at, anew] = products_.try_emplace(std::minmax(keys(a), keys(b)));
    if (!anew) return at->second;
    Series& c = at->second;
    c.varies = true;
    c.zero = at_start(Op::mul, {a.zero, b.zero}, name);
    const Operand s = sum(a.next, b.next);
    if (keys(a) == keys(b)) {
      c.next = at_next(Op::add, {s, at_next(Op::mul, {constant(next_, 2), start_value(a.zero), a.next})});
    } else {
      c.next = at_next(Op::add, {s, at_next(Op::mul, {start_value(a.zero), b.next}),
                                 at_next(Op::mul, {a.next, start_value(b.zero)})});
    }
    return c;
  }

  Series scaled(const Series& a, const Operand& factor, const std::string& name = {}) {
    return {true, at_start(Op::mul, {factor, a.zero}, name), at_next(Op::mul, {start_value(factor), a.next})};
  }

  Series product(const std::vector<Series>& a, const std::string& name) {
    std::vector<Operand> still;
    std::vector<Series> moving;
    for (const Series& s : a) {
      if (s.varies)
        moving.push_back(s);
      else
        still.push_back(s.zero);
    }
    const bool last_scales = !still.empty();
    Series result = moving[0];
    for (std::size_t i = 1; i < moving.size(); ++i) {
      result = times(result, moving[i], i + 1 == moving.size() && !last_scales ? name : std::string{});
    }
    return last_scales ? scaled(result, at_start(Op::mul, still), name) : result;
  }

  Series quotient(const Series& a, const Series& b, const std::string& name) {
    const Operand inverse = at_start(Op::div, {one(), b.zero});
    if (!b.varies)
      return {true, at_start(Op::div, {a.zero, b.zero}, name), at_next(Op::mul, {a.next, start_value(inverse)})};
    Series c{true, at_start(Op::div, {a.zero, b.zero}, name), {}};
    const Operand s = open_sum(b.next);
    std::vector<Operand> rest{negate(s), negate(at_next(Op::mul, {b.next, start_value(c.zero)}))};
    if (a.varies) rest.insert(rest.begin(), a.next);
    c.next = at_next(Op::mul, {start_value(inverse), at_next(Op::add, rest)});
    close_sum(s, c.next);
    return c;
  }

  Series root(const Series& a, const std::string& name = {}) {
    Series c{true, at_start(Op::sqrt, {a.zero}, name), {}};
    const Operand inverse = at_start(Op::div, {constant(start_, Rational(1) / 2), c.zero});
    const Operand s = open_sum({});
    c.next = at_next(Op::mul, {start_value(inverse), at_next(Op::add, {a.next, negate(s)})});
    close_sum(s, c.next, c.next);
    return c;
  }

  /// The sine and the cosine of one angle, in the pack of the requested one.
  const std::array<Series, 2>& trig(const Series& a, const Instruction& asked) {
    const auto [at, anew] = trig_.try_emplace(keys(a));
    if (!anew) return at->second;
    std::array<Series, 2>& result = at->second;
    for (const std::size_t i : {0U, 1U}) {
      const Op op = i == 0 ? Op::sin : Op::cos;
      result[i] = {true, at_start(op, {a.zero}, asked.op == op ? asked.name : ""), {}};
      start_.code.back().pack = asked.pack;
      start_.code.back().lane = asked.lane;
    }
    pair(a, result[0], result[1], true);
    return result;
  }

  /// s' = c a', c' = s a', or c' = -s a' if `turns`.
  void pair(const Series& a, Series& s, Series& c, bool turns) {
    const Operand w = times_order(a), of_c = open_sum(w), of_s = open_sum(w);
    const auto signed_by = [turns](const Operand& o) { return turns ? negate(o) : o; };
    s.next = divide_by_order(at_next(Op::add, {of_c, at_next(Op::mul, {w, start_value(c.zero)})}));
    c.next =
        divide_by_order(at_next(Op::add, {signed_by(of_s), signed_by(at_next(Op::mul, {w, start_value(s.zero)}))}));
    close_sum(of_c, c.next);
    close_sum(of_s, s.next);
  }

  /// The coefficient of c with c' = b a'. The k-th coefficient of b may be set later by close_sum(result.second,
  /// b.next).
  std::pair<Operand, Operand> integrated(const Series& a, const Operand& b_zero) {
    const Operand w = times_order(a), s = open_sum(w);
    return {divide_by_order(at_next(Op::add, {s, at_next(Op::mul, {w, start_value(b_zero)})})), s};
  }

  /// c_k for b c' = n', given k n_k.
  Operand divided(const std::vector<Operand>& n, const Series& b) {
    const Operand inverse = at_start(Op::div, {one(), b.zero});
    const Operand s = open_sum({});
    std::vector<Operand> rest = n;
    rest.push_back(negate(s));
    const Operand w = at_next(Op::mul, {start_value(inverse), at_next(Op::add, rest)});
    close_sum(s, w, b.next);
    return divide_by_order(w);
  }

  /// 1 + sign a^2.
  Series one_and_square(const Series& a, bool plus) {
    const Series square = times(a, a);
    return total({Series{false, one(), {}}, plus ? square : negate(square)});
  }

  /// A function of one argument, by its derivative in the table of functions.
  Series function(const std::vector<Series>& a, const Instruction& instruction) {
    Series c{true, copied(instruction).zero, {}};
    if (instruction.op == Op::atan2) {
      c.next = angle(a[0], a[1]);
      return c;
    }
    const symbolic::Function& f = symbolic::function_of(instruction.op);
    const auto fall = [&f](const Operand& o) { return f.falls() ? negate(o) : o; };
    switch (f.slope()) {
      case Slope::self: {
        const auto [next, s] = integrated(a[0], c.zero);
        c.next = next;
        close_sum(s, next);
        return c;
      }
      case Slope::one_plus_v2:
      case Slope::one_minus_v2: {
        const bool plus = f.slope() == Slope::one_plus_v2;
        const Operand square = at_start(Op::mul, {c.zero, c.zero});
        const Operand slope = at_start(Op::add, {one(), plus ? square : negate(square)});
        const auto [next, s] = integrated(a[0], slope);
        c.next = next;
        close_sum(s, one_and_square(c, plus).next);
        return c;
      }
      case Slope::other: {
        const bool odd = f.parity == symbolic::Parity::odd;
        Series other{true, at_start(f.other(), {a[0].zero}), {}};
        pair(a[0], odd ? c : other, odd ? other : c, f.falls() || symbolic::function_of(f.other()).falls());
        return c;
      }
      case Slope::over_x: c.next = divided({times_order(a[0])}, a[0]); return c;
      case Slope::over_one_plus_x2: c.next = divided({times_order(a[0])}, one_and_square(a[0], true)); return c;
      case Slope::over_root: c.next = divided({fall(times_order(a[0]))}, root(one_and_square(a[0], false))); return c;
      default: throw std::logic_error("an operation without a recurrence");
    }
  }

  /// (x^2 + y^2) c' = x y' - y x'.
  Operand angle(const Series& y, const Series& x) {
    std::vector<Operand> n;
    const auto add = [&](const Series& moving, const Series& factor, bool negated) {
      if (!moving.varies) return;
      const Operand w = times_order(moving), rest = at_next(Op::mul, {w, start_value(factor.zero)});
      n.push_back(negated ? negate(rest) : rest);
      if (!factor.varies) return;
      const Operand s = sum(w, factor.next);
      n.push_back(negated ? negate(s) : s);
    };
    add(y, x, false);
    add(x, y, true);
    const auto square = [this](const Series& s) {
      return s.varies ? times(s, s) : Series{false, at_start(Op::mul, {s.zero, s.zero}), {}};
    };
    return divided(n, total({square(x), square(y)}));
  }

  /// a c' = b c a' if b is constant, else c' = c (b log a)'.
  Series general_power(const Series& a, const Series& b, const Instruction& instruction) {
    Series c{true, copied(instruction).zero, {}};
    if (b.varies) {
      const Series log =
          a.varies ? function({a}, logarithm(instruction)) : Series{false, at_start(Op::log, {a.zero}), {}};
      const Series exponent = a.varies ? times(b, log) : scaled(b, log.zero);
      const auto [next, s] = integrated(exponent, c.zero);
      c.next = next;
      close_sum(s, next);
      return c;
    }
    const Operand w = times_order(a), s = open_sum(w);
    const Operand n = at_next(Op::add, {s, at_next(Op::mul, {w, start_value(c.zero)})});
    c.next = divided({at_next(Op::mul, {start_value(b.zero), n})}, a);
    close_sum(s, c.next);
    return c;
  }
  static Instruction logarithm(const Instruction& power) {
    Instruction result;
    result.op = Op::log;
    result.operands = {power.operands[0]};
    return result;
  }

  /// Keeps the branch of order 0.
  Series branch(const std::vector<Series>& a, const Instruction& instruction) {
    Series c = copied(instruction);
    const auto next_of = [this](const Series& s) { return s.varies ? s.next : constant(next_, 0); };
    const auto choose = [&](const Operand& low, const Operand& high, const Operand& yes, const Operand& no) {
      c.varies = true;
      c.next = at_next(Op::select, {start_value(low), start_value(high), yes, no});
    };
    switch (instruction.op) {
      case Op::abs: choose(a[0].zero, constant(start_, 0), negate(a[0].next), a[0].next); break;
      case Op::min: choose(a[1].zero, a[0].zero, next_of(a[1]), next_of(a[0])); break;
      case Op::max: choose(a[0].zero, a[1].zero, next_of(a[1]), next_of(a[0])); break;
      case Op::select:
        if (a[2].varies || a[3].varies) choose(a[0].zero, a[1].zero, next_of(a[2]), next_of(a[3]));
        break;
      default: break;  // sign: constant
    }
    return c;
  }

  const Function& rhs_;
  std::string section_;
  std::map<std::pair<Keys, Keys>, Series> products_;
  std::map<Keys, std::array<Series, 2>> trig_;
};

}  // namespace

std::size_t taylor_order(const Taylor& taylor) {
  return std::min(taylor_highest_order, stack_budget / (2 * sizeof(double) * taylor.product_count));
}

Taylor recurrences(const Function& rhs) { return Recurrences(rhs).run(); }

Taylor taylor_series(const Function& rhs) {
  Taylor taylor = recurrences(rhs);
  if (taylor_order(taylor) < taylor_lowest_order) {
    throw Error("program", {},
                fmt::format("the equations are too large for Taylor series: {} products", taylor.product_count),
                "take another solver, and leave taylor out of --with");
  }
  return taylor;
}

}  // namespace eomgen::program
