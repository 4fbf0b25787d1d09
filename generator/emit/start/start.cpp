// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/start/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <eom/modes/contact_state.hpp>

#include "emit/metadata.hpp"
#include "emit/text.hpp"
#include "skeletons/kernels_start.hpp"
#include "skeletons/kernels_start_constraints.hpp"

namespace eomgen::emit {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

struct Table {
  const char* name;
  const std::vector<int>* entries;
};

struct StartArray {
  const char* name;
  std::size_t size;
  bool whole = false;  // of integers
};

class Text {
 public:
  Text(const StartDescription& start, const EmissionContext& context, const program::Program& program,
       const StartLanguage& language)
      : start_(start),
        context_(context),
        program_(program),
        states_(program.state_count()),
        n_(program.free.size()),
        language_(language),
        prefix_(language.prefix + "start_") {}

  std::string operator()() const {
    Values values = syntax();
    const Values numbers = start_numbers(start_, context_, program_, language_.single, language_.is_c ? "f" : "");
    values.insert(values.end(), numbers.begin(), numbers.end());
    std::string constraints = tables();
    if (has_rows()) constraints += render_template(skeleton::kernels_start_constraints, values, {});
    values.emplace_back("constraints", structure() + constraints);
    values.emplace_back(
        "meet", has_rows() ? fmt::format("  code = {}meet({});\n  if (code) return code;\n", prefix_, "s") : "");
    return render_template(skeleton::kernels_start, values, {});
  }

 private:
  bool has_rows() const { return start_.row_count() > 0; }

  Values syntax() const {
    const bool c = language_.is_c;
    const std::string real = language_.single ? "float" : "double";
    const std::string work = fmt::format("struct {}work", prefix_);
    return {{"p", prefix_},
            {"s", c ? "s->" : "s."},
            {"w", c ? work + "* s" : "s"},
            {"w_name", "s"},
            {"int", c ? "int " : "let "},
            {"real", c ? real + " " : "let "},
            {"const_int", c ? "const int " : "const "},
            {"const_real", c ? "const " + real + " " : "const "},
            {"arg_int", c ? "int " : ""},
            {"def_int", c ? "static int " : "function "},
            {"def_real", c ? "static " + real + " " : "function "},
            {"def_void", c ? "static void " : "function "},
            {"abs", c ? "fabs" : "abs"},
            {"head", c ? start_head(language_.prefix, real) : "function start(given, t, x, p, mode)"},
            {"work", c ? fmt::format("  {} work, *s = &work;", work) : "  const s = start_work();"},
            {"defaults", language_.prefix + "defaults"},
            {"behind", behind()},
            {"values_behind", values_behind()},
            {"purpose", start_purpose}};
  }

  std::string field(const char* name) const { return (language_.is_c ? "s->" : "s.") + std::string(name); }

  /// The start of the motion: behind a kink in time at t0, by rounding.
  std::string behind() const {
    const std::string t0 = field("t[0]"), t1 = field("t[1]"), abs = language_.is_c ? "fabs" : "abs";
    if (!start_.has_time_kinks) return t0;
    const std::string part = number(language_.single ? 2.4e-7 : 4.5e-16);
    return fmt::format("{0} + {1}*({2}({0}) + {2}({3} - {0}))", t0, part, abs, t1);
  }

  std::string values_behind() const {
    if (!start_.has_time_kinks) return "";
    return fmt::format("  if ({}values({}, {}, {}, {})) return 5;\n", prefix_, behind(), field("x"), field("p"),
                       field("v"));
  }

  std::string number(double value) const { return decimal(value) + (language_.single && language_.is_c ? "f" : ""); }

  std::string tables() const {
    std::vector<Table> list{{"dependent", &start_.dependent}, {"stated", &start_.stated},
                            {"initial", &start_.initial},     {"early", &start_.early},
                            {"late", &start_.late},           {"first_order", &start_.first_order},
                            {"fixed", &start_.fixed},         {"inside", &start_.inside}};
    if (has_rows()) {
      list.insert(list.end(), {{"guess", &start_.guess},
                               {"movable", &start_.movable},
                               {"angle", &start_.angle},
                               {"unit", &start_.unit},
                               {"quadruple", &start_.quadruple},
                               {"taken", &start_.taken},
                               {"target", &start_.target},
                               {"rolls", &start_.rolls},
                               {"contacts", &start_.contacts}});
    }
    std::string text;
    for (const Table& table : list) {
      std::string entries;
      for (const int entry : *table.entries) entries += fmt::format("{}{}", entries.empty() ? "" : ", ", entry);
      if (entries.empty()) entries = "0";
      text += wrapped(language_.is_c ? fmt::format("static const int {}{}[] = {{{}}};", prefix_, table.name, entries)
                                     : fmt::format("const {}{} = [{}];", prefix_, table.name, entries),
                      "    ") +
              "\n";
    }
    return text + "\n";
  }

  std::vector<StartArray> arrays() const {
    const std::size_t rows = start_.row_count(), rank = std::min(rows, n_);
    std::vector<StartArray> list{{"t", 2},
                                 {"x", states_},
                                 {"p", context_.parameters.size()},
                                 {"v", start_.values.results[0].entries.size()},
                                 {"given", states_, true},
                                 {"open", start_.contacts.size(), true}};
    if (!has_rows()) return list;
    list.insert(list.end(), {{"A", rows * n_},
                             {"psi", start_.rows.results[1].entries.size()},
                             {"b", rows},
                             {"residual", rows},
                             {"right", rows},
                             {"B", rows * n_},
                             {"Z", rank * n_},
                             {"L", rank * rows},
                             {"U", rank * rows},
                             {"y", std::max(rows, n_)},
                             {"move", n_},
                             {"from", n_},
                             {"begin", n_},
                             {"moving", n_, true},
                             {"unknown", n_, true},
                             {"chosen", n_, true},
                             {"held", 4 * n_, true},
                             {"taken", 2 * rows, true}});
    return list;
  }

  std::string structure() const {
    std::string text;
    for (const StartArray& array : arrays()) {
      const std::size_t size = std::max<std::size_t>(1, array.size);
      text += language_.is_c ? fmt::format("  {} {}[{}];\n",
                                           array.whole        ? "int"
                                           : language_.single ? "float"
                                                              : "double",
                                           array.name, size)
                             : fmt::format("  {}: new {}({}),\n", array.name,
                                           array.whole        ? "Int32Array"
                                           : language_.single ? "Float32Array"
                                                              : "Float64Array",
                                           size);
    }
    return language_.is_c ? fmt::format("struct {}work {{\n{}}};\n", prefix_, text)
                          : fmt::format("const {}work = () => ({{\n{}}});\n", prefix_, text);
  }

  const StartDescription& start_;
  const EmissionContext& context_;
  const program::Program& program_;
  std::size_t states_, n_;
  const StartLanguage& language_;
  std::string prefix_;
};

}  // namespace

const char* const start_purpose =
    "Completes x, p and t = {t0, t1} from the values that `given` names, in this order; null: the default scene.";

std::string start_head(const std::string& prefix, const std::string& real) {
  return wrapped(fmt::format("int {0}start(const int* given, {1}* t, {1}* x, {1}* p, int* mode)", prefix, real),
                 std::string(prefix.size() + 10, ' '));
}

std::vector<std::pair<std::string, std::string>> start_numbers(const StartDescription& start,
                                                               const EmissionContext& context,
                                                               const program::Program& program, bool single,
                                                               const std::string& suffix) {
  std::vector<std::pair<std::string, std::string>> values;
  const auto add = [&](const char* name, std::size_t value) { values.emplace_back(name, std::to_string(value)); };
  const auto add_real = [&](const char* name, double value) {
    values.emplace_back(name, decimal(value) + (single ? suffix : ""));
  };
  add("states", program.state_count());
  add("parameters", context.parameters.size());
  add("n", program.free.size());
  add("rows", start.row_count());
  add("rounds", start.dependent.size() / 2 + start.stated.size() / 2 + 3);
  add("dependent_count", start.dependent.size() / 2);
  add("stated_count", start.stated.size() / 2);
  add("initial_count", start.initial.size() / 3);
  add("early_count", start.early.size() / 2);
  add("late_count", start.late.size() / 2);
  add("first_order_count", start.first_order.size() / 2);
  add("fixed_count", start.fixed.size() / 2);
  add("inside_count", start.inside.size());
  add("contact_count", start.contacts.size());
  add("mode_size", program.mode_layout().size());
  add("open_state", static_cast<std::size_t>(eom::contact_states) / 2);
  add("hold_held", start.holds_angles ? 1 : 0);
  add("hold_loose", start.tries_angles ? 1 : 0);
  // Those of run/start.cpp, with the digits of the type.
  add_real("last_digit", single ? 2.2e-7 : 4e-16);
  add_real("rounding", single ? 5e-6 : 1e-14);
  add_real("tolerance", single ? 1e-4 : 1e-8);
  add_real("rank_tolerance", single ? 1e-4 : 1e-10);
  add_real("tenth", 0.1);
  return values;
}

std::vector<const program::Function*> StartDescription::functions() const {
  if (row_count() == 0) return {&values};
  return {&values, &rows};
}

std::string start_text(const StartDescription& start, const EmissionContext& context, const program::Program& program,
                       const StartLanguage& language) {
  return Text(start, context, program, language)();
}

std::string start_comparison(const EmissionContext& context, std::size_t states, const std::string& function,
                             const std::string& null_pointer, const std::string& real) {
  // The start of the scene was computed by other code: they agree to the tolerance of its constraints.
  const bool single = context.single_error.has_value();
  const std::string allowed = single ? "1e-3f" : "1e-7";
  const std::size_t count = std::max<std::size_t>(1, context.parameters.size());
  std::string text = fmt::format(
      "  {{\n    {0} t[2], x[{1}], p[{2}], x0[{1}], p0[{2}];\n    int i;\n    if ({3}start({4}, t, x, p, {4}) != 0) "
      "return 1;\n    {3}defaults(x0, p0);\n",
      real, states, count, function, null_pointer);
  text += fmt::format(
      "    for (i = 0; i < {}; ++i) {{\n      if (!(fabs(x[i] - x0[i]) <= {}*(1 + fabs(x0[i])))) return 1;\n    }}\n",
      states, allowed);
  if (!context.parameters.empty()) {
    text += fmt::format(
        "    for (i = 0; i < {}; ++i) {{\n      if (!(fabs(p[i] - p0[i]) <= {}*fabs(p0[i]) + {})) return 1;\n    }}\n",
        context.parameters.size(), allowed, allowed);
  }
  return text + "  }\n";
}

}  // namespace eomgen::emit
