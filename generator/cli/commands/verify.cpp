// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/stage_monitor.hpp"
#include "pipeline/limits.hpp"
#include "pipeline/verification.hpp"

namespace eomgen::cli::verify_command {
namespace {

struct Options {
  std::string model;
  int digits = 50;
  int points = 20;
  bool no_compile = false;
};

Json to_json(const verify::Certificate& certificate) {
  Json reasons = Json::object();
  for (const auto& [reason, count] : certificate.rejected) reasons[reason] = count;
  return {{"format", 1},
          {"formulations", list_of(certificate.comparisons,
                                   [](const verify::Comparison& c) {
                                     return EOMGEN_MEMBERS(c, a, b, shares_code, max_relative_difference, tolerance,
                                                           digits_agreed, pass);
                                   })},
          {"points", certificate.points},
          {"digits", certificate.options.digits},
          {"rejected", certificate.rejections()},
          {"rejected_reasons", reasons},
          {"summary", certificate.summary()},
          {"verdict", certificate.verdict()},
          {"left_out", cli::to_json(certificate.left_out)}};
}

void print_readable(const verify::Certificate& certificate) {
  fmt::print("{:<28} {:<28} {:>12} {:>10}  {}\n", "this", "against", "difference", "tolerance", "");
  // Comparisons without shared code are the strongest evidence, so they come first.
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

int show(const verify::Certificate& certificate, const CommonOptions& common) {
  const work::DeferInterrupt kept;
  if (common.json) {
    print_document(to_json(certificate));
  } else {
    print_readable(certificate);
  }
  if (certificate.interrupted) {
    print_interrupted(nullptr);
    return exit_interrupted;
  }
  return certificate.pass ? 0 : 1;
}

int execute(const Options& options, const CommonOptions& common) {
  const pipeline::VerificationRequest request{options.digits, static_cast<std::size_t>(options.points), common.seed,
                                              !options.no_compile};
  return show(pipeline::verify_model(load_model(options.model), request), common);
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  app.add_option("--digits", options->digits, "decimal digits of the arithmetic")
      .check(whole_number(limits::verification_digits.least, limits::verification_digits.most))
      .show_default();
  app.add_option("--points", options->points, "random states")
      .check(whole_number(limits::verification_points.least, limits::verification_points.most))
      .show_default();
  app.add_flag("--no-compile", options->no_compile, "leave the emitted code out, which needs a C compiler");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::verify_command
