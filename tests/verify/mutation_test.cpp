// SPDX-License-Identifier: GPL-3.0-or-later
// Mutation test: small changes to emitted C, as errors of the generator or of an editor would make them. The self test
// of the file, or `verify`, has to detect them. Many mutants of a file go into one library, each with its own names.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "emit/shared_library/process.hpp"
#include "emit/targets.hpp"
#include "error.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/code.hpp"
#include "pipeline/pipeline.hpp"
#include "program/abi_values.hpp"
#include "support/temporary_folder.hpp"

using namespace eomgen;

namespace {

/// A position in a source where a token can be replaced.
struct Change {
  std::size_t at = 0, length = 0;
  std::string by, what;
};

class Mutator {
 public:
  Mutator(std::string source, const std::string& header, std::string name, std::uint64_t seed)
      : source_(std::move(source)), name_(std::move(name)), engine_(seed) {
    const std::size_t sizes = header.find("enum {");
    source_ = std::regex_replace(source_, std::regex("#include \"[^\n]*\n"),
                                 header.substr(sizes, header.find("};", sizes) + 2 - sizes));
    functions();
  }

  /// The same number of changes in each function, or fewer if it has fewer positions.
  std::vector<Change> changes(std::size_t count) {
    std::vector<Change> result;
    std::set<std::pair<std::size_t, std::string>> seen;
    for (std::size_t tries = 0; tries < 40 * count && result.size() < count; ++tries) {
      const auto& [begin, end] = functions_[tries % functions_.size()];
      const std::optional<Change> change = any(begin, end);
      if (change && seen.insert({change->at, change->by}).second) result.push_back(*change);
    }
    return result;
  }

  /// The source with this change, and unique names.
  std::string changed(const Change& change, const std::string& name) const {
    std::string text = source_;
    text.replace(change.at, change.length, change.by);
    std::string result;
    const std::string wanted = name_ + "_";
    std::size_t from = 0;
    for (std::size_t found; (found = text.find(wanted, from)) != std::string::npos; from = found + wanted.size()) {
      const char before = found > 0 ? text[found - 1] : ' ';
      const bool part = std::isalnum(static_cast<unsigned char>(before)) != 0 || before == '_';
      result += text.substr(from, found - from) + (part ? wanted : name + "_");
    }
    return result + text.substr(from);
  }

  std::string line_at(const Change& change) const {
    const std::size_t line = source_.rfind('\n', change.at);
    return source_.substr(line, source_.find('\n', change.at) - line);
  }

 private:
  // From the line after the signature of a function to its end.
  void functions() {
    const std::size_t last = source_.find("/* Whether values differ");
    REQUIRE(last != std::string::npos);
    const std::regex head("\n(?:static |static inline )?int " + name_ + "_(\\w+)\\([^{]*\\)\n\\{\n");
    for (std::sregex_iterator it(source_.begin(), source_.end(), head), none; it != none; ++it) {
      const std::size_t begin = static_cast<std::size_t>(it->position() + it->length()),
                        end = source_.find("\n}\n", begin);
      const std::string function = (*it)[1];
      if (begin > last || function == "abi" || function.find("sincos") != std::string::npos ||
          function.starts_with("taylor_sums") || function == "taylor")
        continue;  // a changed loop may not end
      functions_.emplace_back(begin, end);
    }
    REQUIRE(functions_.size() > 4);
  }

  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  std::vector<std::pair<std::size_t, std::string>> all(const std::string& pattern, std::size_t begin,
                                                       std::size_t end) const {
    std::vector<std::pair<std::size_t, std::string>> result;
    const std::regex wanted(pattern);
    for (std::sregex_iterator it(source_.begin() + static_cast<std::ptrdiff_t>(begin),
                                 source_.begin() + static_cast<std::ptrdiff_t>(end), wanted),
         none;
         it != none; ++it) {
      result.emplace_back(begin + static_cast<std::size_t>(it->position()), it->str());
    }
    return result;
  }

  std::optional<Change> any(std::size_t begin, std::size_t end) {
    switch (below(6)) {
      case 0:
        return exchanged(
            all(" \\+ | - ", begin, end), [](const std::string& s) { return s == " + " ? " - " : " + "; }, "sign");
      case 1:
        return exchanged(
            all("[\\w\\])]\\*[\\w(]", begin, end),
            [](const std::string& s) { return fmt::format("{}+{}", s[0], s[2]); }, "product");
      case 2:
        return exchanged(
            all("\\b[xpuw]\\[\\d+\\]", begin, end),
            [](const std::string& s) {
              const int index = std::stoi(s.substr(2));
              return fmt::format("{}[{}]", s[0], index > 0 ? index - 1 : index + 1);
            },
            "index");
      case 3:
        return exchanged(
            all("\\b\\d+\\.\\d+\\b", begin, end),
            [](const std::string& s) { return s == "0.0" ? "1.0" : fmt::format("(1.5*{})", s); }, "constant");
      case 4:
        return exchanged(
            all(" = -", begin, end), [](const std::string&) { return " = "; }, "leading sign");
      default: return operand(begin, end);
    }
  }

  template <class By>
  std::optional<Change> exchanged(const std::vector<std::pair<std::size_t, std::string>>& places, const By& by,
                                  const char* what) {
    if (places.empty()) return std::nullopt;
    const auto& [at, text] = places[below(places.size())];
    return Change{at, text.size(), by(text), what};
  }

  /// One value replaced by an earlier one.
  std::optional<Change> operand(std::size_t begin, std::size_t end) {
    std::vector<std::pair<std::size_t, std::string>> declared;
    for (const auto& [at, text] : all("(const double|,) \\w+ = ", begin, end)) {
      std::smatch match;
      std::regex_search(text, match, std::regex("(\\w+) = $"));
      declared.emplace_back(at + text.size(), match[1]);
    }
    if (declared.size() < 2) return std::nullopt;
    const auto& [after, name] = declared[below(declared.size())];
    const std::size_t all_known = source_.find(';', after);
    std::vector<std::pair<std::size_t, std::string>> uses = all("\\b" + name + "\\b", all_known, end);
    std::erase_if(uses, [this](const auto& use) {  // in a comment
      const std::size_t open = source_.rfind("/*", use.first), close = source_.rfind("*/", use.first);
      return open != std::string::npos && (close == std::string::npos || close < open);
    });
    if (uses.empty()) return std::nullopt;
    const std::string& other = declared[below(declared.size())].second;
    const auto& [at, text] = uses[below(uses.size())];
    const auto known = std::find_if(declared.begin(), declared.end(), [&](const auto& d) { return d.second == other; });
    const std::size_t line = source_.rfind('\n', at);
    if (other == name || source_.find(';', known->first) > line) return std::nullopt;
    return Change{at, text.size(), other, "operand"};
  }

  std::string source_, name_;
  std::mt19937_64 engine_;
  std::vector<std::pair<std::size_t, std::size_t>> functions_;
};

struct Subject {
  std::unique_ptr<pipeline::DerivedModel> derived;
  program::Program program;
  emit::EmissionContext context;
  std::string name, source, header;
};

Subject subject(const std::string& model) {
  Subject s;
  s.derived = pipeline::derive_model(
      std::make_shared<const model::Model>(model::read_model(std::string(EOMGEN_TEST_MODELS) + "/" + model + ".toml")),
      pipeline::ApproachChoice::automatic);
  program::Request request;
  request.with = {"jac",
                  "jac_p",
                  "jac_u",
                  "jvp",
                  "vjp",
                  "adjoint",
                  "hvp",
                  "inverse",
                  "coriolis",
                  "gravity",
                  "mass",
                  "momenta",
                  "momenta_jac",
                  "momenta_jac_p",
                  "momenta_jac_u",
                  "constraints",
                  "reactions",
                  "events",
                  "energy_gradients",
                  "frames",
                  "regressor",
                  "momentum",
                  "reactions_jac",
                  "reactions_jac_p",
                  "reactions_jac_u",
                  "outputs_jac",
                  "outputs_jac_p",
                  "outputs_jac_u",
                  "taylor"};
  request.outputs = {"energy", "kinetic", "power"};
  for (const system::Output& output : s.derived->candidates.front().outputs) {
    if (output.name.find("position") != std::string::npos || output.name.find("velocity") != std::string::npos)
      request.outputs.push_back(output.name);
  }
  s.program = pipeline::make_program(*s.derived, request);
  const run::Scene scene =
      run::resolve_scene(s.derived->mechanics, s.derived->candidates.front(), s.derived->model.scene("default"), {});
  s.context = pipeline::emission_context(*s.derived, s.program, scene, {});
  s.name = emit::mangled_id(s.context.id);
  const std::vector<emit::EmittedFile> files = emit::emit(s.program, s.context, "c");
  s.source = files.at(0).text;
  s.header = files.at(1).text;
  return s;
}

/// The library with the original file (NAME_m) and all mutants (NAME_m0, NAME_m1, ..).
std::string library(const test::TemporaryFolder& folder, const Subject& s, const Mutator& mutator,
                    const std::vector<Change>& changes) {
  std::ofstream out(folder.path + "/" + s.name + ".c");
  out << mutator.changed({0, 0, "", ""}, s.name + "_m");
  for (std::size_t k = 0; k < changes.size(); ++k) out << mutator.changed(changes[k], fmt::format("{}_m{}", s.name, k));
  out.close();
  const std::string library = folder.path + "/" + s.name + ".so";
  const emit::ProcessResult finished = emit::run_process({EOMGEN_TEST_CC, "-std=c11", "-O0", "-w", "-fPIC", "-shared",
                                                          "-o", library, folder.path + "/" + s.name + ".c", "-lm"});
  INFO(finished.output);
  REQUIRE(finished.status == 0);
  return library;
}

/// Code without its self test, which is called separately.
std::optional<pipeline::CompiledCode> loaded(const std::string& library, const std::string& name, const Subject& s) {
  try {
    return pipeline::CompiledCode({emit::LoadedModel(library, name), library, false, 0}, s.program);
  } catch (const Error& error) {
    CAPTURE(error.message());
    REQUIRE(error.message().find("self test") != std::string::npos);
    return std::nullopt;
  }
}

/// Whether two codes differ at any of several states around the start, with random parameters, in every mode.
bool differ(const verify::CompiledForm& a, const verify::CompiledForm& b, const Subject& s) {
  std::mt19937_64 engine(7);
  const auto random = [&engine] { return cln::cl_RA(static_cast<long>(engine() % 2001) - 1000) / 1000; };
  const std::vector<eom::ContactShape> shapes(s.program.contacts.begin(), s.program.contacts.end());
  const std::vector<std::vector<int>> modes = eom::contact_modes(shapes, 12);
  for (std::size_t point = 0; point < 3 * modes.size(); ++point) {
    verify::AbiArguments at{
        numeric::exact(s.context.start_time) + random(), {}, {}, {}, modes[point % modes.size()], 4};
    for (const double x : s.context.start) at.x.push_back(numeric::exact(x) + random() / 2);
    for (const emit::Quantity& p : s.context.parameters)
      at.p.push_back(numeric::exact(p.value) * (1 + random() / 4) + (p.value == 0 ? random() : cln::cl_RA(0)));
    for (const emit::Quantity& u : s.context.inputs) at.u.push_back(numeric::exact(u.value) + random());
    for (std::size_t i = 0; i < 2 * at.x.size(); ++i) at.v.push_back(random() + 2);
    for (const std::string& function : program::abi_function_names(s.program)) {
      const auto of_a = a.call(function, at), of_b = b.call(function, at);
      if (of_a.has_value() != of_b.has_value()) return true;
      for (std::size_t r = 0; of_a && r < of_a->size(); ++r) {
        double largest = 0, off = 0;
        for (std::size_t i = 0; i < (*of_a)[r].size(); ++i) {
          const double u = (*of_a)[r][i], v = (*of_b)[r][i];
          if (!std::isfinite(u)) continue;
          largest = std::max(largest, std::fabs(u));
          off = std::isfinite(v) ? std::max(off, std::fabs(u - v)) : 1e300;
        }
        if (off > 1e-9 * largest) return true;
      }
    }
  }
  return false;
}

}  // namespace

TEST_CASE(
    "small changes to emitted code: at least 98 % of those that change a value are detected by the self test or by "
    "verify") {
  const test::TemporaryFolder folder;
  std::size_t changing = 0, by_self_test = 0, noticed = 0;
  std::string missed;
  for (const char* model : {"cart_pendulum", "P7_moving_sphere", "S5_double_pendulum_cartesian", "leaving_sphere",
                            "rough_incline_puck", "bilinear_oscillator", "R13_sleigh", "R11_constant_moment"}) {
    CAPTURE(model);
    const Subject s = subject(model);
    Mutator mutator(s.source, s.header, s.name, 11);
    const std::vector<Change> changes = mutator.changes(40);
    const std::string path = library(folder, s, mutator, changes);
    const auto original = loaded(path, s.name + "_m", s);
    REQUIRE(original);
    const verify::CompiledForm right = original->form();
    for (std::size_t k = 0; k < changes.size(); ++k) {
      const auto code = loaded(path, fmt::format("{}_m{}", s.name, k), s);
      if (!code) {
        ++changing, ++by_self_test, ++noticed;
        continue;
      }
      const verify::CompiledForm wrong = code->form();
      if (!differ(right, wrong, s)) continue;
      ++changing;
      pipeline::Verification verification{50, 5, 1, &wrong};
      for (const emit::Quantity& input : s.context.inputs) verification.default_inputs.push_back(input.value);
      if (!pipeline::certify(*s.derived, s.program, verification).pass) {
        ++noticed;
        continue;
      }
      missed +=
          fmt::format("\n{}: {} -> '{}' in{}", model, changes[k].what, changes[k].by, mutator.line_at(changes[k]));
    }
  }
  MESSAGE(fmt::format("{} changes, {} noticed, {} of them by the self test", changing, noticed, by_self_test));
  CAPTURE(missed);
  CHECK(changing > 200);
  CHECK(static_cast<double>(noticed) >= 0.98 * static_cast<double>(changing));
  CHECK(static_cast<double>(by_self_test) >= 0.95 * static_cast<double>(changing));
}
