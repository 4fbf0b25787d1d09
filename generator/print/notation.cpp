// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/notation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "joints/joint.hpp"
#include "reading/balance_form.hpp"
#include "reading/routh.hpp"
#include "reading/solved_form.hpp"

namespace eomgen::print {
namespace {

using symbolic::SymbolKind;

constexpr std::array<std::pair<std::string_view, std::string_view>, 37> letters{{
    {"alpha", "α"},  {"beta", "β"},  {"gamma", "γ"},   {"delta", "δ"},    {"epsilon", "ϵ"}, {"varepsilon", "ε"},
    {"zeta", "ζ"},   {"eta", "η"},   {"theta", "θ"},   {"vartheta", "ϑ"}, {"iota", "ι"},    {"kappa", "κ"},
    {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},      {"xi", "ξ"},       {"pi", "π"},      {"rho", "ρ"},
    {"sigma", "σ"},  {"tau", "τ"},   {"upsilon", "υ"}, {"phi", "ϕ"},      {"varphi", "φ"},  {"chi", "χ"},
    {"psi", "ψ"},    {"omega", "ω"}, {"Gamma", "Γ"},   {"Delta", "Δ"},    {"Theta", "Θ"},   {"Lambda", "Λ"},
    {"Xi", "Ξ"},     {"Pi", "Π"},    {"Sigma", "Σ"},   {"Upsilon", "Υ"},  {"Phi", "Φ"},     {"Psi", "Ψ"},
    {"Omega", "Ω"},
}};

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool all_digits(std::string_view s) { return !s.empty() && std::all_of(s.begin(), s.end(), is_digit); }

std::string latex_word(std::string_view word) {
  if (!greek(word).empty()) return "\\" + std::string(word);
  if (word.size() == 1 || all_digits(word)) return std::string(word);
  return "\\mathrm{" + std::string(word) + "}";
}

std::string mathml_word(std::string_view word) {
  if (all_digits(word)) return "<mn>" + std::string(word) + "</mn>";
  if (const std::string_view letter = greek(word); !letter.empty()) return "<mi>" + std::string(letter) + "</mi>";
  return "<mi>" + std::string(word) + "</mi>";
}

}  // namespace

namespace {

/// One equation of a joint: "F1", "M2", and its effect on the second body.
struct JointDirection {
  std::uint32_t constraint;
  const model::Joint* joint;
  std::string name;       // "F1"
  std::string direction;  // "force along E1"
};

std::string direction_of(const std::string& moment) {  // "cross(b, a1)" -> "b x a1"
  const std::size_t open = moment.find('('), comma = moment.find(", ");
  return moment.substr(open + 1, comma - open - 1) + " x " + moment.substr(comma + 2, moment.size() - comma - 3);
}

std::vector<JointDirection> joint_directions(const mechanics::Mechanics& m) {
  std::vector<JointDirection> result;
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const model::Joint& joint = m.model->joints[i];
    const joints::Joint* kind = joints::find(joint.type);
    std::size_t forces = 0, moments = 0;
    for (std::uint32_t k = 0; k < kind->equations.size(); ++k) {
      const joints::Equation& e = kind->equations[k];
      const bool force = !e.force.empty();
      result.push_back({m.joints[i].first + k, &joint,
                        force ? "F" + std::to_string(++forces) : "M" + std::to_string(++moments),
                        force ? "force along " + e.force : "moment along " + direction_of(e.moment)});
    }
  }
  return result;
}

}  // namespace

std::vector<MultiplierDescription> multiplier_descriptions(const mechanics::Mechanics& m) {
  std::vector<MultiplierDescription> result;
  const std::vector<JointDirection> of_joints = joint_directions(m);
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (!m.is_independent(k)) continue;
    const auto found =
        std::find_if(of_joints.begin(), of_joints.end(), [k](const JointDirection& d) { return d.constraint == k; });
    if (found == of_joints.end()) {
      result.push_back({k, "of the constraint '" + m.constraints[k].label + "'"});
      continue;
    }
    const std::uint32_t frame = found->joint->frames[1];
    const std::string on = frame == 0 ? "the ground" : "'" + m.model->frames[frame].name + "'";
    result.push_back({k, "of the joint '" + found->joint->name + "' on " + on + ": " + found->direction});
  }
  if (m.constraints.size() == 1) result.clear();
  return result;
}

std::string_view greek(std::string_view name) {
  const auto found = std::find_if(letters.begin(), letters.end(), [&](const auto& l) { return l.first == name; });
  return found == letters.end() ? std::string_view() : found->second;
}

Glyph split_name(std::string_view name) {
  Glyph glyph;
  glyph.name = std::string(name);
  std::size_t end = 0;
  while (end < name.size() && is_letter(name[end])) ++end;
  glyph.base = std::string(name.substr(0, end));
  while (end < name.size()) {
    if (name[end] == '_') {
      ++end;
      continue;
    }
    const std::size_t start = end;
    while (end < name.size() && name[end] != '_' && is_digit(name[end]) == is_digit(name[start])) ++end;
    glyph.index.emplace_back(name.substr(start, end - start));
  }
  return glyph;
}

Notation::Notation(const mechanics::Mechanics& mechanics)
    : model_(mechanics.model.get()), multipliers_(mechanics.constraints.size()), multiplier_letter_("lambda") {
  const auto taken = [&](const char* letter) {
    const auto in = [&](const auto& list) {
      return std::any_of(list.begin(), list.end(), [&](const auto& e) { return split_name(e.name).base == letter; });
    };
    return in(model_->parameters) || in(model_->coordinates) || in(model_->functions) || in(model_->inputs);
  };
  if (taken("lambda")) multiplier_letter_ = "mu";
  if (taken("p")) momentum_letter_ = "Pi";
  if (taken("omega")) omega_letter_ = "varpi";
  if (taken("gamma")) cosine_letter_ = "Gamma";
  of_joints_.resize(mechanics.constraints.size());
  for (const JointDirection& d : joint_directions(mechanics)) {
    Glyph glyph = split_name(multiplier_letter_ + "_" + d.joint->name);
    glyph.index.push_back(d.name);
    glyph.name += "_" + d.name;
    of_joints_[d.constraint] = std::move(glyph);
  }
}

Glyph Notation::multiplier(std::uint32_t constraint) const {
  if (of_joints_[constraint]) return *of_joints_[constraint];
  if (multipliers_ == 1) return split_name(multiplier_letter_);
  return split_name(multiplier_letter_ + "_" + std::to_string(constraint + 1));
}

Glyph Notation::operator()(const symbolic::Symbol& symbol) const {
  static constexpr std::array<const char*, 3> endings{"", "_dot", "_ddot"};
  const auto named = [&](const std::string& name, const std::string& tex) {
    Glyph glyph = split_name(name);
    glyph.tex = tex;
    glyph.dots = symbol.order;
    glyph.name += symbol.order < 3 ? endings[symbol.order] : "_d" + std::to_string(symbol.order);
    return glyph;
  };
  switch (symbol.kind) {
    case SymbolKind::time: return split_name("t");
    case SymbolKind::parameter:
      return named(model_->parameters[symbol.index].name, model_->parameters[symbol.index].tex);
    case SymbolKind::input: return named(model_->inputs[symbol.index].name, model_->inputs[symbol.index].tex);
    case SymbolKind::function: return named(model_->functions[symbol.index].name, model_->functions[symbol.index].tex);
    case SymbolKind::coordinate:
      return named(model_->coordinates[symbol.index].name, model_->coordinates[symbol.index].tex);
    case SymbolKind::multiplier: return multiplier(symbol.index);
    case SymbolKind::integral: {
      const auto before = std::count_if(model_->states.begin(), model_->states.begin() + symbol.index,
                                        [](const model::State& state) { return state.integral; });
      return split_name("I_" + std::to_string(before + 1));
    }
    case SymbolKind::state: return named(model_->states[symbol.index].name, model_->states[symbol.index].tex);
    case SymbolKind::friction: return split_name("F_f_" + std::to_string(symbol.index + 1));
    case SymbolKind::branch:
    case SymbolKind::vector:
    case SymbolKind::contact_mode: break;
    case SymbolKind::auxiliary:
      if (symbol == reading::momentum_symbol(symbol.index))
        return split_name(momentum_letter_ + "_" + model_->coordinates[symbol.index].name);
      for (std::uint32_t k = 0; k < 9; ++k) {
        if (symbol == reading::cosine_symbol(k / 3, k % 3))
          return split_name(cosine_letter_ + "_" + std::to_string(k / 3 + 1) + "_" + std::to_string(k % 3 + 1));
        for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
          if (k > 2 || symbol != reading::omega_symbol(k, order)) continue;
          Glyph glyph = split_name(omega_letter_ + "_" + std::to_string(k + 1));
          glyph.dots = order;
          if (order == 1) glyph.name += "_dot";
          return glyph;
        }
      }
      for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
        if (symbol != reading::initial_symbol(symbol.index, order)) continue;
        Glyph glyph = split_name(model_->coordinates[symbol.index].name);
        glyph.tex = model_->coordinates[symbol.index].tex;
        glyph.dots = order;
        if (glyph.tex.empty())
          glyph.index.emplace_back("0");
        else
          glyph.tex += "_{0}";
        glyph.name += order == 0 ? "_0" : "_dot_0";
        return glyph;
      }
      break;
  }
  return split_name("e_" + std::to_string(symbol.index + 1));
}

std::optional<reading::Formula> Notation::integrand(std::uint32_t integral) const {
  return reading::as_written(*model_, model_->states[integral].rate);
}

std::string latex(const Glyph& glyph) {
  const auto dotted = [&](std::string base) {
    switch (glyph.dots) {
      case 0: return base;
      case 1: return "\\dot{" + base + "}";
      case 2: return "\\ddot{" + base + "}";
      case 3: return "\\dddot{" + base + "}";
      default: return (glyph.tex.empty() ? base : "{" + base + "}") + "^{(" + std::to_string(glyph.dots) + ")}";
    }
  };
  if (!glyph.tex.empty()) return glyph.dots == 0 ? "{" + glyph.tex + "}" : dotted(glyph.tex);
  std::string result = dotted(latex_word(glyph.base));
  if (glyph.index.empty()) return result;
  if (glyph.dots > 3) result = "{" + result + "}";
  result += "_{";
  for (std::size_t i = 0; i < glyph.index.size(); ++i) result += (i > 0 ? "," : "") + latex_word(glyph.index[i]);
  return result + "}";
}

std::string mathml(const Glyph& glyph) {
  static constexpr std::array<const char*, 4> marks{"", "˙", "¨", "⃛"};
  std::string base = mathml_word(glyph.base);
  if (glyph.dots > 0 && glyph.dots <= 3) {
    base = "<mover accent=\"true\">" + base + "<mo>" + marks[static_cast<std::size_t>(glyph.dots)] + "</mo></mover>";
  } else if (glyph.dots > 3) {
    base = "<msup>" + base + "<mrow><mo>(</mo><mn>" + std::to_string(glyph.dots) + "</mn><mo>)</mo></mrow></msup>";
  }
  if (glyph.index.empty()) return base;
  std::string index;
  for (std::size_t i = 0; i < glyph.index.size(); ++i)
    index += (i > 0 ? "<mo>,</mo>" : "") + mathml_word(glyph.index[i]);
  return "<msub>" + base + "<mrow>" + index + "</mrow></msub>";
}

std::string escape_latex(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) {
      // LaTeX supports the accented letters U+00C0 .. U+00FF; other characters would stop it.
      const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0u;
      const unsigned code = ((byte & 0x1fu) << 6) | (next & 0x3fu);
      if ((byte & 0xe0u) == 0xc0u && (next & 0xc0u) == 0x80u && code >= 0xc0 && code <= 0xff && code % 0x20 != 0x10 &&
          code % 0x20 != 0x17 && code % 0x20 != 0x1e) {
        result += text.substr(i, 2);
        ++i;
      } else if ((byte & 0xc0u) != 0x80u) {
        result += '?';
      }
      continue;
    }
    switch (c) {
      case '\\': result += "\\textbackslash{}"; break;
      case '{':
      case '}':
      case '$':
      case '&':
      case '#':
      case '%':
      case '_': result += std::string("\\") + c; break;
      case '^': result += "\\textasciicircum{}"; break;
      case '~': result += "\\textasciitilde{}"; break;
      case '<': result += "\\textless{}"; break;
      case '>': result += "\\textgreater{}"; break;
      case '"': result += "''"; break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f)
          result += c;
        else
          result += ' ';
    }
  }
  return result;
}

std::string escape_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      default: result += c;
    }
  }
  return result;
}

}  // namespace eomgen::print
