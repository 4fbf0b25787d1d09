// SPDX-License-Identifier: GPL-3.0-or-later
// Equal input gives equal bytes in any process: addresses, environment and folder differ between processes.
#include <doctest/doctest.h>

#include <map>

#include "program.hpp"
#include "support/typeset.hpp"

using namespace eomgen::test;

namespace {

constexpr int processes = 5, at_least = 2;
constexpr std::size_t long_output = 60000;  // bytes: seconds of work, so only as many processes as needed

using Files = std::map<std::string, std::string>;

std::size_t size_of(const Files& files) {
  std::size_t sum = 0;
  for (const auto& [name, text] : files) sum += text.size();
  return sum;
}

/// Files that `words` writes into out/, from `processes` processes, two at a time; from only two if the output is long.
/// The first two verify independently. The others derive and emit again with the certificates cached by these.
std::vector<Files> emit_repeatedly(const Words& words) {
  std::vector<Files> result;
  std::vector<std::unique_ptr<Folder>> folders;
  for (int k = 0; k < processes; k += 2) {
    if (k >= at_least && size_of(result.front()) > long_output) break;
    std::vector<std::unique_ptr<Child>> children;
    for (int i = k; i < std::min(k + 2, processes); ++i) {
      folders.push_back(std::make_unique<Folder>());
      ChildCommand call = command(*folders.back(), words);
      // Moves the stack, and changes hashes that are seeded from the environment.
      call.environment["EOMGEN_TEST_PADDING"] = std::string(static_cast<std::size_t>(1 + 977 * i), 'x');
      call.environment["EOMGEN_CACHE_DIR"] = *folders[static_cast<std::size_t>(i % 2)] / "cache";
      call.environment["LC_ALL"] = i % 2 == 0 ? "C" : "C.UTF-8";
      children.push_back(std::make_unique<Child>(call));
    }
    for (std::size_t c = 0; c < children.size(); ++c) {
      const std::size_t i = folders.size() - children.size() + c;
      const ChildResult finished = children[c]->finish();
      CAPTURE(finished.err);
      CHECK(finished.status == 0);
      Files files{{"standard output", finished.out}};
      if (folders[i]->has("out")) {
        for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(*folders[i] / "out")) {
          const std::string name = entry.path().filename().string();
          files[name] = folders[i]->read("out/" + name);
        }
      }
      result.push_back(std::move(files));
    }
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
Files require_same_everywhere(const std::string& model, const Words& words, std::size_t files) {
  CAPTURE(model);
  const std::vector<Files> all = emit_repeatedly(words);
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
  for (const auto& [model, prescribed] : shipped_examples()) {
    if (prescribed) {
      require_same_everywhere(model, {"derive", model, "--show", "all", "--json"}, 0);
      continue;
    }
    require_same_everywhere(model,
                            {"emit", model, "-o", "out", "--with", "jac,reactions,outputs", "--output", "energy"}, 3);
  }
}

TEST_CASE("the document of every shipped model has equal bytes in fresh processes, and fits on its pages") {
  Pages pages;
  for (const auto& [model, prescribed] : shipped_examples()) {
    if (prescribed) continue;
    const Files files = require_same_everywhere(model, {"emit", model, "-o", "out", "--target", "latex"}, 1);
    pages.add(model, files.at(model + ".tex"));
  }
  if (is_pdflatex_installed()) check_fits(typeset(pages.text(), "documents"));
}
