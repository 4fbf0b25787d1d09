// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

void add_gravitation(const model::Force& force, VirtualWork& w) {
  const std::vector<Mass> all = list_masses(w.model);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const Jet strength =
          w.now.scalar(argument_expression(force, "G")) * w.now.scalar(all[i].mass) * w.now.scalar(all[k].mass);
      w.apply_attraction(strength, w.now.place(all[i].place) - w.now.place(all[k].place),
                         w.by_q.place(all[i].place) - w.by_q.place(all[k].place));
    }
}

void gravitation_potential(const model::Force& force, Potentials& U) {
  const std::vector<Mass> all = list_masses(U.model);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = i + 1; k < all.size(); ++k) {
      const Jet R = norm(U.at.place(all[i].place) - U.at.place(all[k].place), U.precision);
      U.add(-(U.at.scalar(argument_expression(force, "G")) * U.at.scalar(all[i].mass) * U.at.scalar(all[k].mass)) / R);
    }
}

}  // namespace

ForceLaw gravitation() { return {add_gravitation, gravitation_potential}; }

}  // namespace eomgen::verify::forces
