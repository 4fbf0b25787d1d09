// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/code.hpp"
#include "cli/commands/commands.hpp"
#include "cli/output.hpp"
#include "cli/pipeline.hpp"
#include "cli/usage.hpp"

namespace eomgen::cli {
namespace {

using json = nlohmann::ordered_json;

struct Options {
  std::string model;
  int digits = 50;
  int points = 20;
  bool no_compile = false;
};

json to_json(const verify::Certificate& certificate) {
  json routes = json::array(), reasons = json::object();
  for (const verify::Comparison& c : certificate.comparisons) {
    routes.push_back({{"a", c.a}, {"b", c.b}, {"shares_code", c.shares_code},
                      {"max_relative_difference", c.max_relative_difference}, {"tolerance", c.tolerance},
                      {"digits_agreed", c.digits_agreed}, {"pass", c.pass}});
  }
  for (const auto& [reason, count] : certificate.rejected) reasons[reason] = count;
  return {{"format", 1}, {"routes", routes}, {"points", certificate.points}, {"digits", certificate.options.digits},
          {"rejected", certificate.rejections()}, {"rejected_reasons", reasons},
          {"summary", certificate.summary()}, {"verdict", certificate.verdict()}};
}

void print_readable(const verify::Certificate& certificate) {
  fmt::print("{:<28} {:<28} {:>12} {:>10}  {}\n", "this", "against", "difference", "tolerance", "");
  // What shares no code proves most, so it comes first.
  std::vector<verify::Comparison> rows = certificate.comparisons;
  std::stable_partition(rows.begin(), rows.end(), [](const verify::Comparison& c) { return !c.shares_code; });
  for (const verify::Comparison& c : rows) {
    fmt::print("{:<28} {:<28} {:>12.2e} {:>10.0e}  {}{}\n", c.a, c.b, c.max_relative_difference, c.tolerance,
               c.pass ? "agree" : "DISAGREE", c.shares_code ? " (they share code)" : "");
  }
  fmt::print("{} points at {} digits", certificate.points, certificate.options.digits);
  for (const auto& [reason, count] : certificate.rejected) fmt::print(", {} rejected: {}", count, reason);
  fmt::print("\n{}\n", certificate.summary());
}

int execute(const Options& options, const Common& common) {
  std::unique_ptr<Derived> derived = derive_model(options.model, ApproachChoice::automatic);
  const program::Program program = make_program(*derived, {});
  Verification verification{options.digits, static_cast<std::size_t>(options.points), common.seed, nullptr};
  verification.reductions = true;
  std::optional<CompiledCode> code;
  verify::CompiledForm compiled;
  if (!options.no_compile) {
    code.emplace(compile_for_check(*derived, program));
    compiled = code->form();
    verification.compiled = &compiled;
  }
  const verify::Certificate certificate = certify(*derived, program, verification);
  if (common.json) {
    print_document(to_json(certificate));
  } else {
    print_readable(certificate);
  }
  return certificate.pass ? 0 : 1;
}

}  // namespace

Execute declare_verify(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--digits", options->digits, "decimal digits of the arithmetic")->check(whole_number(20, 300))->capture_default_str();
  app.add_option("--points", options->points, "random states")->check(whole_number(1, 10000))->capture_default_str();
  app.add_flag("--no-compile", options->no_compile, "leave the emitted code out, which needs a C compiler");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
