// SPDX-License-Identifier: GPL-3.0-or-later
// M dq'' + C dq' + K dq = B du, entry by entry; zeros are omitted.
#include <algorithm>

#include "print/formulas.hpp"
#include "print/named_lengths.hpp"
#include "print/render.hpp"
#include "reading/linear_form.hpp"

namespace eomgen::print {
namespace {

using reading::LinearForm;

class Entries {
 public:
  Entries(const LinearForm& form, std::vector<Statement>& out) : f_(form), out_(out) {}

  void show(const reading::LinearCoefficients& slopes, const std::string& where) {
    matrix("M", slopes.mass, false, where);
    matrix("C", slopes.damping, false, where);
    matrix("K", slopes.stiffness, false, where);
    matrix("B", slopes.input, true, where);
  }

 private:
  Formula coordinate(std::size_t i) const { return reading::symbol({SymbolKind::coordinate, f_.coordinates[i], 0}); }
  Formula column(std::size_t j, bool input) const {
    return input ? reading::symbol({SymbolKind::input, f_.inputs[j], 0}) : coordinate(j);
  }

  void matrix(const char* letter, const std::vector<Sum>& entries, bool input, const std::string& where) {
    const std::size_t n = f_.coordinates.size(), columns = input ? f_.inputs.size() : n;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < columns; ++j) {
        const Sum& entry = entries[i * columns + j];
        if (entry.is_zero()) continue;
        out_.push_back({"linear", "", "", where + ": " + letter,
                        reading::relation({mark(letter, {coordinate(i), column(j, input)}), arrange(entry)})});
      }
    }
  }

  const LinearForm& f_;
  std::vector<Statement>& out_;
};

}  // namespace

std::vector<PrintedFormula> render_linear(const mechanics::Mechanics& m, const LinearForm& form,
                                          LengthLetters* letters) {
  std::vector<Statement> out;
  if (!form.skip_reason.empty()) {
    out.push_back(left_out("linear", "", "", form.skip_reason));
    return render(m, out);
  }
  Entries entries(form, out);
  entries.show(form.along_motion, "along a motion");
  const std::vector<reading::PowerOfSum> powers = reading::powers_of_sums(m);
  for (std::size_t i = 0; i < form.rest_residuals.size(); ++i) {
    if (form.rest_residuals[i].is_zero()) continue;  // every configuration is an equilibrium
    const auto& terms = form.rest_residuals[i].terms();
    const bool all_are_subtracted =
        std::all_of(terms.begin(), terms.end(), [](const auto& term) { return cln::minusp(term.second); });
    out.push_back(
        {"linear", "", m.model->coordinates[form.coordinates[i]].name, "at rest where",
         reading::relation(
             {arrange(with_brackets(all_are_subtracted ? -form.rest_residuals[i] : form.rest_residuals[i], powers)),
              reading::number(0)})});
  }
  entries.show(form.at_rest, "at rest");
  name_lengths(m, out, letters);
  return render(m, out);
}

std::vector<PrintedFormula> render_linear(const mechanics::Mechanics& m, const reading::LinearEquations& form,
                                          const std::string& where) {
  std::vector<Statement> out;
  const std::string role = "about '" + where + "', deviations by the letters of their coordinates";
  if (!form.skip_reason.empty()) {
    out.push_back(left_out("linear", "", "", form.skip_reason));
    return render(m, out);
  }
  for (const auto& [q, value] : form.equilibrium) {
    out.push_back({"linear", "", m.model->coordinates[q].name, "equilibrium '" + where + "'",
                   reading::relation({print::coordinate(q, 0), arrange(value)})});
  }
  for (std::size_t i = 0; i < form.coordinates.size(); ++i) {
    out.push_back(
        {"linear", "", m.model->coordinates[form.coordinates[i]].name, role,
         reading::relation({reading::arrange_by_factors(form.left[i]), reading::arrange_by_factors(form.right[i])})});
  }
  return render(m, out);
}

}  // namespace eomgen::print
