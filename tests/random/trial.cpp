// SPDX-License-Identifier: GPL-3.0-or-later
#include "random/trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/process.hpp"

namespace eomgen::random_models {
namespace {

using test::ChildResult;
using Json = nlohmann::json;

// Messages with which `check` or the start of `run` may reject a model: it is not a valid mechanism, or has no valid
// start. Any other message is a finding.
const std::vector<std::string>& refusals() {
  static const std::vector<std::string> texts{
      "nothing is left to integrate",  // locked
      "more constraints than",         // a loop that cannot be closed
      "contradict",                    // contradictory constraints
      "follows from",                  // a redundant constraint
      "the start breaks constraint",   // an assembly that cannot be closed from its guess
      "outside its range",             // an assembly that closes only beyond a chart
      "cannot be satisfied",
      "has no mass",  // a coordinate without inertia
      "no inertia",
      "changes no equation of motion",  // a force that does no work: friction at a pivot
      "contains no coordinate",         // a constant distance of two bodies
      "does not determine the force",   // of a contact whose constraint is redundant
      "fixes nothing",                  // a joint on a place with prescribed motion
      "contains no velocity",           // a knife edge along an arm: its point never moves in this direction
      "does not depend on any velocity",
      "the start is a singular configuration",  // of angles that the assembly determines
      "the forces are not determined",          // more directions of sticking friction than degrees of freedom
  };
  return texts;
}

// Outcomes with which a run may end early because of the mechanism itself.
const std::vector<std::string>& outcomes() {
  static const std::vector<std::string> names{"chart_left", "singular_mass_matrix", "step_too_small",
                                              "friction_no_solution", "friction_many_solutions"};
  return names;
}

// The power balance of a run at rtol 1e-9 over 0.3 s; constraints are projected to rounding.
constexpr double balance_tolerance = 1e-7, constraint_tolerance = 1e-8;
// Central differences of steps 1e-4 and 2.5e-5 that differ by less have an error of about that.
constexpr double difference_tolerance = 1e-5;

bool among(const std::string& text, const std::vector<std::string>& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return text.find(part) != std::string::npos; });
}

std::string message(const ChildResult& result) {
  std::istringstream lines(result.err);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("error") != std::string::npos) return line;
  }
  // A certificate lists the disagreements.
  const Json document = Json::parse(result.out, nullptr, false);
  if (!document.is_discarded() && document.contains("summary")) return document["summary"].get<std::string>();
  return result.in_time ? "no message" : "out of time";
}

/// Whether the constraints hold a rate at zero, whose sign is then not determined.
bool is_sign_of_zero(const std::string& said, const std::string& text) {
  static const std::string at = "too near the kink of line ";
  const std::size_t found = said.find(at);
  if (found == std::string::npos) return false;
  std::istringstream lines(text);
  std::string line;
  for (int k = std::atoi(said.c_str() + found + at.size()); k > 0 && std::getline(lines, line);) --k;
  return line.find("sign(q") != std::string::npos;
}

class Attempt {
 public:
  Attempt(const std::string& program, const std::string& folder, const Limits& limits)
      : program_(program), folder_(folder), limits_(limits) {}

  Trial operator()(const std::string& text) {
    std::ofstream(folder_ + "/m.toml", std::ios::binary) << text;
    text_ = text;
    if (!command("check", {}) || limits_.only_checked) return trial_;
    command("derive", {"--show", "all"});
    command("verify", {"--no-compile", "--points", "3"});
    if (!limits_.moved) return trial_;
    if (command("run", {})) {
      inspect_run();
      inspect_sensitivity();
    }
    command("linearize", {});
    return trial_;
  }

 private:
  // Whether the command succeeded. A shell sets the limits, so that they end with the command.
  bool command(const std::string& name, const std::vector<std::string>& options) {
    test::ChildCommand call;
    const std::string memory =
        limits_.megabytes > 0 ? "ulimit -v " + std::to_string(limits_.megabytes * 1024L) + "; " : "";
    call.arguments = {
        "/bin/sh", "-c",     "ulimit -t " + std::to_string(limits_.seconds) + "; " + memory + "exec \"$@\"",
        "sh",      program_, name,
        "m.toml",  "--json"};
    call.arguments.insert(call.arguments.end(), options.begin(), options.end());
    call.folder = folder_;
    call.limit = 30.0 * limits_.seconds;  // wall clock time, for a busy machine
    result_ = test::run_child(call);
    trial_.slowest = std::max(trial_.slowest, result_.seconds);
    if (result_.status == 0) return true;
    const std::string said = message(result_);
    if (result_.status == 2 && (name != "derive") && among(said, refusals())) {
      trial_.refusal = said;
      std::erase_if(trial_.findings, [](const Finding& finding) {  // `verify` of what has no start finds no states
        return finding.what.find("no states were found") != std::string::npos;
      });
    } else if (result_.status == 1 && is_sign_of_zero(said, text_)) {
      trial_.refusal = said;
    } else if (result_.status == 3 && name == "run" && reported_outcome()) {
      return false;
    } else if (result_.status == 2 && name == "linearize" && said.find("internal") == std::string::npos) {
      return false;  // a state without derivative, a start on a kink: reported
    } else {
      trial_.findings.push_back({name, "exit code " + std::to_string(result_.status) + ": " + said});
    }
    return false;
  }

  bool reported_outcome() const {
    const Json document = Json::parse(result_.out, nullptr, false);
    return !document.is_discarded() && document.contains("outcome") &&
           among(document["outcome"].get<std::string>(), outcomes());
  }

  void inspect_run() {
    const Json document = Json::parse(result_.out, nullptr, false);
    if (document.is_discarded()) {
      trial_.findings.push_back({"run", "its JSON document cannot be read"});
      return;
    }
    const auto number = [&](const char* key) {
      return document.contains(key) && document[key].is_number() ? document[key].get<double>() : 0.0;
    };
    if (number("power_balance") > balance_tolerance)
      trial_.findings.push_back({"run", "power balance open: " + std::to_string(number("power_balance"))});
    if (number("constraint_drift") > constraint_tolerance)
      trial_.findings.push_back({"run", "constraints drift: " + std::to_string(number("constraint_drift"))});
  }

  /// The JSON document of a run at tight tolerances; null where it is not done.
  Json tight_run(std::vector<std::string> options) {
    options.insert(options.end(), {"--rtol", "1e-12", "--atol", "1e-13", "--no-error-estimate"});
    if (!command("run", options)) return nullptr;
    const Json document = Json::parse(result_.out, nullptr, false);
    return document.is_discarded() || document.value("outcome", "") != "done" ? Json() : document;
  }

  /// The derivatives of the end by the first parameter, against differences of runs. A refusal by name is no finding.
  void inspect_sensitivity() {
    const std::string key = "\np1 = ";
    const std::size_t at = text_.find(key);
    if (at == std::string::npos) return;
    const double p = std::strtod(text_.c_str() + at + key.size(), nullptr);
    const std::size_t before = trial_.findings.size();
    const Json found = tight_run({"--sensitivity", "p1"});
    if (result_.status == 2 && result_.err.find("internal") == std::string::npos) trial_.findings.resize(before);
    if (found.is_null() || found["sensitivities"]["outcome"] != "done") return;
    const auto ends = [&](double h) {
      std::ostringstream number;
      number.precision(17);
      number << "p1=" << p + h;
      return tight_run({"--set", number.str()});
    };
    const double h = 1e-4;
    const Json a = ends(h), b = ends(-h), c = ends(h / 4), d = ends(-h / 4);
    for (const Json* run : {&a, &b, &c, &d}) {
      if (run->is_null() || (*run)["events"].size() != found["events"].size()) return;
    }
    for (const auto& [name, value] : found["sensitivities"]["values"]["p1"].items()) {
      if (!value.is_number() || !a["final"].contains(name)) continue;
      const auto slope = [&](const Json& up, const Json& down, double step) {
        return (up["final"][name].get<double>() - down["final"][name].get<double>()) / (2 * step);
      };
      const double wide = slope(a, b, h), narrow = slope(c, d, h / 4), scale = 1 + std::abs(narrow);
      if (std::abs(wide - narrow) > difference_tolerance * scale) continue;  // not smooth, or rounding
      if (std::abs(value.get<double>() - narrow) > 10 * difference_tolerance * scale)
        trial_.findings.push_back({"run", "sensitivity of " + name + ": " + std::to_string(value.get<double>()) +
                                              ", by differences " + std::to_string(narrow)});
    }
  }

  std::string program_, folder_, text_;
  Limits limits_;
  Trial trial_;
  ChildResult result_;
};

// The sections of a text, each from its heading to the next.
std::vector<std::string> sections(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (result.empty() || line.starts_with("[")) result.emplace_back();
    result.back() += line + "\n";
  }
  return result;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += part;
  return text;
}

// The command and the first words of the message, without names and numbers.
std::string signature(const Trial& trial) {
  if (trial.findings.empty()) return "";
  std::string text = trial.findings.front().command + ": ";
  for (const char c : trial.findings.front().what) {
    if (c < '0' || c > '9') text += c;
  }
  return text.substr(0, 60);
}

}  // namespace

Trial try_model(const std::string& program, const std::string& folder, const std::string& text, const Limits& limits) {
  return Attempt(program, folder, limits)(text);
}

std::string shrink(const std::string& program, const std::string& folder, std::string text, Limits limits) {
  const Trial whole = try_model(program, folder, text, limits);
  const std::string wanted = signature(whole);
  if (wanted.empty()) return text;
  limits.moved = whole.findings.front().command == "run" || whole.findings.front().command == "linearize";
  for (bool smaller = true; smaller;) {
    smaller = false;
    const std::vector<std::string> parts = sections(text);
    for (std::size_t i = 1; i < parts.size(); ++i) {
      std::vector<std::string> fewer = parts;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      const std::string candidate = joined(fewer);
      if (signature(try_model(program, folder, candidate, limits)) != wanted) continue;
      text = candidate;
      smaller = true;
      break;
    }
  }
  return text;
}

}  // namespace eomgen::random_models
