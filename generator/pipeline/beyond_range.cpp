// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/beyond_range.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "derive/formulations/lagrange.hpp"
#include "error.hpp"
#include "numeric/dense.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::pipeline {
namespace {

using symbolic::Symbol;
using symbolic::SymbolKind;

constexpr double agree = 1e-8;      // of accelerations and energies
constexpr double singular = 1e-10;  // smallest relative pivot of the linear system

/// Whether the range comes from the coordinate system, not from the user.
bool of_system(const model::Model& model, std::uint32_t coordinate) {
  const model::NodeId lower = model.coordinates[coordinate].lower;
  if (lower == model::no_node || model.coordinates[coordinate].upper != model::no_node) return false;
  const model::Span& stated = model.arena[lower].span;
  for (const model::Place& place : model.places) {
    if (!place.chart) continue;
    for (const model::NodeId entry : place.chart->entries) {
      if (entry == model::no_node) continue;
      // The range has the file position of the entry, whose name begins after the quotation mark.
      const model::Node& node = model.arena[entry];
      const bool itself = node.op == model::Op::coordinate && node.index == coordinate;
      if (itself && node.span.line == stated.line && node.span.column >= stated.column &&
          node.span.column <= stated.column + 1 && stated.line > 0)
        return true;
    }
  }
  return false;
}

Eigen::VectorXd numbers(const std::vector<double>& values, std::size_t from, std::size_t count) {
  return Eigen::Map<const Eigen::VectorXd>(values.data() + from, static_cast<Eigen::Index>(count));
}

/// Accelerations, kinetic and potential energy; empty if they are not determined.
std::optional<Eigen::VectorXd> motion(const system::EquationSystem& s, const run::Scene& scene, double t,
                                      std::span<const double> x) {
  const std::size_t n = s.free.size(), m = s.active.size();
  std::vector<symbolic::Ref> roots;
  for (const auto* list : {&s.M, &s.f, &s.A, &s.gamma}) roots.insert(roots.end(), list->begin(), list->end());
  roots.insert(roots.end(), {s.kinetic, s.potential});
  const std::vector<double> v = symbolic::evaluate(*s.dag, roots, [&](const Symbol& symbol) {
    if (symbol.kind == SymbolKind::parameter) return scene.parameters[symbol.index];
    if (symbol.kind == SymbolKind::time) return t;
    if (symbol.kind == SymbolKind::input) return scene.inputs[symbol.index](t, t);
    const auto place = std::find(s.free.begin(), s.free.end(), symbol.index);
    if (symbol.kind != SymbolKind::coordinate || place == s.free.end() || symbol.order > 1) return std::nan("");
    return x[symbol.order * n + static_cast<std::size_t>(place - s.free.begin())];
  });
  if (!std::all_of(v.begin(), v.end(), [](double value) { return std::isfinite(value); })) return std::nullopt;
  const auto N = static_cast<Eigen::Index>(n), M = static_cast<Eigen::Index>(m);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(N + M, N + M);
  all.topLeftCorner(N, N) = Eigen::Map<const RowMajor>(v.data(), N, N);
  const Eigen::MatrixXd A = Eigen::Map<const RowMajor>(v.data() + n * n + n, M, N);
  all.topRightCorner(N, M) = -A.transpose();
  all.bottomLeftCorner(M, N) = A;
  Eigen::VectorXd right(N + M);
  right << numbers(v, n * n, n), -numbers(v, n * n + n + m * n, m);
  const std::optional<Eigen::VectorXd> found = numeric::solve(all, right, singular);
  if (!found) return std::nullopt;
  Eigen::VectorXd result(N + 2);
  result << found->head(N), v[v.size() - 2], v.back();
  return result;
}

/// Whether the accelerations and energies of `own` equal those of equations derived without the range, on both sides.
template <class Own>
bool holds_beyond(const DerivedModel& derived, const run::Scene& scene, const std::vector<std::uint32_t>& own_free,
                  std::uint32_t coordinate, double t, std::span<const double> x, const Own& own) {
  if (!of_system(derived.model, coordinate)) return false;
  const auto place = std::find(own_free.begin(), own_free.end(), coordinate);
  if (place == own_free.end()) return false;
  model::Model free = derived.model;
  free.coordinates[coordinate].lower = model::no_node;
  try {
    mechanics::Mechanics mechanics = mechanics::build_mechanics(free);
    const system::EquationSystem system = derive::lagrange(mechanics, system::Approach::two);
    if (system.free != own_free) return false;
    std::vector<double> state(x.begin(), x.end());
    const double size = std::max(1.0, std::abs(scene.q[coordinate]));
    for (const double part : {0.3, 0.0, -1e-3, -0.2, -0.7}) {
      state[static_cast<std::size_t>(place - own_free.begin())] = scene.lower[coordinate] + part * size;
      const std::optional<Eigen::VectorXd> expected = motion(system, scene, t, state);
      const std::optional<Eigen::VectorXd> found = expected ? own(t, state) : std::nullopt;
      if (!found || !((*found - *expected).cwiseAbs().maxCoeff() <= agree * (1 + expected->cwiseAbs().maxCoeff())))
        return false;
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

bool equations_hold_beyond_range(const DerivedModel& derived, const run::Scene& scene, const run::Code& code,
                                 std::uint32_t coordinate, double t, std::span<const double> x) {
  if (!code.contacts.empty() || !code.contact_set.empty() || code.layout().others() > 0) return false;
  const std::size_t n = code.free.size();
  std::vector<double> dx(x.size()), y(code.output_names.size()), u;
  for (const run::Signal& input : scene.inputs) u.push_back(input(t, t));
  u.resize(std::max<std::size_t>(1, u.size()));
  const auto output = [&](const char* name) {
    return y[static_cast<std::size_t>(std::find(code.output_names.begin(), code.output_names.end(), name) -
                                      code.output_names.begin())];
  };
  const auto own = [&](double at, const std::vector<double>& state) -> std::optional<Eigen::VectorXd> {
    if (code.rhs(at, state.data(), scene.parameters.data(), u.data(), 0, dx.data()) != 0 ||
        code.outputs(at, state.data(), scene.parameters.data(), u.data(), 0, y.data()) != 0)
      return std::nullopt;
    Eigen::VectorXd found(static_cast<Eigen::Index>(n) + 2);
    found << numbers(dx, n, n), output("kinetic"), output("potential");
    return found;
  };
  return holds_beyond(derived, scene, code.free, coordinate, t, x, own);
}

std::vector<std::uint32_t> coordinates_valid_beyond_range(const DerivedModel& derived, const run::Scene& scene) {
  const system::EquationSystem& system = derived.candidates.front();
  if (system.has_contacts() || !system.states.empty()) return {};
  std::vector<double> start;
  for (const std::vector<double>* values : {&scene.q, &scene.qdot}) {
    for (const std::uint32_t i : system.free) start.push_back((*values)[i]);
  }
  const auto own = [&](double t, const std::vector<double>& state) { return motion(system, scene, t, state); };
  std::vector<std::uint32_t> result;
  for (const std::uint32_t i : system.free) {
    if (holds_beyond(derived, scene, system.free, i, scene.t0, start, own)) result.push_back(i);
  }
  return result;
}

}  // namespace eomgen::pipeline
