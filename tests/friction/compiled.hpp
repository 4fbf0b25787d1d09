// SPDX-License-Identifier: GPL-3.0-or-later
// A model with friction, derived and compiled to a program that is interpreted in binary64.
#pragma once

#include <string>
#include <vector>

#include "eom/modes/contacts.hpp"
#include "mechanics/mechanics.hpp"
#include "model/model.hpp"
#include "program/interpret.hpp"

namespace eomgen::test {

class RoughProgram {
 public:
  explicit RoughProgram(const std::string& text, const std::vector<double>& parameters = {});

  const program::Program& program() const { return program_; }
  std::size_t states() const { return 2 * program_.free.size(); }
  void parameters(std::vector<double> p) { p_ = std::move(p); }

  int rhs(double t, const double* x, int mode, double* dx) const;
  int contacts(double t, const double* x, int mode, double* g) const;
  std::vector<eom::Contact> contact_list() const;
  double output(const std::string& name, double t, const double* x, int mode) const;

 private:
  program::Arguments<double> arguments(double t, const double* x, int mode) const {
    std::vector<int> states_of_contacts;
    for (std::size_t j = 0; j < program_.contacts.size(); ++j)
      states_of_contacts.push_back(eom::contact_digit(mode, j));
    return {t, {x, x + states()}, p_, {}, {}, {}, states_of_contacts};
  }

  model::Model model_;
  mechanics::Mechanics mechanics_;
  program::Program program_;
  std::vector<std::string> outputs_;
  std::vector<double> p_;
};

}  // namespace eomgen::test
