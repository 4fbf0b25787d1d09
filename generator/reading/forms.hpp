// SPDX-License-Identifier: GPL-3.0-or-later
// The reading forms of one model. In: Mechanics. Out: each form, derived when it is first asked for and kept; what was
// too long once is not tried again by a form that begins with the same calculation.
#pragma once

#include <map>
#include <utility>

#include "reading/linear_form.hpp"
#include "reading/reading.hpp"
#include "reading/routh.hpp"

namespace eomgen::reading {

/// What is wanted of a form: its equations, with constraints as far as they fix coordinates; or all that is shown.
enum class Extent { equations, whole };

/// As derive_reading of reading.hpp, which gives the whole.
ReadingForm derive_reading(const mechanics::Mechanics& mechanics, system::Approach approach, Extent extent);
/// `two`: the form by approach II, whose Lagrangian is taken; what is too long there is here.
RouthForm routh_form(const mechanics::Mechanics& mechanics, const std::vector<std::uint32_t>& cyclic,
                     const ReadingForm& two);
LinearForm linear_form(const mechanics::Mechanics& mechanics, const ReadingForm& two);

class Forms {
 public:
  /// `mechanics` has to outlive it, and to stay what it is.
  explicit Forms(const mechanics::Mechanics& mechanics);

  const ReadingForm& operator()(system::Approach approach, Extent extent = Extent::whole);
  RouthForm routh(const std::vector<std::uint32_t>& cyclic);
  LinearForm linear();

 private:
  const mechanics::Mechanics& m_;
  bool nothing_imposed_;  // both approaches are the same equations
  std::map<std::pair<system::Approach, Extent>, ReadingForm> known_;
};

}  // namespace eomgen::reading
