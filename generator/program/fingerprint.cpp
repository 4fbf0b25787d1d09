// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/fingerprint.hpp"

#include <cln/rational_io.h>
#include <fmt/format.h>

#include <iterator>
#include <sstream>

#include "program/array_program.hpp"

namespace eomgen::program {
namespace {

class Writer {
 public:
  std::string text;

  void program(const Program& p) {
    list(p.free);
    words(p.states.size(), p.discrete);
    for (const symbolic::Symbol& state : p.states) words(static_cast<int>(state.kind), state.index);
    words(p.formulation, system::name(p.approach), system::name(p.form));
    for (const auto* names : {&p.reactions, &p.outputs, &p.events, &p.kinks}) {
      words(names->size());
      for (const std::string& name : *names) words(name);
    }
    words(p.active_constraints, p.in_charts);
    for (const bool holonomic : p.holonomic) words(holonomic);
    for (const ContactInfo& c : p.contacts) words(c.name, c.dimensions, c.surface, c.unilateral, c.sticks, c.rolls);
    for (const eom::contacts::Description& c : p.contact_set.contacts)
      words(c.name, c.unilateral, c.sticks, c.rolls, c.friction_input, c.force_input, c.mode_input);
    for (const ChartInfo& c : p.charts) {
      words(c.of, c.own, c.second, c.regular, c.guarded, c.second_at_sine);
      list(c.angles);
      function(c.to);
      function(c.back);
    }
    for (const Function& f : p.functions) function(f);
    if (p.taylor) {
      words(p.taylor->order_zero_count, p.taylor->product_count);
      function(p.taylor->start);
      function(p.taylor->next);
    }
    for (const Program& other : p.chart_variants) program(other);
  }

 private:
  // Lengths come first, so that different lists never give the same text.
  void word(const std::string& value) { fmt::format_to(std::back_inserter(text), "{}:{} ", value.size(), value); }
  void word(const char* value) { word(std::string(value)); }
  template <class Number>
  void word(Number value) {
    fmt::format_to(std::back_inserter(text), "{} ", value);
  }
  template <class... Values>
  void words(const Values&... values) {
    (word(values), ...);
    text += '\n';
  }
  void list(const std::vector<std::uint32_t>& values) {
    words(values.size());
    for (const std::uint32_t value : values) word(value);
  }
  void operand(const Operand& o) {
    fmt::format_to(std::back_inserter(text), "{}{},{} ", o.negated ? "-" : "", static_cast<int>(o.slot), o.index);
  }

  void function(const Function& f) {
    words(f.name, f.results.size(), f.constants.size(), f.code.size(), f.pivots.size());
    for (const Result& result : f.results) {
      words(result.name, result.code, result.entries.size());
      for (const Operand& o : result.entries) operand(o);
    }
    list(f.result_indices);
    for (const symbolic::Rational& constant : f.constants) {
      std::ostringstream out;
      out << constant;
      words(out.str());
    }
    for (const Instruction& i : f.code) {
      fmt::format_to(std::back_inserter(text), "{} {} {} ", static_cast<int>(i.op), i.exponent, i.operands.size());
      for (const Operand& o : i.operands) operand(o);
    }
    for (const PivotTest& p : f.pivots) {
      operand(p.pivot);
      operand(p.scale);
    }
    if (f.loops) loops(*f.loops);
  }

  void runs(const std::vector<ArrayRun>& list) {
    words(list.size());
    for (const ArrayRun& run : list)
      words(static_cast<int>(run.from_space), static_cast<int>(run.to_space), run.from, run.from_step, run.to,
            run.to_step, run.count, run.from_group, run.to_group, run.groups);
  }
  void loops(const ArrayProgram& p) {
    words(p.work, p.fills_result, p.steps.size());
    function(p.scalars);
    for (const ProgramStep& step : p.steps) {
      runs(step.before);
      runs(step.after);
      if (!step.loop) continue;
      words(step.loop->count);
      for (const auto* list : {&step.loop->inputs, &step.loop->scalars, &step.loop->outputs})
        words(fmt::format("{}", fmt::join(*list, " ")));
      function(step.loop->body);
    }
  }
};

}  // namespace

std::string fingerprint(const Program& program) {
  Writer writer;
  writer.program(program);
  return std::move(writer.text);
}

}  // namespace eomgen::program
