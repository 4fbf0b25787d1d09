// SPDX-License-Identifier: GPL-3.0-or-later
// Equal input gives equal bytes in any process: addresses, environment and folder differ between processes.
#include <doctest/doctest.h>

#include <array>
#include <map>

#include "program.hpp"
#include "support/typeset.hpp"

using namespace eomgen::test;

namespace {

using Files = std::map<std::string, std::string>;

// Two processes find what depends on addresses or the environment, over all models; every few models take two more.
constexpr std::size_t models_per_group = 8;
std::size_t processes_for(std::size_t model) { return model % models_per_group == 0 ? 4 : 2; }

/// Files that `words` writes into out/, from each of `processes` processes. Of two processes the second one derives and
/// emits with the certificate cached by the first one. Of four processes two verify independently.
std::vector<Files> emit_repeatedly(const Words& words, std::size_t processes) {
  std::vector<Files> result;
  const std::array<Folder, 2> caches;
  for (std::size_t i = 0; i < processes; ++i) {
    const Folder folder;
    ChildCommand call = command(folder, words);
    // Moves the stack, and changes hashes that are seeded from the environment.
    call.environment["EOMGEN_TEST_PADDING"] = std::string(1 + 977 * i, 'x');
    call.environment["EOMGEN_CACHE_DIR"] = caches[processes > 2 ? i % 2 : 0] / "cache";
    call.environment["LC_ALL"] = i % 2 == 0 ? "C" : "C.UTF-8";
    const ChildResult finished = Child(call).finish();
    CAPTURE(finished.err);
    CHECK(finished.status == 0);
    Files files{{"standard output", finished.out}};
    if (folder.has("out")) {
      for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder / "out")) {
        const std::string name = entry.path().filename().string();
        files[name] = folder.read("out/" + name);
      }
    }
    result.push_back(std::move(files));
  }
  return result;
}

struct Shipped {
  std::string name;
  bool prescribed;  // nothing to integrate, so no code: compares the printed equations instead
};

const std::vector<Shipped>& shipped_examples() {
  static const std::vector<Shipped> all = [] {
    const Folder folder;
    std::vector<Shipped> result;
    for (const std::string& model : shipped_models())
      result.push_back({model, document(folder, {"check", model})["dof"] == 0});
    return result;
  }();
  return all;
}

/// Returns the files of the first process.
Files require_same_everywhere(const std::string& model, const Words& words, std::size_t files, std::size_t processes) {
  CAPTURE(model);
  const std::vector<Files> all = emit_repeatedly(words, processes);
  CHECK(all.front().size() == files + 1);
  for (const Files& one : all) {
    for (const auto& [name, text] : one) {
      const auto& shown = name;
      CAPTURE(shown);
      CHECK((text == all.front().at(name)));  // parentheses prevent doctest from printing both
    }
  }
  return all.front();
}

/// Joins documents: the text between beginning and end of each.
class Pages {
 public:
  void add(const std::string& model, const std::string& document) {
    const std::string begin = "\\begin{document}\n", end = "\\end{document}\n";
    const std::size_t from = document.find(begin), to = document.rfind(end);
    REQUIRE(from != std::string::npos);
    REQUIRE(to != std::string::npos);
    if (text_.empty()) text_ = document.substr(0, from) + "\\usepackage{amssymb,graphicx}\n" + begin;
    const std::size_t body = from + begin.size();
    text_ += "% ITEM " + model + "\n" + document.substr(body, to - body) + "\\clearpage\n";
  }
  std::string text() const { return text_ + "\\end{document}\n"; }

 private:
  std::string text_;
};

}  // namespace

TEST_CASE("every shipped model emits equal bytes in fresh processes") {
  std::size_t index = 0;
  for (const auto& [model, prescribed] : shipped_examples()) {
    const std::size_t processes = processes_for(index++);
    if (prescribed) {
      require_same_everywhere(model, {"derive", model, "--show", "all", "--json"}, 0, processes);
      continue;
    }
    const Words words{"emit", model, "-o", "out", "--with", "jac,reactions,outputs", "--output", "energy"};
    require_same_everywhere(model, words, 3, processes);
  }
}

TEST_CASE("the document of every shipped model has equal bytes in fresh processes, and fits on its pages") {
  Pages pages;
  std::size_t index = 0;
  for (const auto& [model, prescribed] : shipped_examples()) {
    const std::size_t processes = processes_for(index++);
    if (prescribed) continue;
    const Files files = require_same_everywhere(model, {"emit", model, "-o", "out", "--target", "latex"}, 1, processes);
    pages.add(model, files.at(model + ".tex"));
  }
  if (is_pdflatex_installed()) check_fits(typeset(pages.text(), "documents"));
}
