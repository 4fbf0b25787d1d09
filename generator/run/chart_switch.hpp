// SPDX-License-Identifier: GPL-3.0-or-later
// The charts that one integration is in. In: the state at the end of each step. Out: when and how it goes to second
// charts and back, and the state in the own charts, angles continuous, for whoever reports it (docs/runtime.md,
// "Charts").
#pragma once

#include "run/runner.hpp"

namespace eomgen::run {

class ChartSwitch {
 public:
  explicit ChartSwitch(const RunRequest& request);

  bool any() const { return !request_.charts.empty(); }
  unsigned second() const { return in_; }  // a bit per chart: which are second ones
  int mode() const;                        // bits of `mode`
  const Code& code() const { return *code_; }

  /// The state of a start, in the own charts; whether it is to be exchanged there.
  bool start(double t, const double* x);
  /// 2 where the state is so near to where its chart fails that it must not be asked: a step that gets there is made
  /// shorter.
  int admits(const double* x) const;
  /// An accepted step, the first to be told of it; true: the state is to be exchanged at its end.
  bool follow(const eom::StepView& step);
  /// Exchanges what is due; whose charts these are.
  std::vector<std::string> exchange(double t, std::span<double> x);

  /// A state of the last step in the own charts. What has no value exactly where they fail is not a number.
  void own(double t, const double* x, std::span<double> own) const;
  /// Whether a coordinate of the model has another meaning at present.
  bool has_exchanged(std::uint32_t coordinate) const;
  /// Outputs that the code does not give at present.
  const std::vector<std::uint32_t>& own_outputs() const;

 private:
  struct Sample {
    double t;
    std::vector<double> x;  // in the own charts
  };
  bool is_second(std::size_t j) const { return (in_ >> j & 1) != 0; }
  void guard(const double* x);
  unsigned wanted(const double* x, const double* own) const;
  void sample(const eom::StepView& step, double until, const double* x, int depth);
  void made_continuous(std::size_t j, const std::vector<double>& near, std::span<double> own) const;

  const RunRequest& request_;
  const Code* code_;
  std::size_t n_;
  unsigned in_ = 0, due_ = 0;
  std::vector<double> floor_;    // per chart: the zero of its sine or cosine below the guarded angle
  std::vector<double> side_;     // 1, -1: the sign of the own sine or cosine where the own chart was left
  std::vector<Sample> samples_;  // along the last step, while some chart is a second one
};

}  // namespace eomgen::run
