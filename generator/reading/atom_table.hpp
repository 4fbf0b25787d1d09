// SPDX-License-Identifier: GPL-3.0-or-later
// The symbols of one model as atoms, with their known signs.
#pragma once

#include <map>

#include "mechanics/mechanics.hpp"
#include "reading/sum.hpp"

namespace eomgen::reading {

/// In: a Model (positive parameters, ranges of coordinates). Out: one atom per symbol.
class AtomTable {
 public:
  explicit AtomTable(const model::Model& model) : model_(&model) {}
  const AtomPtr& atom(const Symbol& symbol);
  Sum operator()(const Symbol& symbol) { return Sum(atom(symbol)); }

 private:
  const model::Model* model_;
  std::map<Symbol, AtomPtr> atoms_;
};

/// pi as a sum.
Sum pi();

/// A sum as a Dag node, built in the canonical order.
symbolic::Ref to_dag(symbolic::Dag& dag, const Sum& sum);

}  // namespace eomgen::reading
