// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/array_program.hpp"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

namespace eomgen::program {
namespace {

/// Adds a copy of one entry to runs at equal distances.
void add_copy(std::vector<ArrayRun>& runs, ArraySpace from_space, std::size_t from, ArraySpace to_space,
              std::size_t to) {
  if (!runs.empty()) {
    ArrayRun& last = runs.back();
    if (last.from_space == from_space && last.to_space == to_space && from > last.from && to > last.to) {
      const std::size_t from_step = last.count == 1 ? from - last.from : last.from_step;
      const std::size_t to_step = last.count == 1 ? to - last.to : last.to_step;
      if (from == last.from + last.count * from_step && to == last.to + last.count * to_step) {
        last.from_step = from_step;
        last.to_step = to_step;
        ++last.count;
        return;
      }
    }
  }
  runs.push_back({from_space, to_space, from, 1, to, 1, 1});
}

/// Joins runs of the same kind at equal distances.
std::vector<ArrayRun> grouped(const std::vector<ArrayRun>& runs) {
  std::vector<ArrayRun> result;
  for (const ArrayRun& run : runs) {
    if (!result.empty()) {
      ArrayRun& last = result.back();
      const bool alike = last.from_space == run.from_space && last.to_space == run.to_space &&
                         last.count == run.count && last.from_step == run.from_step && last.to_step == run.to_step;
      if (alike && run.from > last.from && run.to > last.to) {
        const std::size_t from_group = last.groups == 1 ? run.from - last.from : last.from_group;
        const std::size_t to_group = last.groups == 1 ? run.to - last.to : last.to_group;
        if (run.from == last.from + last.groups * from_group && run.to == last.to + last.groups * to_group) {
          last.from_group = from_group;
          last.to_group = to_group;
          ++last.groups;
          continue;
        }
      }
    }
    result.push_back(run);
  }
  return result;
}

class Build {
 public:
  Build(symbolic::Dag& dag, std::size_t n, const MakeFunction& make)
      : dag_(dag), n_(n), make_(make), is_written_(2 * n * n, false) {
    scalars_.name = "jac_scalars";
    scalars_.results.push_back({"scalars", {}, 0});
  }

  ArrayProgram run(const system::AccelerationSlopes& slopes,
                   const std::function<void(FunctionExpressions&)>& complete) {
    program_.work = slopes.work;
    for (const system::ArrayStep& step : slopes.steps) {
      ProgramStep made;
      for (const system::ArrayStore& store : step.stores) {
        entries().push_back(store.value);
        add_copy(made.before, ArraySpace::scalars, entries().size() - 1, space(store.to), index(store.to));
        note_written(store.to);
      }
      add_copies(made.before, step.before);
      if (step.loop.count > 0 && !step.loop.values.empty()) made.loop = loop(step.loop);
      add_copies(made.after, step.after);
      program_.copies += step.stores.size() + step.before.size() + step.after.size();
      made.before = grouped(made.before);
      made.after = grouped(made.after);
      program_.steps.push_back(std::move(made));
    }
    complete(scalars_);
    program_.scalars = make_(scalars_);
    program_.fills_result = std::all_of(is_written_.begin(), is_written_.end(), [](bool written) { return written; });
    return std::move(program_);
  }

 private:
  std::vector<Ref>& entries() { return scalars_.results[0].entries; }
  static ArraySpace space(const system::ArrayEntry& entry) {
    return entry.in_result ? ArraySpace::result : ArraySpace::work;
  }
  /// The accelerations are the lower half of df/dx.
  std::size_t index(const system::ArrayEntry& entry) const {
    return entry.in_result ? entry.index / n_ * 2 * n_ + n_ + entry.index % n_ : entry.index;
  }
  void note_written(const system::ArrayEntry& entry) {
    if (entry.in_result) is_written_[entry.index] = true;
  }
  void add_copies(std::vector<ArrayRun>& runs, const std::vector<system::ArrayCopy>& list) {
    for (const system::ArrayCopy& copy : list) {
      add_copy(runs, space(copy.from), index(copy.from), space(copy.to), index(copy.to));
      note_written(copy.to);
    }
  }

  ProgramLoop loop(const system::ArrayLoop& loop) {
    ProgramLoop made;
    made.count = loop.count;
    made.inputs = loop.inputs;
    made.outputs = loop.outputs;
    first_scalar_ = loop.inputs.size();
    own_scalars_.clear();
    FunctionExpressions body;
    body.name = "loop";
    body.results.push_back({"values", {}, 0});
    memo_.clear();
    for (const Ref value : loop.values) body.results[0].entries.push_back(hoisted(value));
    made.scalars = own_scalars_;
    made.body = make_(body);
    const Operations& once = made.body.operations;
    program_.loop_operations.add += loop.count * once.add;
    program_.loop_operations.mul += loop.count * once.mul;
    program_.loop_operations.div += loop.count * once.div;
    return made;
  }

  bool depends_on_pass(Ref r) {
    const auto [found, added] = depends_.try_emplace(r.id, false);
    if (!added) return found->second;
    const symbolic::Node& node = dag_[r];
    bool depends = node.op == Op::symbol && dag_.symbol_of(r).kind == SymbolKind::vector;
    for (std::uint8_t i = 0; i < node.arity && !depends; ++i) depends = depends_on_pass(node.args[i]);
    return depends_[r.id] = depends;
  }

  /// The expression with scalars in place of all that is the same in every pass.
  Ref hoisted(Ref r) {
    if (dag_.is_constant(r)) return r;
    const auto [found, added] = memo_.try_emplace(r.id, r);
    if (!added) return found->second;
    const Ref result = depends_on_pass(r) ? rebuilt(r) : scalar(r);
    return memo_[r.id] = result;
  }
  Ref rebuilt(Ref r) {
    const symbolic::Node node = dag_[r];
    if (node.op == Op::symbol) return r;
    const Ref a = hoisted(node.args[0]);
    switch (node.op) {
      case Op::neg: return dag_.neg(a);
      case Op::add: return dag_.add(a, hoisted(node.args[1]));
      case Op::sub: return dag_.sub(a, hoisted(node.args[1]));
      case Op::mul: return dag_.mul(a, hoisted(node.args[1]));
      case Op::div: return dag_.div(a, hoisted(node.args[1]));
      default: break;
    }
    throw std::logic_error("a loop over arrays contains an operation that is not of linear algebra");
  }
  Ref scalar(Ref r) {
    const auto [found, added] = known_scalars_.try_emplace(r.id, entries().size());
    if (added) entries().push_back(r);
    own_scalars_.push_back(found->second);
    return dag_.symbol({SymbolKind::vector, static_cast<std::uint32_t>(first_scalar_ + own_scalars_.size() - 1), 0});
  }

  symbolic::Dag& dag_;
  FunctionExpressions scalars_;
  std::size_t n_;
  const MakeFunction& make_;
  std::vector<bool> is_written_;
  ArrayProgram program_;
  std::unordered_map<std::uint32_t, bool> depends_;
  std::unordered_map<std::uint32_t, std::size_t> known_scalars_;
  // Of the present loop.
  std::unordered_map<std::uint32_t, Ref> memo_;
  std::vector<std::size_t> own_scalars_;
  std::size_t first_scalar_ = 0;
};

}  // namespace

ArrayProgram array_program(symbolic::Dag& dag, const system::AccelerationSlopes& slopes, std::size_t n,
                           const std::function<void(FunctionExpressions&)>& complete, const MakeFunction& make) {
  return Build(dag, n, make).run(slopes, complete);
}

}  // namespace eomgen::program
