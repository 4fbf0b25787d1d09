// SPDX-License-Identifier: GPL-3.0-or-later
// The function `start` in Rust: the same steps as templates/kernels/start in C.
#include "emit/start/start.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "emit/metadata.hpp"
#include "emit/rust/rust.hpp"
#include "emit/text.hpp"
#include "skeletons/rust_start_constraints_rs.hpp"
#include "skeletons/rust_start_rs.hpp"

namespace eomgen::emit {
namespace {

struct RustTable {
  const char* name;
  const std::vector<int>* entries;
};

struct RustField {
  const char* name;
  const char* type;  // of an entry
  std::size_t size;
};

std::string rust_tables(const StartDescription& start) {
  std::vector<RustTable> list{{"DEPENDENT", &start.dependent}, {"STATED", &start.stated},
                              {"INITIAL", &start.initial},     {"EARLY", &start.early},
                              {"LATE", &start.late},           {"FIRST_ORDER", &start.first_order},
                              {"FIXED", &start.fixed},         {"INSIDE", &start.inside}};
  if (start.row_count() > 0) {
    list.insert(list.end(), {{"GUESS", &start.guess},
                             {"MOVABLE", &start.movable},
                             {"ANGLE", &start.angle},
                             {"UNIT", &start.unit},
                             {"QUADRUPLE", &start.quadruple},
                             {"TAKEN", &start.taken},
                             {"TARGET", &start.target},
                             {"ROLLS", &start.rolls},
                             {"CONTACT_ROWS", &start.contacts}});
  }
  std::string text;
  for (const RustTable& table : list)
    text += wrapped(fmt::format("  static {}: [i32; {}] = [{}];", table.name, table.entries->size(),
                                fmt::join(*table.entries, ", ")),
                    "    ") +
            "\n";
  return text;
}

std::vector<RustField> rust_fields(const StartDescription& start, const EmissionContext& context,
                                   const program::Program& program) {
  const std::size_t states = program.state_count(), n = program.free.size(), rows = start.row_count(),
                    rank = std::min(rows, n);
  const auto entries = [](const program::Function& function, std::size_t result) {
    return function.results[result].entries.size();
  };
  std::vector<RustField> list{{"t", "Real", 2},
                              {"x", "Real", states},
                              {"p", "Real", context.parameters.size()},
                              {"v", "Real", entries(start.values, 0)},
                              {"given", "bool", states},
                              {"open", "bool", start.contacts.size()}};
  if (rows == 0) return list;
  list.insert(list.end(), {{"A", "Real", entries(start.rows, 0)},
                           {"psi", "Real", entries(start.rows, 1)},
                           {"b", "Real", entries(start.rows, 2)},
                           {"residual", "Real", rows},
                           {"right", "Real", rows},
                           {"B", "Real", rows * n},
                           {"Z", "Real", rank * n},
                           {"L", "Real", rank * rows},
                           {"U", "Real", rank * rows},
                           {"y", "Real", std::max(rows, n)},
                           {"step", "Real", n},
                           {"from", "Real", n},
                           {"begin", "Real", n},
                           {"moving", "usize", n},
                           {"unknown", "bool", n},
                           {"chosen", "bool", n},
                           {"held", "bool", 4 * n},
                           {"taken", "bool", 2 * rows}});
  return list;
}

}  // namespace

std::string rust_start(const program::Program& program, const EmissionContext& context) {
  const StartDescription& start = *context.start_functions;
  const bool single = context.single_error.has_value();
  std::vector<std::pair<std::string, std::string>> values = start_numbers(start, context, program, single, "");
  std::string fields, zeros;
  for (const RustField& field : rust_fields(start, context, program)) {
    const std::string type = field.type;
    fields += fmt::format("    {}: [{}; {}],\n", field.name, type, field.size);
    zeros += fmt::format("      {}: [{}; {}],\n", field.name,
                         type == "Real"   ? "0.0"
                         : type == "bool" ? "false"
                                          : "0",
                         field.size);
  }
  // The start of the motion: behind a kink in time at t0, by rounding.
  const std::string behind = start.has_time_kinks ? fmt::format("s.t[0] + {}*(abs(s.t[0]) + abs(s.t[1] - s.t[0]))",
                                                                single ? "2.4e-7" : "4.5e-16")
                                                  : "s.t[0]";
  for (auto& [name, value] : values) {
    if (name == "hold_held" || name == "hold_loose") value = value == "0" ? "false" : "true";
  }
  values.emplace_back("behind", behind);
  const std::string constraints =
      start.row_count() > 0 ? render_template(skeleton::rust_start_constraints_rs, values, {}) : "";
  values.insert(values.end(),
                {{"purpose", start_purpose},
                 {"tables", rust_tables(start)},
                 {"fields", fields},
                 {"zeros", zeros},
                 {"values_behind",
                  start.has_time_kinks
                      ? fmt::format("    if start_values({}, &s.x, &s.p, &mut s.v) != 0 {{ return 5; }}\n", behind)
                      : ""},
                 {"meet", start.row_count() > 0 ? "    let code = meet(s);\n    if code != 0 { return code; }\n" : ""},
                 {"constraints", constraints}});
  return render_template(skeleton::rust_start_rs, values, {});
}

}  // namespace eomgen::emit
