// SPDX-License-Identifier: GPL-3.0-or-later
// Description of the system: particles and bodies, parameters, inputs, forces.
#include <algorithm>
#include <array>

#include "print/article_parts.hpp"

namespace eomgen::print {

namespace {

constexpr std::size_t longest_position = 12;  // terms
constexpr std::size_t longest_value = 30;     // visible characters on a table line

std::string number_word(std::size_t n, const char* one, const char* many) {
  static constexpr std::array<const char*, 10> small{"no",   "one", "two",   "three", "four",
                                                     "five", "six", "seven", "eight", "nine"};
  return (n < small.size() ? small[n] : std::to_string(n)) + " " + (n == 1 ? one : many);
}

/// A value that the model gives in degrees, as written: 48.85 with the sign of degrees. Empty for other values.
std::string in_degrees(const model::Parameter& parameter) {
  constexpr std::string_view unit = " deg";
  const std::string& text = parameter.written;
  if (!text.ends_with(unit)) return "";
  const std::string number = text.substr(0, text.size() - unit.size());
  if (number.empty() || number.find_first_not_of("0123456789.-") != std::string::npos) return "";
  return "$" + number + "^{\\circ}$";
}

class System {
 public:
  explicit System(Article& a) : a_(a), m_(a.m), model_(a.model), out_(a.out) {}

  void write() {
    counts();
    figure();
    for (const mechanics::PointMass& mass : m_.masses) describe(mass);
    if (model_.energy.kinetic != model::no_node)
      out_.paragraph("The kinetic energy is given as an expression of coordinates and rates.");
    parameters();
    inputs();
    forces();
  }

 private:
  void counts() {
    const std::size_t bodies = model_.bodies.size(), particles = m_.masses.size() - bodies;
    std::vector<std::string> parts;
    if (particles > 0) parts.push_back(number_word(particles, "particle", "particles"));
    if (bodies > 0) parts.push_back(number_word(bodies, "rigid body", "rigid bodies"));
    std::size_t constraints = 0;
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) constraints += m_.is_independent(k) ? 1 : 0;
    const long freedom = m_.degrees_of_freedom();
    std::string text = parts.empty() ? "The system is described"
                                     : "The system consists of " + enumeration(parts) + ". It is described";
    text += " by " + number_word(model_.coordinates.size(), "coordinate", "coordinates") + " and subject to " +
            number_word(constraints, "constraint equation", "constraint equations");
    text += freedom > 0 ? ", which leaves " + number_word(static_cast<std::size_t>(freedom), "degree of freedom.",
                                                          "degrees of freedom.")
                        : ", which prescribes all of its motion.";
    out_.paragraph(text);
  }

  void figure() {
    if (a_.findings == nullptr || !a_.findings->figure) return;
    out_.use_package("graphicx");
    out_.raw(figure_in_latex(*a_.findings->figure, out_));
  }

  std::string value(model::NodeId node) const {
    const std::optional<Formula> written = node == model::no_node ? std::nullopt : reading::as_written(model_, node);
    return written ? out_.math(*written) : "";
  }

  std::string entries(const std::vector<model::NodeId>& list) const {
    std::vector<std::string> result;
    for (const model::NodeId entry : list) {
      const std::string written = value(entry);
      if (!written.empty()) result.push_back(written);
    }
    return enumeration(result);
  }

  void describe(const mechanics::PointMass& mass) {
    const auto body = std::find_if(model_.bodies.begin(), model_.bodies.end(),
                                   [&](const model::Body& b) { return b.place == mass.place; });
    const bool is_body = body != model_.bodies.end();
    const model::Place& place = model_.places[mass.place];
    std::string text = bold(mass.name) + (is_body ? ": a rigid body" : ": a particle");
    if (const auto m = read_short(mass.mass)) text += " of mass " + out_.math(reading::arrange(*m));
    if (place.chart) {
      std::vector<model::NodeId> slots(place.chart->entries.begin(), place.chart->entries.end());
      const std::string of = entries(slots),
                        from = place.from == 0 ? "" : " from " + bold(model_.places[place.from].name);
      if (!of.empty())
        text += (is_body ? ", its centre of mass in " : ", in ") +
                (place.chart->system == "cartesian" ? "Cartesian" : escape_user_text(place.chart->system)) +
                " coordinates " + of + from;
    }
    if (is_body) {
      const model::Frame& frame = model_.frames[body->frame];
      const std::string angles = entries(frame.entries);
      if (!angles.empty())
        text += "; its axes are turned by " + rotation(frame) + " " + angles +
                (frame.parent == 0 ? "" : " against those of " + bold(model_.frames[frame.parent].name));
      text += inertia(*body);
    }
    out_.paragraph(text + ".");
    position(mass);
  }

  std::string rotation(const model::Frame& frame) const {
    std::string name = frame.rotation;
    std::replace(name.begin(), name.end(), '_', ' ');
    const bool digits = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) return escape_user_text(name);
    std::string dashed;
    for (const char c : name) dashed += (dashed.empty() ? "" : "-") + std::string(1, c);
    return dashed + " Euler angles";
  }

  std::string inertia(const model::Body& body) const {
    std::vector<std::string> diagonal;
    std::vector<std::size_t> about;  // axes whose moment is not 0
    for (std::size_t i = 0; i < 3; ++i) {
      const bool none = body.inertia[i][i] == model::no_node || is_zero(body.inertia[i][i]);
      diagonal.push_back(none ? out_.math(reading::number(0)) : value(body.inertia[i][i]));
      if (!none) about.push_back(i);
      for (std::size_t k = 0; k < 3; ++k) {
        if (i != k && body.inertia[i][k] != model::no_node && !is_zero(body.inertia[i][k])) return "";
      }
      if (diagonal.back().empty()) return "";
    }
    if (about.empty()) return "";
    if (about.size() == 1) {
      // The model gives one moment for a body that rotates about a fixed axis.
      const model::Frame& frame = model_.frames[body.frame];
      const bool fixed = frame.parent == 0 && frame.stages.size() == 1 && frame.entries.size() == 1;
      const Formula axis = reading::mark(fixed ? "E" : "e", {reading::number(static_cast<long>(about[0] + 1))});
      return std::string("; its moment of inertia about ") + (fixed ? "" : "its axis ") + out_.math(axis) + " is " +
             diagonal[about[0]];
    }
    return "; its moments of inertia about its own axes are " + enumeration(diagonal);
  }
  bool is_zero(model::NodeId node) const {
    const std::optional<Formula> f = reading::as_written(model_, node);
    return f && reading::is_zero(*f);
  }

  std::optional<reading::Sum> read_short(symbolic::Ref expression) const {
    try {
      reading::Sum sum = reading::display_sum(m_, expression);
      if (sum.size() <= longest_position) return sum;
    } catch (const work::BudgetExceeded&) {  // a position that is too long is omitted
    }
    return std::nullopt;
  }

  void position(const mechanics::PointMass& mass) {
    reading::Components r;
    std::vector<Formula> axes;
    std::size_t terms = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = read_short(mass.position[k]);
      if (!component) return;
      r[k] = *component;
      terms += component->size();
      axes.push_back(reading::mark("E", {reading::number(static_cast<long>(k + 1))}));
    }
    if (terms == 0 || terms > longest_position) return;
    std::vector<Formula> index;
    if (m_.masses.size() > 1) index.push_back(reading::number(static_cast<long>(mass.place)));
    out_.display({reading::relation({reading::mark("r", std::move(index)), combination(r, axes)})});
  }

  void parameters() {
    if (model_.parameters.empty()) return;
    const bool notes = std::any_of(model_.parameters.begin(), model_.parameters.end(),
                                   [](const model::Parameter& p) { return !p.note.empty(); });
    std::vector<std::string> values;
    bool all_short = true;
    for (const model::Parameter& p : model_.parameters) {
      values.push_back(in_degrees(p));
      if (!values.back().empty()) continue;
      const std::optional<Formula> written =
          p.value == model::no_node ? std::nullopt : reading::as_written(model_, p.value);
      const bool is_short = !written || out_.broken_lines(*written, longest_value).size() == 1;
      values.back() = !written ? "" : is_short ? out_.math(*written) : out_.table_cell(*written, longest_value);
      all_short = all_short && is_short;
    }
    out_.raw(std::string("\\begin{longtable}{@{}l") + (all_short ? "l" : "p{0.42\\linewidth}") + "l" +
             (notes ? "p{0.3\\linewidth}" : "") + "@{}}\n" + "\\emph{parameter} & \\emph{value} & \\emph{unit}" +
             (notes ? " & " : "") + " \\\\\n\\endhead\n");
    for (std::uint32_t i = 0; i < model_.parameters.size(); ++i) {
      const model::Parameter& p = model_.parameters[i];
      out_.raw(out_.math(reading::symbol({SymbolKind::parameter, i, 0})) + " & " + values[i] + " & " +
               (in_degrees(p).empty() ? unit_in_latex(p.unit.text) : "") +
               (notes ? " & " + escape_user_text(p.note) : "") + " \\\\[2pt]\n");
    }
    out_.raw("\\end{longtable}\n");
  }

  void inputs() {
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < model_.inputs.size(); ++i) {
      if (model_.inputs[i].source == model::Input::Source::contacts) continue;  // a run solves for them
      const std::string unit = unit_in_latex(model_.inputs[i].unit.text);
      names.push_back(out_.math(reading::symbol({SymbolKind::input, i, 0})) + (unit.empty() ? "" : " (" + unit + ")"));
    }
    if (!names.empty()) out_.paragraph("Inputs, given from outside: " + enumeration(names) + ".");
  }

  void forces() {
    if (a_.findings == nullptr || model_.forces.empty()) return;
    out_.paragraph("The forces that act, beside those of the constraints:");
    for (std::size_t i = 0; i < model_.forces.size(); ++i) force(i);
  }

  void force(std::size_t i) {
    const ForceFinding& found = a_.findings->forces[i];
    std::string text = bold(model_.forces[i].name) + ": ";
    std::vector<Formula> shown;
    if (found.conservative == "yes")
      text += found.many_valued ? "conservative where its potential is not followed around its singular points"
                                : "conservative";
    else
      text += found.conservative == "no" ? "not conservative" : "not known to be conservative";
    if (!found.reason.empty()) text += " (" + escape_user_text(found.reason) + ")";
    if (found.conservative == "yes" && found.potential) {
      if (const auto U = read_short(*found.potential)) {
        std::vector<Formula> index;
        if (model_.forces.size() > 1) index.push_back(reading::number(static_cast<long>(i + 1)));
        const Letters letters(model_, false);
        shown.push_back(reading::relation(
            {reading::mark(letters.U, std::move(index)), reading::arrange(with_powers(*U, a_.powers))}));
      }
    } else {
      for (std::uint32_t q = 0; q < model_.coordinates.size(); ++q) {
        const auto Q = read_short(m_.force_components[i][q]);
        if (!Q || Q->is_zero()) continue;
        shown.push_back(reading::relation(
            {reading::mark("Q", {reading::symbol({SymbolKind::coordinate, q, 0})}), reading::arrange(*Q)}));
      }
    }
    out_.paragraph(text + (shown.empty() ? "." : ","));
    out_.display(shown);
  }

  Article& a_;
  const Mechanics& m_;
  const model::Model& model_;
  LatexWriter& out_;
};

}  // namespace

void write_system(Article& a) {
  a.out.section("System");
  System(a).write();
}

}  // namespace eomgen::print
