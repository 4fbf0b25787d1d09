// SPDX-License-Identifier: GPL-3.0-or-later
// The display forms of one model. In: Mechanics. Out: each form, derived on first use and cached. A calculation that
// was too long once is not tried again by another form.
#pragma once

#include <map>
#include <utility>

#include "reading/linear_form.hpp"
#include "reading/reading.hpp"
#include "reading/routh.hpp"
#include "reading/solved_form.hpp"

namespace eomgen::reading {

/// The requested part of a form: its equations with constraints as far as they fix coordinates, or all that is
/// displayed.
enum class Extent { equations, whole };

/// Like derive_display_form of reading.hpp, which derives the whole form.
DisplayForm derive_display_form(const mechanics::Mechanics& mechanics, system::Approach approach, Extent extent);
/// `two`: the form by Approach II, which provides the Lagrangian. Parts that are too long there are too long here.
RouthForm routh_form(const mechanics::Mechanics& mechanics, const std::vector<std::uint32_t>& cyclic,
                     const DisplayForm& two);
LinearForm linear_form(const mechanics::Mechanics& mechanics, const DisplayForm& two);

class DisplayForms {
 public:
  /// `mechanics` must outlive the object and stay unchanged.
  explicit DisplayForms(const mechanics::Mechanics& mechanics);

  const DisplayForm& operator()(system::Approach approach, Extent extent = Extent::whole);
  RouthForm routh(const std::vector<std::uint32_t>& cyclic);
  LinearForm linear();
  SolvedForm solved(FrictionMode mode);

 private:
  const mechanics::Mechanics& m_;
  bool nothing_imposed_;  // both approaches are the same equations
  std::map<std::pair<system::Approach, Extent>, DisplayForm> known_;
};

}  // namespace eomgen::reading
