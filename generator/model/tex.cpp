// SPDX-License-Identifier: GPL-3.0-or-later
// LaTeX of the user becomes part of documents that are compiled, so only harmless commands are accepted.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>

#include "model/names.hpp"

namespace eomgen::model {
namespace {

constexpr std::string_view symbols[] = {
    "alpha", "beta",     "gamma",  "delta",   "epsilon", "varepsilon", "zeta",     "eta",   "theta", "vartheta",
    "iota",  "kappa",    "lambda", "mu",      "nu",      "xi",         "pi",       "varpi", "rho",   "varrho",
    "sigma", "varsigma", "tau",    "upsilon", "phi",     "varphi",     "chi",      "psi",   "omega", "Gamma",
    "Delta", "Theta",    "Lambda", "Xi",      "Pi",      "Sigma",      "Upsilon",  "Phi",   "Psi",   "Omega",
    "ell",   "hbar",     "prime",  "star",    "ast",     "circ",       "parallel", "perp",  "infty", "varkappa"};
constexpr std::string_view accents[] = {"bar",   "hat",   "tilde",    "vec",       "check",   "breve",
                                        "acute", "grave", "overline", "underline", "widehat", "widetilde"};
constexpr std::string_view styles[] = {"mathrm",  "mathbf", "mathit",   "mathsf",
                                       "mathcal", "mathbb", "mathfrak", "boldsymbol"};

bool among(std::string_view word, std::span<const std::string_view> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_word_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// list = { atom { "_" argument | "^" argument | "'" } }, with at most one subscript and one superscript each, as in
/// TeX; atom = character | "{" list "}" | symbol | accent argument | style argument | \text{words}.
class TexReader {
 public:
  explicit TexReader(std::string_view tex) : tex_(tex) {}

  std::optional<std::string> problem() {
    list(0);
    if (!problem_ && at_ < tex_.size()) problem_ = "a '}' has no '{'";
    return problem_;
  }

 private:
  bool more() const { return !problem_ && at_ < tex_.size(); }
  void fail(std::string what) {
    if (!problem_) problem_ = std::move(what);
  }

  void list(int depth) {
    bool below = false, above = false;
    while (more() && tex_[at_] != '}') {
      const char c = tex_[at_];
      if (c == '_' || c == '^') {
        bool& taken = c == '_' ? below : above;
        if (taken)
          return fail(
              fmt::format("there are two {}scripts: LaTeX wants braces, as in L_{{1,2}}", c == '_' ? "sub" : "super"));
        taken = true;
        ++at_;
        argument(depth, true);
      } else if (c == '\'') {
        // A prime is a superscript and includes a superscript that follows directly.
        if (above) return fail("a prime comes after a superscript: write it before, as in x'^2");
        above = true;
        while (more() && tex_[at_] == '\'') ++at_;
        if (!more() || tex_[at_] != '^') continue;
        ++at_;
        argument(depth, true);
      } else {
        below = above = false;
        atom(depth);
      }
    }
  }

  void blanks() {
    while (more() && tex_[at_] == ' ') ++at_;
  }

  void group(int depth) {
    if (depth > 20) return fail("braces are nested more than 20 deep");
    ++at_;
    list(depth + 1);
    if (problem_) return;
    if (at_ >= tex_.size()) return fail("a '{' is not closed");
    ++at_;
  }

  void argument(int depth, bool script) {
    blanks();
    if (!more() || tex_[at_] == '}') return fail(script ? "nothing follows '_' or '^'" : "a command has no argument");
    if (tex_[at_] == '{') return group(depth);
    if (tex_[at_] == '\\') {
      const std::size_t before = at_;
      const std::string_view word = command();
      if (among(word, symbols)) return;
      at_ = before;
      if (!problem_)
        fail(fmt::format("{} needs braces there: {{{}..}}", quote("\\" + std::string(word)), "\\" + std::string(word)));
      return;
    }
    if (!is_word_character(tex_[at_]) && tex_[at_] != '*' && tex_[at_] != '+' && tex_[at_] != '-')
      return fail(fmt::format("the character {} is not allowed there", quote(tex_.substr(at_, 1))));
    ++at_;
  }

  void atom(int depth) {
    const char c = tex_[at_];
    if (c == '{') return group(depth);
    if (c == '\\') return commanded(depth);
    const bool fine = is_word_character(c) || std::string_view(" ,*+-").find(c) != std::string_view::npos;
    if (!fine) return fail(fmt::format("the character {} is not allowed", quote(std::string_view(&c, 1))));
    ++at_;
  }

  std::string_view command() {
    std::size_t end = at_ + 1;
    while (end < tex_.size() && std::isalpha(static_cast<unsigned char>(tex_[end])) != 0) ++end;
    const std::string_view word = tex_.substr(at_ + 1, end - at_ - 1);
    const bool known = among(word, symbols) || among(word, accents) || among(word, styles) || word == "text";
    if (!known)
      fail(fmt::format("the command {} is not allowed", quote(tex_.substr(at_, std::max<std::size_t>(2, end - at_)))));
    at_ = end;
    return word;
  }

  void commanded(int depth) {
    if (at_ + 1 < tex_.size() && std::string_view(",;!").find(tex_[at_ + 1]) != std::string_view::npos) {
      at_ += 2;
      return;
    }
    const std::string_view word = command();
    if (problem_) return;
    if (word == "text") return words();
    if (among(word, accents) || among(word, styles)) argument(depth, false);
  }

  /// Text has no scripts and no symbols.
  void words() {
    blanks();
    if (!more() || tex_[at_] != '{') return fail("\\text wants braces");
    for (++at_; more() && tex_[at_] != '}'; ++at_) {
      const char c = tex_[at_];
      if (!is_word_character(c) && std::string_view(" ,'*+-").find(c) == std::string_view::npos)
        return fail(fmt::format("the character {} is not allowed in \\text", quote(tex_.substr(at_, 1))));
    }
    if (at_ >= tex_.size()) return fail("a '{' is not closed");
    ++at_;
  }

  std::string_view tex_;
  std::size_t at_ = 0;
  std::optional<std::string> problem_;
};

}  // namespace

std::optional<std::string> tex_error(std::string_view tex) {
  constexpr std::size_t longest = 100;
  if (tex.empty()) return "it is empty";
  if (tex.size() > longest) return fmt::format("it is longer than {} characters", longest);
  return TexReader(tex).problem();
}

bool needs_amssymb(std::string_view tex) {
  for (const char* command : {"\\mathbb", "\\mathfrak", "\\varkappa"}) {
    if (tex.find(command) != std::string_view::npos) return true;
  }
  return false;
}

}  // namespace eomgen::model
