// SPDX-License-Identifier: GPL-3.0-or-later
// LaTeX of the user's reaches documents that are compiled: only what cannot do anything is let through.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "model/names.hpp"

namespace eomgen::model {
namespace {

constexpr std::array<std::string_view, 71> commands{
    "alpha",    "beta",   "gamma",   "delta",    "epsilon",   "varepsilon", "zeta",      "eta",     "theta",
    "vartheta", "iota",   "kappa",   "lambda",   "mu",        "nu",         "xi",        "pi",      "varpi",
    "rho",      "varrho", "sigma",   "varsigma", "tau",       "upsilon",    "phi",       "varphi",  "chi",
    "psi",      "omega",  "Gamma",   "Delta",    "Theta",     "Lambda",     "Xi",        "Pi",      "Sigma",
    "Upsilon",  "Phi",    "Psi",     "Omega",    "bar",       "hat",        "tilde",     "vec",     "check",
    "breve",    "acute",  "grave",   "overline", "underline", "widehat",    "widetilde", "mathrm",  "mathbf",
    "mathit",   "mathsf", "mathcal", "mathbb",   "mathfrak",  "boldsymbol", "text",      "ell",     "hbar",
    "prime",    "star",   "ast",     "circ",     "parallel",  "perp",       "infty",     "varkappa"};

}  // namespace

std::optional<std::string> illegal_tex(std::string_view tex) {
  constexpr std::size_t longest = 100;
  if (tex.empty()) return "it is empty";
  if (tex.size() > longest) return fmt::format("it is longer than {} characters", longest);
  int depth = 0;
  for (std::size_t k = 0; k < tex.size(); ++k) {
    const char c = tex[k];
    if (c == '\\') {
      std::size_t end = k + 1;
      while (end < tex.size() && std::isalpha(static_cast<unsigned char>(tex[end])) != 0) ++end;
      const std::string_view command = tex.substr(k + 1, end - k - 1);
      if (command.empty() && end < tex.size() && (tex[end] == ',' || tex[end] == ';' || tex[end] == '!')) {
        k = end;
        continue;
      }
      if (std::find(commands.begin(), commands.end(), command) == commands.end()) {
        return fmt::format("the command {} is not allowed", quote(tex.substr(k, std::max<std::size_t>(2, end - k))));
      }
      k = end - 1;
      continue;
    }
    if (c == '{') ++depth;
    if (c == '}' && --depth < 0) return "a '}' has no '{'";
    const bool fine = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                      std::string_view("_^{} ,'*+-").find(c) != std::string_view::npos;
    if (!fine) return fmt::format("the character {} is not allowed", quote(std::string_view(&c, 1)));
  }
  if (depth != 0) return "a '{' is not closed";
  return std::nullopt;
}

}  // namespace eomgen::model
