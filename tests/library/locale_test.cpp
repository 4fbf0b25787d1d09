// SPDX-License-Identifier: GPL-3.0-or-later
// The library in a program whose locale writes a decimal comma and groups digits: the same results to the last byte.
#include <doctest/doctest.h>

#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <string>
#include <vector>

#include "library/example_definitions.hpp"

using namespace eomgen;

namespace {

class GermanPunctuation : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// A locale of C with a decimal comma, installed or made in a temporary folder by localedef; and one of C++.
class GermanLocale {
 public:
  GermanLocale() {
    is_c_ = set();
    if (!is_c_) {
      folder_ = std::filesystem::temp_directory_path() / "eomgen-test-locale";
      std::filesystem::create_directories(folder_);
      const std::string command = "localedef -i de_DE -f UTF-8 " + (folder_ / "de_DE.utf8").string() + " 2>/dev/null";
      ::setenv("LOCPATH", folder_.c_str(), 1);
      is_c_ = std::system(command.c_str()) == 0 && set();
    }
    std::locale::global(std::locale(std::locale(), new GermanPunctuation));
    if (is_c_) set();  // of C++ sets that of C only if it has a name
  }
  ~GermanLocale() {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
    ::unsetenv("LOCPATH");
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  GermanLocale(const GermanLocale&) = delete;
  GermanLocale& operator=(const GermanLocale&) = delete;

  bool is_of_c() const { return is_c_; }

 private:
  static bool set() {
    return std::setlocale(LC_ALL, "de_DE.utf8") != nullptr && std::string(std::localeconv()->decimal_point) == ",";
  }
  bool is_c_ = false;
  std::filesystem::path folder_;
};

/// Texts and numbers of everything that the library computes from a model.
struct Results {
  std::vector<std::string> texts;
  std::vector<double> numbers;
};

Results results() {
  Results all;
  Definition d = test::pendulum();
  d.parameter("c", Value(0.0123)).parameter("large", Value(12345.5));
  d.add("force", {{"on", "P"}, {"force", "c*1234.5/large*1e-3*E1"}});
  const Model model = Model::from(d, "pendulum");
  for (const char* target :
       {"c", "cpp", "batch", "javascript", "python", "cuda", "rust", "octave", "casadi", "julia", "modelica"}) {
    const bool whole = std::string(target) == "c" || std::string(target) == "cpp" ||
                       std::string(target) == "javascript" || std::string(target) == "python";
    const Sources sources = model.emit({.target = target,
                                        .extra_functions = whole ? std::vector<std::string>{"jac", "mass", "start"}
                                                                 : std::vector<std::string>{"jac", "mass"},
                                        .outputs = {"energy"}});
    for (const SourceFile& file : sources.files) all.texts.push_back(file.text);
  }
  all.texts.push_back(model.latex_document());
  all.texts.push_back(model.equations().text("equations"));
  const Motion motion = model.run({.parameters = {{"m", 1.25}}});
  for (const std::vector<double>& row : motion.rows) all.numbers.insert(all.numbers.end(), row.begin(), row.end());
  const Linearisation linear = model.linearise();
  all.numbers.insert(all.numbers.end(), linear.A.begin(), linear.A.end());
  const Certificate certificate = model.verify({.points = 2, .compile = false});
  all.texts.emplace_back(certificate.pass ? "pass" : "fail");
  return all;
}

}  // namespace

TEST_CASE("library: a decimal comma and grouped digits in the locale of the program change no byte") {
  const Results before = results();
  REQUIRE(before.numbers.size() > 100);
  const GermanLocale german;
  if (!german.is_of_c()) MESSAGE("skipped for the locale of C: there is no de_DE.utf8 and localedef cannot make it");
  const Results under = results();
  REQUIRE(before.texts.size() == under.texts.size());
  for (std::size_t i = 0; i < before.texts.size(); ++i) {
    CAPTURE(i);
    CHECK(before.texts[i] == under.texts[i]);
  }
  CHECK(before.numbers == under.numbers);
}
