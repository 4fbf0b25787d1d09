// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/validation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "error.hpp"
#include "pipeline/estimate_cost.hpp"
#include "pipeline/limits.hpp"
#include "pipeline/row_count.hpp"

namespace eomgen {
namespace {

constexpr double most_bytes = 4e9;  // of rows in memory

/// Refuses values of options. Their names are the same in every language.
struct OptionValidator {
  void require(bool holds, const char* name, double value, const char* what) const {
    if (holds) return;
    throw Error("library", {}, fmt::format("the option {} is {}", name, value), fmt::format("give {}", what));
  }
  void finite(const char* name, const std::optional<double>& value) const {
    if (value) require(std::isfinite(*value), name, *value, "a finite number");
  }
  void nonnegative(const char* name, const std::optional<double>& value) const {
    if (value) require(std::isfinite(*value) && *value >= 0, name, *value, "a finite number, 0 or greater");
  }
  void positive(const char* name, const std::optional<double>& value) const {
    if (value) require(std::isfinite(*value) && *value > 0, name, *value, "a finite number greater than 0");
  }
  void count(const char* name, std::size_t value, const limits::CountRange& range) const {
    if (value >= range.least && value <= range.most) return;
    throw Error("library", {}, fmt::format("the option {} is {}", name, value),
                fmt::format("give a whole number from {} to {}", range.least, range.most));
  }
  /// 0 stands for the default.
  void optional_count(const char* name, std::size_t value, const limits::CountRange& range) const {
    if (value != 0) count(name, value, range);
  }

  template <class Options>
  void tolerances(const Options& o) const {
    nonnegative("rtol", o.rtol);
    nonnegative("atol", o.atol);
  }
};

}  // namespace

void require_valid(const RunOptions& o) {
  const OptionValidator is{};
  is.finite("t_end", o.t_end);
  is.tolerances(o);
  is.positive("step", o.step);
  is.positive("max_step", o.max_step);
  is.positive("every", o.every);
  is.optional_count("max_steps", o.max_steps, limits::run_steps);
  pipeline::parse_estimate_cost(o.estimate, !o.error_estimate);
}

void require_valid(const InverseOptions& o) {
  const OptionValidator is{};
  is.finite("t_end", o.t_end);
  is.tolerances(o);
  is.positive("every", o.every);
}

void require_valid(const SimulationOptions& o) {
  const OptionValidator is{};
  is.tolerances(o);
  is.positive("step", o.step);
  is.positive("max_step", o.max_step);
  is.positive("every", o.every);
  is.optional_count("max_steps", o.max_steps, limits::run_steps);
}

void require_valid(const LineariseOptions& o) { OptionValidator{}.finite("time", o.time); }

void require_valid(const SteadyOptions& o) { OptionValidator{}.count("starts", o.starts, limits::search_starts); }

void require_valid(const BenchmarkOptions& o) {
  const OptionValidator is{};
  is.finite("t_end", o.t_end);
  is.positive("max_seconds", o.max_seconds);
}

void require_valid(const StressOptions& o) {
  const OptionValidator is{};
  is.finite("t_end", o.t_end);
  is.positive("max_seconds", o.max_seconds);
  is.count("max_steps", o.max_steps, limits::stress_steps);
}

void require_valid(const VerifyOptions& o) {
  const OptionValidator is{};
  const limits::CountRange range = limits::verification_digits;
  is.require(
      o.digits >= 0 && static_cast<unsigned>(o.digits) >= range.least && static_cast<unsigned>(o.digits) <= range.most,
      "digits", o.digits, "a whole number from 20 to 300");
  is.count("points", o.points, limits::verification_points);
}

void require_rows(double t0, double t1, double every, std::size_t columns, bool stored, const char* option) {
  pipeline::require_distinct_rows(t0, t1, every, fmt::format("give {} a longer interval", option));
  const double rows = pipeline::expected_rows(t0, t1, every);
  const double bytes = rows * static_cast<double>(columns + 1) * sizeof(double);
  if (!stored || (rows <= pipeline::most_rows && bytes <= most_bytes)) return;
  throw Error("library", {}, fmt::format("an interval of {} s makes {:.3g} rows of {} values", every, rows, columns),
              fmt::format("give {} a longer interval, or take the rows one by one with `row`", option));
}

}  // namespace eomgen
