// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/leaves.hpp"

#include <fmt/format.h>

#include <eom/modes/contact_state.hpp>
#include <stdexcept>

#include "program/internal_functions.hpp"

namespace eomgen::emit {
namespace {

/// An entry of `mode`, which may be null.
std::string mode_entry(const ModelNames& names, std::size_t entry) {
  return fmt::format("({0} ? {0}[{1}] : 0)", names.mode, entry);
}

/// The value of a leaf from the arguments of one state. Without `takes_inputs`, inputs have their defaults.
std::string leaf_value(const Dialect& dialect, const ModelNames& names, const EmissionContext& context, Slot slot,
                       std::uint32_t i, bool takes_inputs) {
  switch (slot) {
    case Slot::state: return dialect.rounded(fmt::format("{}[{}]", names.x, i));
    case Slot::parameter: return dialect.rounded(fmt::format("{}[{}]", names.p, i));
    case Slot::vector: return dialect.rounded(fmt::format("{}[{}]", names.v, i));
    case Slot::contact: {
      const std::string state = mode_entry(names, i / 2), one = dialect.constant(1);
      if (i % 2 == 1) return fmt::format("{0} < {1} ? {2} : -{2}", state, eom::contact_states / 2, one);
      return fmt::format("{0} % 3 == 2 ? -{1} : {0} % 3 == 1 ? {1} : {2}", state, one, dialect.constant(0));
    }
    case Slot::input: {
      const std::string standing = dialect.value(context.inputs.at(i).value);
      const std::string given = dialect.rounded(fmt::format("{}[{}]", names.u, i));
      return takes_inputs ? fmt::format("{} ? {} : {}", names.u, given, standing) : standing;
    }
    case Slot::side: {  // 1: frozen above the surface, -1: below it
      const std::string side = mode_entry(names, names.first_kink + i);
      if (!dialect.is_typed) return side;
      return dialect.using_std ? dialect.real + side : fmt::format("({}){}", dialect.real, side);
    }
    default: break;
  }
  throw std::logic_error("this operand is no leaf");
}

/// The value of a leaf from the lanes of `block`.
std::string leaf_of_lanes(const Dialect& dialect, const ModelNames& names, const EmissionContext& context,
                          const std::string& block, Slot slot, std::uint32_t i, bool takes_inputs) {
  const auto entry = [&](int array) {
    return fmt::format("{}at({}, {}, {})", dialect.lane_prefix, block, array, i);
  };  // loads an entry of the arrays t, x, p, w, u, v
  switch (slot) {
    case Slot::time: return entry(0);
    case Slot::state: return entry(1);
    case Slot::parameter: return entry(2);
    case Slot::prepared: return entry(3);
    case Slot::vector: return entry(5);
    case Slot::input:
      return takes_inputs ? entry(4)
                          : fmt::format("{}all({})", dialect.lane_prefix, dialect.value(context.inputs.at(i).value));
    case Slot::contact:
      return fmt::format("{}{}({}, {})", dialect.lane_prefix, i % 2 == 1 ? "normal_sign" : "slides", block, i / 2);
    case Slot::side: return fmt::format("{}side({}, {})", dialect.lane_prefix, block, names.first_kink + i);
    default: break;
  }
  throw std::logic_error("this operand is no leaf");
}

}  // namespace

std::vector<LeafLoads> leaf_loads(const std::string& function, const Leaves& leaves, const ModelNames& names,
                                  const EmissionContext& context, const Dialect& dialect, const std::string& block) {
  const bool lanes = !dialect.lane_prefix.empty(), inputs = program::takes_inputs(function);
  std::vector<LeafLoads> result;
  for (const Slot slot : {Slot::time, Slot::prepared, Slot::state, Slot::parameter, Slot::vector, Slot::contact,
                          Slot::input, Slot::side}) {
    if ((slot == Slot::time || slot == Slot::prepared) && !lanes) continue;
    LeafLoads of{slot, {}};
    for (const auto& [leaf_slot, i] : leaves) {
      if (leaf_slot != slot) continue;
      of.values.emplace_back(i, lanes ? leaf_of_lanes(dialect, names, context, block, slot, i, inputs)
                                      : leaf_value(dialect, names, context, slot, i, inputs));
    }
    if (!of.values.empty()) result.push_back(std::move(of));
  }
  return result;
}

}  // namespace eomgen::emit
