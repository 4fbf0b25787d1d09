// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/code.hpp"
#include "cli/commands/commands.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/pipeline.hpp"
#include "cli/usage.hpp"
#include "cli/watch.hpp"

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
  json routes = json::array(), reasons = json::object(), left_out = json::array();
  for (const work::LeftOut& l : certificate.left_out) left_out.push_back({{"what", l.what}, {"why", l.why}});
  for (const verify::Comparison& c : certificate.comparisons) {
    routes.push_back({{"a", c.a},
                      {"b", c.b},
                      {"shares_code", c.shares_code},
                      {"max_relative_difference", c.max_relative_difference},
                      {"tolerance", c.tolerance},
                      {"digits_agreed", c.digits_agreed},
                      {"pass", c.pass}});
  }
  for (const auto& [reason, count] : certificate.rejected) reasons[reason] = count;
  return {{"format", 1},
          {"routes", routes},
          {"points", certificate.points},
          {"digits", certificate.options.digits},
          {"rejected", certificate.rejections()},
          {"rejected_reasons", reasons},
          {"summary", certificate.summary()},
          {"verdict", certificate.verdict()},
          {"left_out", left_out}};
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
  for (const work::LeftOut& l : certificate.left_out) fmt::print("{:<28} left out: {}\n", l.what, l.why);
  fmt::print("{} points at {} digits", certificate.points, certificate.options.digits);
  for (const auto& [reason, count] : certificate.rejected) fmt::print(", {} rejected: {}", count, reason);
  fmt::print("\n{}\n", certificate.summary());
}

/// Every function that `emit` may be asked for, but for Taylor series where the program is too large for them.
program::Program with_every_function(Derived& derived) {
  program::Request request;
  request.with = {"jac", "jac_p", "mass", "momenta", "constraints", "reactions", "events", "taylor"};
  for (const system::Output& output : derived.candidates.front().outputs) request.outputs.push_back(output.name);
  try {
    return make_program(derived, request);
  } catch (const Error&) {
    request.with.pop_back();
    return make_program(derived, request);
  }
}

/// Where the constraints fix the whole motion there is nothing to integrate and no code: the routes and the reading
/// forms are held against the judge, their constraint forces above all.
std::optional<verify::Certificate> certify_prescribed(const Options& options, std::uint64_t seed) {
  const model::Model model = load_model(options.model);
  std::size_t equations = 0;
  for (const model::Constraint& constraint : model.constraints) equations += constraint.psi.size();
  if (equations < model.coordinates.size()) return std::nullopt;
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  if (mechanics.freedom() > 0) return std::nullopt;
  verify::Subjects subjects;
  subjects.systems = verify::all_routes(mechanics, &subjects.left_out);
  add_reading_forms(mechanics, subjects);
  return verify::certify(mechanics, subjects, {options.digits, static_cast<std::size_t>(options.points), seed, {}});
}

int show(const verify::Certificate& certificate, const Common& common) {
  const work::Kept kept;
  if (common.json) {
    print_document(to_json(certificate));
  } else {
    print_readable(certificate);
  }
  if (certificate.interrupted) {
    tell_interrupted(nullptr);
    return exit_interrupted;
  }
  return certificate.pass ? 0 : 1;
}

int execute(const Options& options, const Common& common) {
  if (const auto prescribed = certify_prescribed(options, common.seed)) return show(*prescribed, common);
  std::unique_ptr<Derived> derived = derive_model(options.model, ApproachChoice::automatic);
  const program::Program program = with_every_function(*derived);
  Verification verification{options.digits, static_cast<std::size_t>(options.points), common.seed, nullptr};
  verification.reductions = true;
  verification.partial = true;
  verification.keep = false;
  std::optional<CompiledCode> code;
  verify::CompiledForm compiled;
  if (!options.no_compile) {
    code.emplace(compile_for_check(*derived, program));
    compiled = code->form();
    verification.compiled = &compiled;
    verification.default_inputs = default_inputs(*derived);
  }
  return show(certify(*derived, program, verification), common);
}

}  // namespace

Execute declare_verify(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--digits", options->digits, "decimal digits of the arithmetic")
      ->check(whole_number(20, 300))
      ->capture_default_str();
  app.add_option("--points", options->points, "random states")->check(whole_number(1, 10000))->capture_default_str();
  app.add_flag("--no-compile", options->no_compile, "leave the emitted code out, which needs a C compiler");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
