// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria where the angles or spherical coordinates of a model are singular: the same search with the second chart,
// from a start at rest. In: the search in the charts of the model. Out: the points at which these are singular.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/steady_search.hpp"
#include "derive/imposition.hpp"
#include "pipeline/charts.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {
namespace {

using linear::Precise;
using symbolic::Symbol;
using symbolic::SymbolKind;
using symbolic::Vec3;

constexpr std::size_t fewest_starts = 20, most_starts = 100;          // per chart; of all charts
const symbolic::Rational regular_angle = symbolic::Rational(7) / 10;  // far from 0 and a quarter turn

/// Why there is no start at rest with the same values of the held quantities; empty if there is one.
std::string why_not_at_rest(const SteadyMotions& found, const SteadyRequest& request) {
  constexpr double nothing = 1e-12;
  if (!request.hold.empty()) return "quantities are held";
  for (const HeldValue& held : found.held) {
    if (std::abs(held.value) > nothing) return fmt::format("{} is held at {:.6g}", held.name, held.value);
  }
  return "";
}

/// Whether the own chart is singular at a state of the model in the second chart: its axes E_i and e_k are parallel, or
/// the place is on the axis E3 of its spherical coordinates.
bool is_singular(const SteadyProblem& p, const model::ChartPair& chart, const linear::State<Precise>& z) {
  constexpr double nearest = 1e-6;
  mechanics::Mechanics& m = p.derived->mechanics;
  symbolic::Dag& dag = *m.dag;
  std::vector<symbolic::Ref> roots;
  if (chart.kind == model::ChartPair::Kind::rotation) {
    const model::Frame& frame = m.model->frames[chart.index];
    const auto axis = [&](std::uint32_t of, std::size_t k) {
      if (of > 0) return mechanics::lower_vector(m, m.model->frames[of].stages.back().e[k]);
      Vec3 fixed{dag.zero(), dag.zero(), dag.zero()};
      fixed[k] = dag.integer(1);
      return fixed;
    };
    const Vec3 across = symbolic::cross(dag, axis(frame.parent, chart.axes[0]), axis(chart.index, chart.axes[2]));
    roots = {across[0], across[1], across[2]};
  } else {
    const Vec3 r =
        symbolic::subtract(dag, *m.place_position[chart.index], *m.place_position[m.model->places[chart.index].from]);
    roots = {r[0], r[1], r[2]};
  }
  symbolic::Substitution imposed = derive::constraint_substitution(m), written = derive::time_function_substitution(m);
  for (symbolic::Ref& root : roots) root = written(imposed(root));
  const std::vector<std::uint32_t>& free = p.system().free;
  const std::vector<double> v = symbolic::evaluate(dag, roots, [&](const Symbol& symbol) -> double {
    if (symbol.kind == SymbolKind::parameter) return p.scene.parameters[symbol.index];
    if (symbol.kind == SymbolKind::time) return p.t;
    const auto place = static_cast<std::size_t>(std::find(free.begin(), free.end(), symbol.index) - free.begin());
    if (symbol.kind != SymbolKind::coordinate || symbol.order > 0 || place == free.size()) return std::nan("");
    return linear::to_double(z[place]);
  });
  const double across = std::hypot(v[0], v[1]);
  return chart.kind == model::ChartPair::Kind::rotation ? std::hypot(across, v[2]) <= nearest
                                                        : across <= nearest * std::hypot(across, v[2]);
}

/// The start at rest, with regular angles of the second chart.
run::Overrides at_rest(const SteadyMotions& found, const model::ChartPair& chart, run::Overrides overrides) {
  const model::Model& model = found.problem.derived->model;
  for (const std::uint32_t angle : chart.angles) overrides.values[model.coordinates[angle].name] = regular_angle;
  for (const std::uint32_t i : found.problem.system().free) overrides.values[model.coordinates[i].name + "_dot"] = 0;
  return overrides;
}

}  // namespace

std::vector<SecondChartSearch> search_second_charts(const SteadyMotions& found, const SteadyRequest& request) {
  const model::Model& model = found.problem.derived->model;
  const std::vector<model::ChartPair> all = pipeline::list_charts(found.problem.derived->mechanics),
                                      exchangeable = pipeline::exchangeable_charts(all);
  std::vector<SecondChartSearch> result;
  unsigned bit = 1;
  for (const model::ChartPair& chart : all) {
    SecondChartSearch search{chart, {}, chart.refusal, {}};
    search.where = chart.angles.empty() ? "its coordinates are singular" : chart.singularity(model) + " = 0";
    const unsigned mask = chart.refusal.empty() ? std::exchange(bit, bit << 1) : 0;
    if (search.skip_reason.empty()) search.skip_reason = why_not_at_rest(found, request);
    if (search.skip_reason.empty()) {
      SteadyRequest second = request;
      second.model = std::make_shared<const model::Model>(model::in_second_charts(*request.model, exchangeable, mask));
      second.overrides = at_rest(found, chart, request.overrides);
      second.second_charts = false;
      second.starts = std::min(request.starts, std::max(fewest_starts, most_starts / exchangeable.size()));
      try {
        auto motions = std::make_shared<SteadyMotions>(steady_motions(second));
        std::erase_if(motions->points, [&](const SteadyMotion& motion) {
          return motion.l.kind != linear::MotionKind::equilibrium || !is_singular(motions->problem, chart, motion.l.z);
        });
        search.found = std::move(motions);
      } catch (const Error& error) {
        if (error.fault() == ErrorKind::check) throw;
        search.skip_reason = error.message();
      }
    }
    result.push_back(std::move(search));
  }
  return result;
}

}  // namespace eomgen::analysis
