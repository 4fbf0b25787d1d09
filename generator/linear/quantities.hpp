// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions of the state that are prescribed or conserved, with their values and derivatives along a flow.
#pragma once

#include "linear/linearise.hpp"
#include "lists.hpp"

namespace eomgen::linear {

struct Quantity {
  std::string name;
  Ref expression;
};

/// Quantities with their prescribed values.
class HeldQuantities {
 public:
  HeldQuantities(const Flow& flow, std::vector<Quantity> quantities)
      : flow_(flow), quantities_(std::move(quantities)), tape_(flow.tape(expressions())) {}

  const std::vector<Quantity>& quantities() const { return quantities_; }
  std::vector<Precise> targets;

  template <class T>
  ValueAndJacobian<T> at(const State<T>& z, const Setting<T>& setting) const {
    return flow_.value_and_jacobian(tape_, z, setting);
  }

 private:
  std::vector<Ref> expressions() const { return mapped(quantities_, &Quantity::expression); }
  const Flow& flow_;
  std::vector<Quantity> quantities_;
  Tape tape_;
};

}  // namespace eomgen::linear
