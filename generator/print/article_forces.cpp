// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint forces, and the contact laws.
#include <algorithm>

#include "print/article_parts.hpp"

namespace eomgen::print {

void write_constraint_forces(Article& a) {
  std::vector<Statement> all;
  add_reactions(a.one, all);
  add_constraint_forces(a.m, a.one, all);
  if (all.empty()) return;
  a.out.section("Constraint forces");
  a.out.display(a.formulas(all));
}

void write_contacts(Article& a) {
  std::vector<Statement> all;
  add_contacts(a.m, all);
  if (all.empty()) return;
  const bool has_friction =
      std::any_of(a.m.contacts.begin(), a.m.contacts.end(), [](const auto& c) { return c.dimensions() > 0; });
  const bool opens = std::any_of(a.m.contacts.begin(), a.m.contacts.end(), [](const auto& c) { return c.unilateral; });
  a.out.section(has_friction && opens ? "Contacts and friction"
                : has_friction        ? "Friction"
                                      : "Contacts that can be left");
  std::string name;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Statement& s = all[i];
    if (!s.left_out.empty()) {
      a.left_out.push_back({s.name + ", " + s.role, s.left_out});
      continue;
    }
    if (s.name != name) {
      if (!name.empty()) a.out.raw("\\end{longtable}\n");
      a.out.paragraph("\\textbf{" + escape_user_text(s.name) + "}:");
      a.out.raw("\\begin{longtable}{@{}p{0.18\\linewidth}p{0.76\\linewidth}@{}}\n");
      name = s.name;
    }
    const bool again = i > 0 && all[i - 1].name == s.name && all[i - 1].role == s.role;
    a.out.raw((again ? "" : escape_user_text(s.role)) + " & " + a.out.table_cell(s.formula, 58) + " \\\\[4pt]\n");
  }
  if (!name.empty()) a.out.raw("\\end{longtable}\n");
}

}  // namespace eomgen::print
