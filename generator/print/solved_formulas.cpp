// SPDX-License-Identifier: GPL-3.0-or-later
// The solved equations as formulas: accelerations, multipliers, constraint forces as vectors, friction that holds.

#include "print/formulas.hpp"
#include "print/named_lengths.hpp"
#include "print/render.hpp"

namespace eomgen::print {
namespace {

using reading::SolvedForm;

constexpr std::size_t most_terms = 60;  // of a formula that is read as one

class SolvedStatements {
 public:
  SolvedStatements(const Mechanics& m, const SolvedForm& form, std::vector<Statement>& out)
      : m_(m), form_(form), out_(out) {}

  void add() {
    const bool holds = form_.mode == reading::FrictionMode::holding;
    if (!holds) accelerations();
    for (std::uint32_t k = 0; k < form_.multipliers.size(); ++k) {
      if (form_.multipliers[k])
        show(m_.constraints[k].label, "", holds ? "multiplier where contacts hold" : "multiplier",
             reading::symbol({SymbolKind::multiplier, k, 0}), *form_.multipliers[k]);
    }
    for (std::uint32_t a = 0; a < form_.friction.size(); ++a) {
      if (form_.friction[a])
        show("", "", "friction that holds", reading::symbol({SymbolKind::friction, a, 0}), *form_.friction[a]);
    }
    add_constraint_forces(m_, form_, out_);
    for (const reading::ClosedForm& closed : form_.closed) {
      const std::string& name = m_.model->coordinates[closed.coordinate].name;
      show("", name, "closed form", coordinate(closed.coordinate, 0), closed.value);
    }
    if (form_.has_undetermined)
      out_.push_back(left_out("solved", "", holds ? "some forces where contacts hold" : "some forces",
                              "the motion does not determine them"));
  }

 private:
  void accelerations() {
    for (const reading::SolvedAcceleration& a : form_.accelerations) {
      const std::string& name = m_.model->coordinates[a.coordinate].name;
      show("", name, "acceleration", coordinate(a.coordinate, 2), a.value);
    }
  }

  void show(std::string name, std::string of, const char* role, Formula left, const Sum& expanded) {
    const Sum value = with_brackets(expanded, form_.powers);
    if (value.size() > most_terms) {
      Statement omitted =
          left_out("solved", std::move(name), role, "it has " + std::to_string(value.size()) + " terms");
      omitted.coordinate = std::move(of);
      out_.push_back(std::move(omitted));
      return;
    }
    out_.push_back({"solved", std::move(name), std::move(of), role,
                    reading::relation({std::move(left), reading::arrange(value, Layout::grouped)})});
  }

  const Mechanics& m_;
  const SolvedForm& form_;
  std::vector<Statement>& out_;
};

}  // namespace

std::vector<PrintedFormula> render_solved(const Mechanics& m, const SolvedForm& form, LengthLetters* letters) {
  std::vector<Statement> out;
  if (!form.skip_reason.empty())
    out.push_back(
        left_out("solved", "",
                 form.mode == reading::FrictionMode::holding ? "friction that holds" : "accelerations and multipliers",
                 form.skip_reason + "; eomgen run --output reaction.NAME gives their values"));
  else
    SolvedStatements(m, form, out).add();
  name_lengths(m, out, letters);
  return render(m, out);
}

}  // namespace eomgen::print
