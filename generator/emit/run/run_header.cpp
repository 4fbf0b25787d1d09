// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/run/run_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <eom/hybrid/problem.hpp>
#include <optional>
#include <type_traits>

#include "abi/functions.hpp"
#include "emit/metadata.hpp"
#include "emit/text.hpp"
#include "skeletons/cpp_run_hpp.hpp"
#include "skeletons/cpp_set_start.hpp"

namespace eomgen::emit {
namespace {

using eom::hybrid::Problem;

std::string number(double value) {
  if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
  return decimal(value);
}
std::string text(bool value) { return value ? "true" : "false"; }
template <class Number>
std::string text(Number value) requires std::is_integral_v<Number> {
  return fmt::format("{}", value);
}
std::string text(double value) { return number(value); }
std::string text(const std::string& value) { return string_literal(value, "      "); }
std::string text(const std::optional<std::size_t>& value) { return value ? text(*value) : "std::nullopt"; }
template <class Entry>
std::string text(const std::vector<Entry>& list);
std::string text(const eom::expressions::Step& step) {
  std::size_t given = std::max<std::size_t>(1, eom::expressions::operands(step.op));
  if (step.op == eom::expressions::Op::power) given = 2;
  std::string operands;
  for (std::size_t k = 0; k < given; ++k) operands += fmt::format("{}{}", k == 0 ? "" : ", ", step.a[k]);
  return fmt::format("{{Op::{}, {{{}}}}}", eom::expressions::name_of(step.op), operands);
}
std::string text(const eom::expressions::Table& table) {
  return fmt::format("{{{}, {}, {}}}", text(table.steps), text(table.numbers), text(table.roots));
}
std::string text(const eom::hybrid::Signal& signal) {
  if (!signal.times.empty())
    return fmt::format("{{{{}}, {}, {}, {{}}{}}}", text(signal.times), text(signal.values),
                       signal.linear ? ", true" : "");
  if (signal.expression.empty()) return "{}";
  return fmt::format("{{{{}}, {{}}, {{}}, {}}}", text(signal.expression));
}
std::string text(const eom::hybrid::JumpFunctions::Function& function) {
  static constexpr std::array<const char*, 7> kinds{"potential", "momentum", "psi", "row", "rate", "place", "velocity"};
  return fmt::format("{{Quantity::{}, {}{}}}", kinds.at(static_cast<std::size_t>(function.what)), text(function.name),
                     function.constraint == 0 ? "" : fmt::format(", {}", function.constraint));
}
std::string text(const eom::hybrid::Range& r) { return fmt::format("{{{}, {}}}", number(r.lower), number(r.upper)); }
std::string text(const eom::hybrid::OwnOutputs& own) {
  return fmt::format("{{{}, {}}}", own.in_charts, text(own.outputs));
}
std::string text(const eom::Contact& c) {
  return fmt::format("{{{{{}, {}, {}, {}, {}}}, {}, 0.0}}", c.dimensions, c.surface, c.unilateral, c.sticks, c.rolls,
                     text(c.name));
}
std::string place(std::size_t index) { return index == eom::contacts::none ? "none" : fmt::format("{}", index); }
std::string text(const eom::contacts::Row& row) { return fmt::format("{{{}, {}}}", row.first, text(row.columns)); }
std::string text(const eom::contacts::Description& c) {
  return fmt::format("{{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}}", text(c.name), c.unilateral,
                     c.sticks, c.rolls, place(c.gap), text(c.normal), place(c.normal_scale), place(c.given_normal),
                     text(c.slip), place(c.static_coefficient), place(c.dynamic_coefficient), place(c.width),
                     place(c.restitution), place(c.friction_input), place(c.force_input), place(c.mode_input));
}
std::string text(eom::contacts::ImpactLaw law) {
  static constexpr std::array<const char*, 4> laws{"newton", "poisson", "moreau", "stronge"};
  return fmt::format("eom::contacts::ImpactLaw::{}", laws.at(static_cast<std::size_t>(law)));
}
std::string text(eom::contacts::ImpactOrder order) {
  static constexpr std::array<const char*, 2> orders{"simultaneous", "sequence"};
  return fmt::format("eom::contacts::ImpactOrder::{}", orders.at(static_cast<std::size_t>(order)));
}
std::string text(const eom::hybrid::Reset::Entry& entry) {
  return fmt::format("{{{}, {}}}", entry.component, entry.value);
}
std::string text(const eom::hybrid::Reset& reset) {
  return fmt::format("{{{}, {}}}", text(reset.set), text(reset.condition));
}
std::string text(const eom::hybrid::Noise& noise) {
  return fmt::format("{{{}, {}, {}}}", noise.component, noise.normal, noise.seed);
}
std::string text(const eom::hybrid::Sample& sample) {
  return fmt::format("{{{}, {}, {}, {}, {}{}}}", text(sample.name), number(sample.every), number(sample.offset),
                     text(sample.noise), text(sample.reset), sample.times.empty() ? "" : ", " + text(sample.times));
}
std::string text(const eom::hybrid::WatchedEvent& event) {
  const char* direction = event.direction == eom::Direction::any  ? "any"
                          : event.direction == eom::Direction::up ? "up"
                                                                  : "down";
  const bool plain = event.reset.set.empty() && !event.reset.condition;
  return fmt::format("{{{}, eom::Direction::{}, {}{}}}", text(event.name), direction, event.stop,
                     plain ? "" : ", " + text(event.reset));
}
std::string text(const eom::hybrid::Invariant& i) {
  return fmt::format("{{{}, {}, {}, {}}}", text(i.name), i.output, text(i.magnitude), i.energy);
}
std::string text(const eom::hybrid::IntegralOutputs& i) { return fmt::format("{{{}, {}}}", i.psi, text(i.slopes)); }
std::string text(const eom::hybrid::ContactOutputs& c) {
  return fmt::format("{{{}, {}, {}, {}, {}{}}}", text(c.slip), text(c.slopes), text(c.phi), c.constraint,
                     text(c.restitution), c.normal_scale ? ", " + text(c.normal_scale) : "");
}
std::string text(const eom::hybrid::ExchangedChart& c) {
  return fmt::format("{{{}, {}, {}, {}, {}, {}}}", text(c.of), text(c.angles), text(c.coordinates), c.guarded,
                     c.at_sine, c.second_at_sine);
}
template <class Entry>
std::string text(const std::vector<Entry>& list) {
  return "{" + joined(list, [](const Entry& entry) { return text(entry); }) + "}";
}

/// Assignment statements for nonempty values.
class Statements {
 public:
  explicit Statements(std::string of) : of_(std::move(of)) {}
  template <class Value>
  void set(const char* member, const Value& value) {
    line(fmt::format("{}.{} = {};", of_, member, text(value)));
  }
  template <class Entry>
  void list(const char* member, const std::vector<Entry>& entries) {
    if (entries.empty()) return;
    if constexpr (std::is_arithmetic_v<Entry>) {
      line(wrapped(fmt::format("{}.{} = {};", of_, member, text(entries)), "      "));
    } else {  // names may contain blanks, where lines must not break
      const std::string all = joined(
          entries, [](const Entry& entry) { return in_lines(entry); }, ",\n      ");
      line(fmt::format("{}.{} = {{{}}};", of_, member, all));
    }
  }
  void table(const char* member, const eom::expressions::Table& table) {
    if (!table.empty()) line(wrapped(fmt::format("{}.{} = {};", of_, member, text(table)), "      "));
  }
  void line(const std::string& line) { lines_ += "  " + line + "\n"; }
  std::string done() {
    if (!lines_.empty()) lines_.pop_back();
    return std::move(lines_);
  }

 private:
  template <class Entry>
  static std::string in_lines(const Entry& entry) {
    if constexpr (std::is_same_v<Entry, eom::expressions::Table> || std::is_same_v<Entry, eom::hybrid::Signal>)
      return wrapped(text(entry), "      ");  // contains no names
    else
      return text(entry);
  }

  std::string of_, lines_;
};

/// Whether runs call this function.
bool is_of_runs(const std::string& function) {
  const auto of = [](const auto& code, const auto& member) { return member(code); };
#define ABI_FUNCTION(name, takes, gives, comes, purpose)  \
  if (function == #name)                                  \
    return of(eom::hybrid::Code{}, [](const auto& code) { \
      return requires { code.name; };                     \
    });
#include "abi/functions.inc"
#undef ABI_FUNCTION
  return false;
}

std::string code_text(const program::Program& program, const eom::hybrid::Code& code, const std::string& name) {
  Statements s("code");
  const auto bind = [&](const std::string& function) { s.line(fmt::format("code.{0} = {1}_{0};", function, name)); };
  for (const program::Function& f : program.functions) {
    if (is_of_runs(f.name) && (f.name != "rhs_open" || program.open_saves_work())) bind(f.name);
  }
  if (program.taylor) bind("taylor");
  if (!program.charts.empty()) {
    bind("chart");
    for (const program::Function& f : program.functions) {
      if (abi::find(f.name + "_in") != nullptr) bind(f.name + "_in");
    }
  }
  if (code.prepared > 0) s.set("prepared", code.prepared);
  s.list("output_names", code.output_names);
  s.list("free", code.free);
  if (code.first_order > 0) s.set("first_order", code.first_order);
  if (code.discrete > 0) s.set("discrete", code.discrete);
  if (code.reset_values > 0) s.set("reset_values", code.reset_values);
  if (code.active_constraints > 0) s.set("active_constraints", code.active_constraints);
  s.list("holonomic", code.holonomic);
  s.list("kinks", code.kinks);
  s.list("contacts", code.contacts);
  if (!code.contact_set.empty()) {
    s.line("using eom::contacts::none;");
    s.list("contact_set.contacts", code.contact_set.contacts);
    s.set("contact_set.values", code.contact_set.values);
    s.set("contact_set.law", code.contact_set.law);
    s.set("contact_set.order", code.contact_set.order);
  }
  if (program.taylor) s.set("taylor_order", code.taylor_order);
  s.list("own_outputs", code.own_outputs);
  return s.done();
}

/// The equations hold beyond the ranges of these coordinates.
std::string beyond_text(const std::vector<std::uint32_t>& coordinates) {
  std::string any;
  for (const std::uint32_t i : coordinates) any += fmt::format("{}i == {}", any.empty() ? "" : " || ", i);
  return fmt::format("problem.beyond_range = [](std::uint32_t i, double, std::span<const double>) {{ return {}; }};",
                     any);
}

std::string problem_text(const RunDescription& run) {
  const Problem& p = *run.problem;
  Statements s("problem");
  s.set("t0", p.t0);
  s.set("t1", p.t1);
  s.list("inputs", p.inputs);
  s.set("solver", p.solver);
  s.set("rtol", p.rtol);
  s.set("atol", p.atol);
  if (p.fixed_step > 0) s.set("fixed_step", p.fixed_step);
  if (p.row_subdivisions > 1) s.set("row_subdivisions", p.row_subdivisions);
  s.set("kinetic", p.kinetic);
  s.set("potential", p.potential);
  s.set("energy", p.energy);
  if (p.power) s.set("power", *p.power);
  s.list("redundant", p.redundant);
  s.list("invariants", p.invariants);
  s.list("integrals", p.integrals);
  s.list("contacts", p.contacts);
  s.list("starts_open", p.starts_open);
  s.list("events", p.events);
  s.list("samples", p.samples);
  s.list("time.surfaces", p.time.surfaces);
  s.list("time.terms", p.time.terms);
  s.list("jumps.functions", p.jumps.functions);
  s.table("jumps.values", p.jumps.values);
  s.table("jumps.mass", p.jumps.mass);
  s.list("bounded.events", p.bounded.events);
  s.list("bounded.narrow", p.bounded.narrow);
  s.list("charts", p.charts);
  if (!p.charts.empty()) s.line("problem.in_charts = [&code](unsigned) -> const eom::hybrid::Code& { return code; };");
  s.list("ranges", p.ranges);
  if (!run.beyond_range.empty()) s.line(beyond_text(run.beyond_range));
  s.list("state_names", p.state_names);
  s.list("constraint_names", p.constraint_names);
  s.set("output_interval", p.output_interval);
  return s.done();
}

/// Using-declarations for names in expressions.
std::string used_names(const Problem& p) {
  std::string result;
  const bool signals = std::any_of(p.inputs.begin(), p.inputs.end(),
                                   [](const eom::hybrid::Signal& signal) { return !signal.expression.empty(); });
  const bool samples = std::any_of(p.samples.begin(), p.samples.end(),
                                   [](const eom::hybrid::Sample& sample) { return !sample.times.empty(); });
  if (signals || samples || !p.time.empty() || !p.bounded.events.empty() || !p.bounded.narrow.empty() ||
      !p.jumps.functions.empty())
    result += "  using eom::expressions::Op;\n";
  if (!p.jumps.functions.empty()) result += "  using Quantity = eom::hybrid::JumpFunctions::Quantity;\n";
  return result;
}

std::string rows_text(const RunDescription& run) {
  if (!(run.rows > 0)) return "";
  return fmt::format("  problem.output_interval = problem.t1 > problem.t0 ? (problem.t1 - problem.t0) / {} : 1;\n",
                     run.rows);
}

}  // namespace

std::vector<EmittedFile> emit_run_header(const program::Program& program, const EmissionContext& context) {
  if (!context.run) return {};
  const Problem& problem = *context.run->problem;
  const std::string name = mangled_id(context.id);
  const bool infinite = std::any_of(problem.ranges.begin(), problem.ranges.end(), [](const eom::hybrid::Range& r) {
    return std::isinf(r.lower) || std::isinf(r.upper);
  });
  return {
      {name + "_run.hpp",
       render_template(
           skeleton::cpp_run_hpp,
           {{"name", name},
            {"banner", banner(program, context, "// ", "// ", "")},
            {"code", code_text(program, *problem.code, name)},
            {"infinity", infinite ? "  constexpr double infinity = std::numeric_limits<double>::infinity();\n" : ""},
            {"parameters", fmt::format("{}", problem.parameters.size())},
            {"problem", problem_text(*context.run)},
            {"names", used_names(problem)},
            {"rows", rows_text(*context.run)},
            {"start", context.start_functions ? render_template(skeleton::cpp_set_start, {{"name", name}}, {}) : ""},
            {"columns", wrapped(fmt::format("  return {};", text(context.run->columns)), "      ")}},
           {})}};
}

}  // namespace eomgen::emit
