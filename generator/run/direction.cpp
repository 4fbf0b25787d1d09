// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/direction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/segments.hpp>
#include <map>
#include <optional>

#include "derive/imposition.hpp"
#include "numeric/numbers.hpp"
#include "run/bind.hpp"
#include "run/central_differences.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::run {
namespace {

using mechanics::Mechanics;

// The first step is 1/64 to 1/32 of the value. A smaller one follows if the scene changes too much along it.
constexpr int first_step = -5, smaller_steps = -4, most_steps = 3;

[[noreturn]] void refuse(const std::string& what, const std::string& remedy) {
  throw Error("run", {}, "no derivatives of the end: " + what, remedy);
}

/// The scene with another value.
Scene scene_with(const ModelScene& of, const std::string& name, double value) {
  Overrides overrides = of.overrides;
  overrides.values[name] = numeric::exact(value);
  return resolve_scene(of.mechanics, of.system, of.asked, overrides);
}

std::vector<double> table_values(const Scene& scene) {
  std::vector<double> values;
  for (const Signal& input : scene.inputs) {
    const std::vector<double>& own = input.runtime_signal().values;
    values.insert(values.end(), own.begin(), own.end());
  }
  return values;
}

class DirectionFinder {
 public:
  DirectionFinder(const ModelScene& of, const std::string& name)
      : of_(of), direction_{name, 1, 0, {}, {}, {}, 0, 0, {}, {}, {}} {
    const std::optional<double> value = value_of(of.scene);
    if (!value)
      refuse(fmt::format("'{}' is no value of the start", name), "ask for a parameter, a coordinate or a state");
    value_ = *value;
    direction_.scale = value_ != 0 ? std::abs(value_) : 1;
  }

  Direction find() {
    is_start_ = is_start_value(*of_.mechanics.model, direction_.name);
    middle_ = is_start_ ? changed(0) : of_.scene;
    const std::vector<double> values = values_of(middle_);
    if (is_start_) require_same_start();
    direction_.step = std::ldexp(1.0, std::ilogb(direction_.scale) + first_step);
    for (int attempt = 1;; ++attempt, direction_.step = std::ldexp(direction_.step, smaller_steps)) {
      const std::string obstacle = differentiate(values, attempt == most_steps);
      if (obstacle.empty()) break;
      if (attempt == most_steps)
        refuse(fmt::format("{} with {}", obstacle, direction_.name), "compare runs with changed values (--set)");
    }
    find_input_derivatives();
    direction_.changed = [of = of_, name = direction_.name, value = value_](double offset) {
      return scene_with(of, name, value + offset);
    };
    return std::move(direction_);
  }

 private:
  /// The value itself, in a scene.
  std::optional<double> value_of(const Scene& scene) const {
    const model::Model& model = *of_.mechanics.model;
    if (const auto start = find_start(model, direction_.name))
      return (start->second == 0 ? scene.q : scene.qdot)[start->first];
    if (const auto state = find_state(model, direction_.name)) {
      const std::vector<symbolic::Symbol> symbols = of_.system.state_symbols();
      const auto place = std::find(symbols.begin(), symbols.end(), mechanics::state_symbol(model, *state));
      return scene.z[static_cast<std::size_t>(place - symbols.begin())];
    }
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      if (model.parameters[i].name == direction_.name) return scene.parameters[i];
    }
    return std::nullopt;
  }

  /// Parameters, the start, the span, times of kinks, values of tables.
  std::vector<double> values_of(const Scene& scene) const {
    std::vector<double> values = scene.parameters;
    for (const std::uint32_t i : of_.free) values.push_back(scene.q[i]);
    for (const std::uint32_t i : of_.free) values.push_back(scene.qdot[i]);
    values.insert(values.end(), scene.z.begin(), scene.z.end());
    values.insert(values.end(), {scene.t0, scene.t1});
    for (const auto& kink : kink_times(scene)) values.push_back(kink.before);
    const std::vector<double> tables = table_values(scene);
    values.insert(values.end(), tables.begin(), tables.end());
    return values;
  }

  /// Absolute errors of values_of(): Newton's method at the start leaves some units in the last place of the largest.
  std::vector<double> noise_of(const Scene& scene) const {
    constexpr double newton = 1e-13;
    std::vector<double> noise(scene.parameters.size(), 0.0);
    const auto add = [&](const std::vector<double>& list, std::size_t count) {
      double largest = 0;
      for (const double v : list) largest = std::max(largest, std::abs(v));
      noise.insert(noise.end(), count, std::max(newton * largest, scene.atol / 10));
    };
    add(scene.q, of_.free.size());
    add(scene.qdot, of_.free.size());
    add(scene.z, scene.z.size());
    const double time = newton * std::max(std::abs(scene.t0), std::abs(scene.t1));
    noise.insert(noise.end(), 2 + kink_times(scene).size(), time);
    noise.resize(noise.size() + table_values(scene).size());
    return noise;
  }

  Scene changed(double offset) const { return scene_with(of_, direction_.name, value_ + offset); }

  /// A start that is not given may have other consequences once it is.
  void require_same_start() const {
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::abs(a[i] - b[i]) > start_tolerance * std::max({1.0, std::abs(a[i]), std::abs(b[i])})) return false;
      }
      return true;
    };
    if (same(middle_.q, of_.scene.q) && same(middle_.qdot, of_.scene.qdot)) return;
    refuse(fmt::format("the start of {} follows from other values", direction_.name),
           "ask for one of those that it follows from");
  }

  /// Fills in the derivatives. Returns what prevents it, or "".
  std::string differentiate(const std::vector<double>& values, bool last) {
    direction_.beside.clear();
    std::vector<std::vector<double>> beside;
    for (const double offset : difference_offsets(direction_.step)) {
      try {
        direction_.beside.push_back(changed(offset));
      } catch (const Error& error) {
        if (!last) return "the scene does not follow a change";
        refuse_change(error);
      }
      beside.push_back(values_of(direction_.beside.back()));
      if (beside.back().size() != values.size() || direction_.beside.back().open != middle_.open)
        return "the kinks in time, the samples, or the contacts at the start, change";
    }
    const Slopes found = slopes(values, beside, direction_.step, noise_of(middle_));
    if (!found.smooth) return "the scene does not change smoothly";
    auto from = found.value.begin();
    const auto take = [&](std::size_t count) {
      const auto begin = from;
      from += static_cast<std::ptrdiff_t>(count);
      return std::vector<double>(begin, from);
    };
    direction_.dp = take(of_.scene.parameters.size());
    direction_.dx = take(of_.states);
    direction_.dt0 = *from++;
    direction_.dt1 = *from++;
    direction_.dt = take(kink_times(middle_).size());
    tables_ = take(table_values(middle_).size());
    return "";
  }

  [[noreturn]] void refuse_change(const Error& error) const {
    if (is_start_ && !of_.system.active.empty())
      refuse(fmt::format("constraints couple the initial values, so that {} alone cannot change: {}", direction_.name,
                         error.message()),
             "ask for parameters, and write the start by them");
    refuse(fmt::format("the scene does not follow a change of {}: {}", direction_.name, error.message()),
           "write the start by " + direction_.name + ", or leave values to the constraints");
  }

  void find_input_derivatives() {
    Mechanics& m = of_.mechanics;
    symbolic::Substitution written = derive::time_function_substitution(m);
    std::size_t entry = 0;
    bool any = false;
    for (std::uint32_t i = 0; i < m.model->inputs.size(); ++i) {
      const eom::hybrid::Signal& own = middle_.inputs[i].runtime_signal();
      if (!own.times.empty()) {
        const auto begin = tables_.begin() + static_cast<std::ptrdiff_t>(entry);
        entry += own.values.size();
        std::vector<double> values(begin, begin + static_cast<std::ptrdiff_t>(own.values.size()));
        any = any || std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
        direction_.du.emplace_back(own.times, std::move(values), own.linear);
        continue;
      }
      const Ref derivative = input_derivative(written(mechanics::lower_scalar(m, signal_of(i))));
      any = any || !m.dag->is_zero(derivative);
      direction_.du.emplace_back(*m.dag, derivative, middle_.parameters);
    }
    if (!any) direction_.du.clear();
  }

  model::NodeId signal_of(std::uint32_t input) const {
    for (const model::SceneInput& given : of_.asked.inputs) {
      if (given.input == input) return std::get<model::NodeId>(given.signal);
    }
    return of_.mechanics.model->inputs[input].default_value;
  }

  /// The sum of du/dp dp.
  Ref input_derivative(Ref signal) const {
    symbolic::Dag& dag = *of_.mechanics.dag;
    std::map<symbolic::Symbol, Ref> seeds;
    for (std::uint32_t k = 0; k < direction_.dp.size(); ++k) {
      if (direction_.dp[k] != 0) seeds[{SymbolKind::parameter, k, 0}] = dag.constant(numeric::exact(direction_.dp[k]));
    }
    return symbolic::Derivation(dag, std::move(seeds))(signal);
  }

  const ModelScene& of_;
  Direction direction_;
  double value_ = 0;
  bool is_start_ = false;
  Scene middle_;                // the scene of the run
  std::vector<double> tables_;  // derivatives of the values of tables
};

}  // namespace

Direction find_direction(const ModelScene& of, const std::string& name) { return DirectionFinder(of, name).find(); }

std::vector<eom::hybrid::Breakpoint> kink_times(const Scene& scene) {
  eom::hybrid::Problem problem;
  problem.t0 = scene.t0;
  problem.t1 = scene.t1;
  problem.inputs = input_signals(scene);
  problem.breakpoints = scene.clock.breakpoints;
  for (const auto& [every, offset] : scene.samples) problem.samples.push_back({{}, every, offset, {}, {}});
  std::vector<eom::hybrid::Breakpoint> times;
  for (const eom::hybrid::Segment& segment : eom::hybrid::segments(problem))
    times.push_back({segment.end, segment.next});
  times.pop_back();
  return times;
}

}  // namespace eomgen::run
