// SPDX-License-Identifier: GPL-3.0-or-later
// The articulated route: particles on links that carry forces only along directions in which they do not let the
// particle move. The accelerations relative to the parent vanish along these directions,
//   N_k . (a_k - a_parent - c_k) = 0,   a_k = g + (F_k + N_k T_k + W_k - sum_children (N_c T_c + W_c)) / m_k,
// which gives the tensions T by a factorisation without fill; then theta_ddot_k = J_k . (a_k - a_parent - c_k) / J_k .
// J_k. The cost grows with the number of links, not with its cube. W_k = J_k f_k / J_k . J_k is what the forces on
// theta_k come to.
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

/// Trees (branches.hpp) with one particle of constant mass at the end of every link, no multipliers, and links whose
/// directions of force are known: as many coordinates as dimensions, or one fewer.
std::optional<system::EquationSystem> articulated(mechanics::Mechanics& mechanics, system::Approach approach);

}  // namespace eomgen::derive
