// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/file_parts.hpp"

#include <fmt/format.h>

#include "abi/functions.hpp"
#include "emit/expressions.hpp"
#include "emit/metadata.hpp"
#include "emit/signature.hpp"
#include "emit/text.hpp"
#include "emit/uses.hpp"
#include "lists.hpp"
#include "program/array_program.hpp"

namespace eomgen::emit {

using program::ArrayRun;
using program::ArraySpace;
using program::Program;
using program::ProgramLoop;

namespace {

// Printing of loops over arrays (program/array_program.hpp) as statements of C or C++.

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

/// The body of `jac` of `states` states. `scalars`: the function for the scalars, whose arguments but the last are
/// `arguments`.
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

const Function* find(const Program& program, const std::string& name) { return find_named(program.functions, name); }

std::string chart_name(unsigned in_charts) { return in_charts == 0 ? "own" : fmt::format("chart{}", in_charts); }

bool is_without_mode(const std::string& name) { return !abi::find(name)->has_input(abi::Input::mode); }

class Parts {
 public:
  Parts(const Program& program, const std::string& prefix, const Dialect& dialect)
      : program_(program), prefix_(prefix), dialect_(dialect), real_(dialect.real) {}

  std::vector<FilePart> run() {
    for (const Function& function : program_.functions) {
      if (program_.charts.empty()) {
        add(function.name, function_purpose(function.name), function, false);
        continue;
      }
      in_each_chart(function.name);
      if (function.name == "prepare") {
        prepare();
      } else {
        choose(function);
      }
    }
    if (!program_.charts.empty()) exchange();
    return std::move(parts_);
  }

 private:
  const Program* next(const Program* p) const {  // the program itself, then its chart variants
    if (p == nullptr) return &program_;
    const std::size_t k = p == &program_ ? 0 : static_cast<std::size_t>(p - program_.chart_variants.data()) + 1;
    return k < program_.chart_variants.size() ? &program_.chart_variants[k] : nullptr;
  }

  void in_each_chart(const std::string& name) {
    for (const Program* p = next(nullptr); p != nullptr; p = next(p)) {
      const Function* function = find(*p, name);
      if (function == nullptr) continue;
      add(chart_name(p->in_charts) + "_" + name, fmt::format("{} in {}.", name, chart_title(program_, p->in_charts)),
          *function, true);
    }
  }

  static std::string names(const std::vector<Argument>& list, const std::string& offset = "") {
    std::string text;
    for (const Argument& argument : list)
      text += (text.empty() ? "" : ", ") + argument.name + (argument.slot == program::Slot::prepared ? offset : "");
    return text;
  }
  std::string call(const Program& p, const std::string& name, const std::vector<Argument>& list,
                   const std::string& offset = "") const {
    return fmt::format("{}{}_{}({})", prefix_, chart_name(p.in_charts), name, names(list, offset));
  }
  void choose(const Function& function) {
    const std::string& name = function.name;
    const std::vector<Argument> list = abi_arguments(name);
    if (is_without_mode(name)) {
      add(name, function_purpose(name) + " In the own charts.", argument_list(list, real_),
          fmt::format("  return {};\n", call(program_, name, list)));
      add(name + "_in", function_purpose(name + "_in"), argument_list(abi_arguments(name + "_in"), real_),
          by_mode(name, list));
      return;
    }
    add(name, function_purpose(name), argument_list(list, real_), by_mode(name, list));
  }

  std::string by_mode(const std::string& name, const std::vector<Argument>& list) {
    std::string charts;
    for (std::size_t j = 0; j < program_.charts.size(); ++j)
      charts += fmt::format("{}(mode[{}] != 0){}", j > 0 ? " | " : "", program_.mode_layout().chart(j),
                            j > 0 ? fmt::format(" << {}", j) : "");
    std::string body = fmt::format("  switch (mode ? {} : 0) {{\n", charts);
    std::size_t offset = 0;
    for (const Program* p = next(nullptr); p != nullptr; p = next(p)) {
      const bool prepared = abi::find(name)->has_input(abi::Input::prepared);
      std::string calls;
      if (!prepared || find(*p, name) != nullptr) {
        calls = call(*p, name, list, prepared && offset > 0 ? fmt::format(" + {}", offset) : "");
      } else {  // this chart has no prepared values
        calls = call(*p, "rhs", abi_arguments("rhs"));
      }
      if (prepared) offset += p->result_size("prepare");
      body += fmt::format("    case {}: return {};\n", p->in_charts, calls);
    }
    return body + "    default: return 2;\n  }\n";
  }

  void prepare() {
    std::string body = "  int code = 0;\n";
    std::size_t offset = 0;
    for (const Program* p = next(nullptr); p != nullptr; p = next(p)) {
      const std::size_t entries = p->result_size("prepare");
      if (entries == 0) continue;
      body += fmt::format("  if (code == 0) code = {}{}_prepare(p, w{});\n", prefix_, chart_name(p->in_charts),
                          offset > 0 ? fmt::format(" + {}", offset) : "");
      offset += entries;
    }
    add("prepare", function_purpose("prepare"), argument_list(abi_arguments("prepare"), real_),
        body + "  return code;\n");
  }

  /// Changes charts, one at a time.
  void exchange() {
    std::string body =
        fmt::format("  int code = 0;\n  for (int i = 0; i < {}; ++i) y[i] = x[i];\n", program_.state_count());
    for (std::size_t j = 0; j < program_.charts.size(); ++j) {
      const program::ChartInfo& chart = program_.charts[j];
      for (const Function* function : {&chart.to, &chart.back}) {
        parts_.push_back({fmt::format("{}_{}", function->name, j + 1),
                          fmt::format("{}: from {} to {}.", chart.of, function == &chart.to ? chart.own : chart.second,
                                      function == &chart.to ? chart.second : chart.own),
                          function, true, "", ""});
      }
      body += fmt::format(
          "  if (code == 0 && (mode && mode[{0}]) != (to && to[{0}])) code = to && to[{0}] ? {1}to_second_{2}(y, y) : "
          "{1}to_own_{2}(y, y);\n",
          program_.mode_layout().chart(j), prefix_, j + 1);
    }
    add("chart", function_purpose("chart"), argument_list(abi_arguments("chart"), real_), body + "  return code;\n");
  }

  /// A function of the program. One with loops calls another one for its scalars.
  void add(const std::string& name, const std::string& what, const Function& function, bool internal) {
    if (!function.loops) {
      parts_.push_back({name, what, &function, internal, "", ""});
      return;
    }
    const std::string scalars = name + "_scalars";
    std::vector<Argument> list = abi_arguments(function.name);
    const std::string arguments = argument_list(list, real_);
    std::erase_if(list, [](const Argument& argument) { return argument.kind == Argument::Kind::result; });
    parts_.push_back(
        {scalars, fmt::format("Scalars of {}, before its loops.", name), &function.loops->scalars, true, "", ""});
    parts_.push_back({name, what, nullptr, internal, arguments,
                      print_loops(*function.loops, program_.state_count(), dialect_, prefix_ + scalars, names(list))});
  }

  void add(const std::string& name, const std::string& what, const std::string& arguments, const std::string& body) {
    parts_.push_back({name, what, nullptr, false, arguments, body});
  }

  const Program& program_;
  std::string prefix_;
  const Dialect& dialect_;
  std::string real_;
  std::vector<FilePart> parts_;
};

}  // namespace

std::vector<FilePart> file_parts(const Program& program, const std::string& prefix, const Dialect& dialect) {
  return Parts(program, prefix, dialect).run();
}

std::string chart_title(const Program& program, unsigned in_charts) {
  std::string title;
  for (std::size_t j = 0; j < program.charts.size(); ++j) {
    const program::ChartInfo& chart = program.charts[j];
    const bool second = (in_charts >> j & 1u) != 0;
    title += fmt::format("{}{} of {}", title.empty() ? "" : ", ", second ? chart.second : chart.own, chart.of);
  }
  return title;
}

}  // namespace eomgen::emit
