// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/massless_coordinates.hpp"

#include <algorithm>
#include <functional>

namespace eomgen::run {

bool is_massless(const system::EquationSystem& s, std::size_t coordinate) {
  const std::size_t n = s.free.size();
  const auto row = s.M.begin() + static_cast<std::ptrdiff_t>(coordinate * n);
  return std::all_of(row, row + static_cast<std::ptrdiff_t>(n), [&](symbolic::Ref r) { return r == s.dag->zero(); });
}

MasslessJumps massless_jumps(const system::EquationSystem& s) {
  const std::size_t n = s.free.size(), m = n == 0 ? 0 : s.A.size() / n;
  const symbolic::Ref zero = s.dag->zero();
  MasslessJumps result{std::vector<bool>(m, false), std::vector<bool>(m, false)};
  std::vector<bool> is_contact(m, false);
  for (const system::Contact& contact : s.contacts)
    if (contact.unilateral) is_contact[*contact.unilateral] = true;
  bool all = true;
  std::vector<std::vector<std::size_t>> columns(m);      // of coordinates without inertia, per constraint
  std::vector<std::vector<std::size_t>> constraints(n);  // the reverse
  for (std::size_t c = 0; c < n; ++c) {
    if (!is_massless(s, c)) continue;
    for (std::size_t k = 0; k < m; ++k) {
      if (s.A[k * n + c] == zero) continue;
      if (is_contact[k]) {
        // The nearest point is where the gap has no slope: the rate of the gap does not jump.
        all = all && std::find(s.psi.begin(), s.psi.end(), s.A[k * n + c]) != s.psi.end();
        continue;
      }
      columns[k].push_back(c);
      constraints[c].push_back(k);
    }
  }
  // A matching: each constraint determines a coordinate of its own. Augmenting paths, as in Kuhn's algorithm.
  std::vector<std::size_t> owner(n, m);
  for (std::size_t k = 0; k < m; ++k) {
    if (columns[k].empty()) continue;
    std::vector<bool> seen(n, false);
    const std::function<bool(std::size_t)> match = [&](std::size_t constraint) {
      return std::any_of(columns[constraint].begin(), columns[constraint].end(), [&](std::size_t c) {
        if (seen[c]) return false;
        seen[c] = true;
        if (owner[c] != m && !match(owner[c])) return false;
        owner[c] = constraint;
        return true;
      });
    };
    all = match(k) && all;
  }
  for (std::size_t k = 0; k < m && all; ++k) {
    result.velocity[k] = !columns[k].empty();
    result.position[k] =
        std::any_of(columns[k].begin(), columns[k].end(), [&](std::size_t c) { return constraints[c].size() == 1; });
  }
  return result;
}

}  // namespace eomgen::run
