// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/array_loops.hpp"

#include <fmt/format.h>

#include "emit/expressions.hpp"
#include "emit/text.hpp"
#include "emit/uses.hpp"

namespace eomgen::emit {
namespace {

using program::ArrayRun;
using program::ArraySpace;
using program::ProgramLoop;

const char* name(ArraySpace space) {
  switch (space) {
    case ArraySpace::scalars: return "scalars";
    case ArraySpace::work: return "work";
    case ArraySpace::result: break;
  }
  return "dfdx";
}

std::string entry(const char* array, std::size_t first, std::size_t step, std::size_t group = 0) {
  std::string index = first == 0 ? "" : fmt::format("{} + ", first);
  if (group > 0) index += group == 1 ? "j + " : fmt::format("{}*j + ", group);
  return fmt::format("{}[{}{}]", array, index, step == 1 ? "k" : fmt::format("{}*k", step));
}

class LoopPrinter {
 public:
  explicit LoopPrinter(const Dialect& dialect) : dialect_(dialect) {}

  std::string text;

  void runs(const std::vector<ArrayRun>& list) {
    for (const ArrayRun& run : list) {
      const char *to = name(run.to_space), *from = name(run.from_space);
      if (run.groups > 1)
        line(fmt::format("  for (j = 0; j < {}; ++j)\n    for (k = 0; k < {}; ++k) {} = {};", run.groups, run.count,
                         entry(to, run.to, run.to_step, run.to_group),
                         entry(from, run.from, run.from_step, run.from_group)));
      else if (run.count == 1)
        line(fmt::format("  {}[{}] = {}[{}];", to, run.to, from, run.from));
      else
        line(fmt::format("  for (k = 0; k < {}; ++k) {} = {};", run.count, entry(to, run.to, run.to_step),
                         entry(from, run.from, run.from_step)));
    }
  }

  void loop(const ProgramLoop& loop) {
    const program::Function& body = loop.body;
    const Uses uses = count_uses(body);
    ModelNames names;
    for (std::size_t i = 0; i < loop.inputs.size(); ++i) names.vector.push_back(fmt::format("a{}", i));
    for (const std::size_t scalar : loop.scalars) names.vector.push_back(fmt::format("s{}", scalar));
    std::string scalars, inputs;
    for (const auto& [slot, index] : uses.leaves[0]) {
      if (slot != Slot::vector) continue;
      const bool input = index < loop.inputs.size();
      std::string& list = input ? inputs : scalars;
      list += fmt::format("{}{} = {}", list.empty() ? dialect_.declaration_prefix() + " " : ", ", names.vector[index],
                          input ? entry("work", loop.inputs[index], 1)
                                : fmt::format("scalars[{}]", loop.scalars[index - loop.inputs.size()]));
    }
    text += "  {\n";
    if (!scalars.empty()) line("    " + scalars + ";");
    text += fmt::format("    for (k = 0; k < {}; ++k) {{\n", loop.count);
    if (!inputs.empty()) line("      " + inputs + ";");
    Expressions expressions(body, names, dialect_);
    std::size_t temporaries = 0;
    for (std::size_t i = 0; i < body.code.size(); ++i) {
      const Expressions::Expression value = expressions.print(body.code[i]);
      if (uses.count[i] <= 1 && value.text.size() <= max_inline_length) {
        expressions.set(i, value);
        continue;
      }
      const std::string variable = fmt::format("v{}", ++temporaries);
      line(fmt::format("      {} {} = {};", dialect_.declaration_prefix(), variable, value.text));
      expressions.set(i, {variable, Expressions::Expression::atom});
    }
    for (std::size_t i = 0; i < loop.outputs.size(); ++i)
      line(fmt::format("      {} = {};", entry("work", loop.outputs[i], 1),
                       expressions.signed_value(body.results[0].entries[i]).text));
    text += "    }\n  }\n";
  }

  void line(const std::string& statement) { text += wrapped(statement, "          ") + "\n"; }

 private:
  const Dialect& dialect_;
};

}  // namespace

std::string print_loops(const program::ArrayProgram& program, std::size_t states, const Dialect& dialect,
                        const std::string& scalars, const std::string& arguments) {
  LoopPrinter printer(dialect);
  const std::string zero = dialect.constant(0);
  printer.line(fmt::format("  {} scalars[{}], work[{}];", dialect.real, program.scalars.results[0].entries.size(),
                           program.work));
  printer.line(fmt::format("  const int code = {}({}, scalars);", scalars, arguments));
  printer.line("  int j, k;");
  printer.line("  if (code != 0) return code;");
  printer.line(fmt::format("  for (k = 0; k < {}; ++k) work[k] = {};", program.work, zero));
  printer.line(fmt::format("  for (j = 0; j < {0}; ++j)\n    for (k = 0; k < {1}; ++k) dfdx[{0}*j + k] = {2};", states,
                           program.fills_result ? states / 2 : states, zero));
  printer.line(fmt::format("  for (k = 0; k < {0}; ++k) dfdx[{1} + {2}*k] = {3};", states / 2, states * states / 2,
                           states + 1, dialect.constant(1)));
  printer.line(fmt::format("  if (dfdt)\n    for (k = 0; k < {}; ++k) dfdt[k] = {};", states, zero));
  for (const program::ProgramStep& step : program.steps) {
    printer.runs(step.before);
    if (step.loop) printer.loop(*step.loop);
    printer.runs(step.after);
  }
  printer.line("  return 0;");
  return std::move(printer.text);
}

}  // namespace eomgen::emit
