// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms from books: symbols of a model by name, combined with + - * and sin, cos.
#pragma once

#include <string>

#include "mechanics/mechanics.hpp"
#include "reading/atom_table.hpp"
#include "reading/reading.hpp"
#include "reading/zero_test.hpp"

namespace eomgen::test {

using reading::Sum;

class ByName {
 public:
  explicit ByName(const mechanics::Mechanics& m) : m_(m), alphabet_(*m.model) {}

  Sum operator()(const std::string& name);
  Sum multiplier(std::uint32_t constraint) { return alphabet_({symbolic::SymbolKind::multiplier, constraint, 0}); }

 private:
  const mechanics::Mechanics& m_;
  reading::AtomTable alphabet_;
};

Sum sin(const Sum& x);
Sum cos(const Sum& x);
Sum sqrt(const Sum& x);
Sum square(const Sum& x);
Sum half(const Sum& x);
Sum over(const Sum& a, const Sum& b);
/// Equal for all values of the symbols, by proof.
bool same(const Sum& a, const Sum& b);

std::string shipped(const std::string& name);

/// A model that outlives its mechanics.
struct System {
  explicit System(const model::Model& read);
  model::Model model;
  mechanics::Mechanics mechanics;
  ByName symbol;
};

}  // namespace eomgen::test
