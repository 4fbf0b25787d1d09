// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/leaves.hpp"

#include <fmt/format.h>

#include <eom/modes/contact_state.hpp>
#include <stdexcept>

#include "program/internal_functions.hpp"
#include "program/kinks.hpp"

namespace eomgen::emit {
namespace {

using program::Slot;

/// The value of a leaf from the arguments of one state. Without `takes_inputs`, inputs have their defaults.
std::string leaf_value(const Dialect& dialect, const ModelNames& names, const EmissionContext& context, Slot slot,
                       std::uint32_t i, bool takes_inputs) {
  switch (slot) {
    case Slot::state: return dialect.rounded(fmt::format("{}[{}]", names.x, i));
    case Slot::parameter: return dialect.rounded(fmt::format("{}[{}]", names.p, i));
    case Slot::contact: {
      std::string digit = fmt::format("({} & {})", names.mode, eom::contact_bits);
      for (std::uint32_t j = 0; j < i / 2; ++j) digit += fmt::format("/{}", eom::contact_states);
      if (!dialect.is_typed) digit = fmt::format("({} | 0)", digit);  // JavaScript has no integer division
      const std::string one = dialect.constant(1);
      if (i % 2 == 1)
        return fmt::format("{0} % {1} < {2} ? {3} : -{3}", digit, eom::contact_states, eom::contact_states / 2, one);
      return fmt::format("{0} % 3 == 2 ? -{1} : {0} % 3 == 1 ? {1} : {2}", digit, one, dialect.constant(0));
    }
    case Slot::input: {
      const std::string standing = dialect.value(context.inputs.at(i).value);
      const std::string given = dialect.rounded(fmt::format("{}[{}]", names.u, i));
      return takes_inputs ? fmt::format("{} ? {} : {}", names.u, given, standing) : standing;
    }
    case Slot::side: {  // two bits per kink: frozen above its surface, frozen below
      const std::size_t bit = program::first_kink_bit + 2 * i;
      const std::string side = fmt::format("(({0} >> {1} & 1) - ({0} >> {2} & 1))", names.mode, bit, bit + 1);
      if (!dialect.is_typed) return side;
      return dialect.using_std ? dialect.real + side : fmt::format("({}){}", dialect.real, side);
    }
    default: break;
  }
  throw std::logic_error("this operand is no leaf");
}

/// The value of a leaf from the lanes of `block`.
std::string leaf_of_lanes(const Dialect& dialect, const EmissionContext& context, const std::string& block, Slot slot,
                          std::uint32_t i, bool takes_inputs) {
  const auto entry = [&](int array) {
    return fmt::format("{}at({}, {}, {})", dialect.lane_prefix, block, array, i);
  };  // loads an entry of the arrays t, x, p, w, u
  switch (slot) {
    case Slot::time: return entry(0);
    case Slot::state: return entry(1);
    case Slot::parameter: return entry(2);
    case Slot::prepared: return entry(3);
    case Slot::input:
      return takes_inputs ? entry(4)
                          : fmt::format("{}all({})", dialect.lane_prefix, dialect.value(context.inputs.at(i).value));
    case Slot::contact: {
      int power = 1;
      for (std::uint32_t j = 0; j < i / 2; ++j) power *= eom::contact_states;
      return fmt::format("{}{}({}, {})", dialect.lane_prefix, i % 2 == 1 ? "presses" : "slides", block, power);
    }
    case Slot::side: return fmt::format("{}side({}, {})", dialect.lane_prefix, block, program::first_kink_bit + 2 * i);
    default: break;
  }
  throw std::logic_error("this operand is no leaf");
}

}  // namespace

std::vector<LeafLoads> leaf_loads(const std::string& function, const Leaves& leaves, const ModelNames& names,
                                  const EmissionContext& context, const Dialect& dialect, const std::string& block) {
  const bool lanes = !dialect.lane_prefix.empty(), inputs = program::takes_inputs(function);
  std::vector<LeafLoads> result;
  for (const Slot slot :
       {Slot::time, Slot::prepared, Slot::state, Slot::parameter, Slot::contact, Slot::input, Slot::side}) {
    if ((slot == Slot::time || slot == Slot::prepared) && !lanes) continue;
    LeafLoads of{slot, {}};
    for (const auto& [leaf_slot, i] : leaves) {
      if (leaf_slot != slot) continue;
      of.values.emplace_back(i, lanes ? leaf_of_lanes(dialect, context, block, slot, i, inputs)
                                      : leaf_value(dialect, names, context, slot, i, inputs));
    }
    if (!of.values.empty()) result.push_back(std::move(of));
  }
  return result;
}

}  // namespace eomgen::emit
