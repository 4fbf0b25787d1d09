// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/value_names.hpp"

#include <fmt/format.h>

#include <eom/layout.hpp>

namespace eomgen::emit {

std::string suggested_name(const std::string& pattern, const ModelNames& names) {
  std::string result;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const std::size_t close = pattern[i] == '{' ? pattern.find('}', i) : std::string::npos;
    if (close == std::string::npos) {
      result += pattern[i];
    } else {
      result += names.all_coordinates.at(std::stoul(pattern.substr(i + 1, close - i - 1)));
      i = close;
    }
  }
  return result;
}

std::string trig_name(const program::Function& function, const program::Instruction& instruction,
                      const Expressions& expressions) {
  const std::string head = instruction.op == Op::sin ? "sin_" : "cos_";
  const Operand& argument = instruction.operands[0];
  if (argument.negated) return "";
  if (argument.slot != Slot::value)
    return argument.slot == Slot::constant ? "" : head + expressions.unsigned_value(argument).text;
  const Instruction& inner = function.code[argument.index];
  const auto& o = inner.operands;
  if (inner.op != Op::add || o.size() != 2 || o[0].negated) return "";
  for (const Operand& operand : o) {
    if (operand.slot != Slot::state && operand.slot != Slot::parameter) return "";
  }
  return head + expressions.unsigned_value(o[0]).text + (o[1].negated ? "_minus_" : "_plus_") +
         expressions.unsigned_value(o[1]).text;
}

namespace {

/// "d/d q": the column of a Jacobian matrix by states, parameters (`_p`) or inputs (`_u`).
std::string column_name(const std::string& function, const ModelNames& names, std::size_t column) {
  const std::vector<std::string>& all = function.ends_with("_p")   ? names.parameters
                                        : function.ends_with("_u") ? names.inputs
                                                                   : names.state;
  return fmt::format("d/d {}", all[column]);
}

}  // namespace

std::string result_entry_name(const program::Function& function, const ModelNames& names, std::size_t result,
                              std::size_t entry) {
  const std::size_t n = names.acceleration.size(), all = names.state.size();
  if ((function.name == "rhs" || function.name == "rhs_open") && eom::StateLayout{n}.is_rate(entry))
    return names.acceleration[entry - n];
  if (function.name == "jac" && result == 0 && entry % all == 0) return fmt::format("d/d {}", names.state[entry / all]);
  if (function.name == "jac_p" && entry % all == 0) return fmt::format("d/d {}", names.parameters[entry / all]);
  if (function.name == "jac_u" && entry % all == 0) return fmt::format("d/d {}", names.inputs[entry / all]);
  if (!names.outputs.empty() && function.name.starts_with("outputs_jac") && result == 0 &&
      entry % names.outputs.size() == 0)
    return column_name(function.name, names, entry / names.outputs.size());
  if (!names.reactions.empty() && function.name.starts_with("reactions_jac") && result == 0 &&
      entry % names.reactions.size() == 0)
    return column_name(function.name, names, entry / names.reactions.size());
  if (function.name == "regressor" && (result > 0 || entry % n == 0))
    return names.inertial[result > 0 ? entry : entry / n];
  if (function.name == "frames" && result == 0 && entry % 12 == 0) return names.frames[entry / 12];
  if (function.name == "outputs") return names.outputs[entry];
  if (function.name == "reactions") return names.reactions[entry];
  return function.name == "events" ? names.events[entry] : "";
}

}  // namespace eomgen::emit
