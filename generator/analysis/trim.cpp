// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <eom/layout.hpp>

#include "model/names.hpp"
#include "numeric/elimination.hpp"

namespace eomgen::analysis {
namespace {

using linear::Matrix;
using linear::Precise;

constexpr int most_steps = 50;
constexpr int settled_digits = 60;         // of a step that is nothing
constexpr int rank_digits = 80;            // of the normal equations
constexpr double largest_residual = 1e-9;  // relative to the rates before; as CompiledModel.trim of Python

Error trim_error(const SteadyProblem& p, const std::string& message, const std::string& remedy, ErrorKind kind) {
  const model::Model& model = p.derived->model;
  return Error("equilibria", model.where(model.scene(p.scene.name).span), message, remedy, kind);
}

std::vector<std::size_t> places_of(const SteadyProblem& p, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const model::Input& input : p.derived->model.inputs) known.push_back(input.name);
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw Error(
          "equilibria", {}, fmt::format("there is no input {}", model::quote(name)),
          known.empty() ? "the model has no inputs: declare them in [inputs]" : model::suggest_choice(name, known));
    places.push_back(static_cast<std::size_t>(found - known.begin()));
    if (std::find(places.begin(), places.end() - 1, places.back()) != places.end() - 1)
      throw Error("equilibria", {}, fmt::format("the input {} is named twice", model::quote(name)), "name it once");
  }
  return places;
}

Matrix<Precise> product(const Matrix<Precise>& a, const Matrix<Precise>& b) {
  Matrix<Precise> result(a.rows, b.cols);
  for (std::size_t i = 0; i < a.rows; ++i) {
    for (std::size_t k = 0; k < a.cols; ++k) {
      for (std::size_t j = 0; j < b.cols; ++j) result(i, j) = result(i, j) + a(i, k) * b(k, j);
    }
  }
  return result;
}

struct Step {
  Matrix<Precise> change;
  std::size_t rank;
};

/// The least squares solution of J x = r that is smallest.
Step smallest_solution(const Matrix<Precise>& J, const Matrix<Precise>& r) {
  const Matrix<Precise> turned = linear::transposed(J);
  const numeric::Elimination<Precise> normal(product(turned, J), linear::tiny<Precise>(rank_digits));
  Step step{normal.solve(product(turned, r)), normal.rank()};
  if (step.rank == J.cols) return step;
  const Matrix<Precise> Z = normal.null_space(), across = linear::transposed(Z);
  const numeric::Elimination<Precise> inner(product(across, Z), linear::tiny<Precise>(rank_digits));
  const Matrix<Precise> along = product(Z, inner.solve(product(across, step.change)));
  for (std::size_t i = 0; i < step.change.rows; ++i) step.change(i, 0) = step.change(i, 0) - along(i, 0);
  return step;
}

Precise largest_of(const std::vector<Precise>& values) {
  Precise largest(0);
  for (const Precise& value : values) largest = std::max(largest, linear::magnitude(value));
  return largest;
}

}  // namespace

Trim trim_inputs(const SteadyProblem& p, const std::vector<std::string>& names) {
  const work::Stage stage("finding the inputs");
  const std::vector<std::size_t> places = places_of(p, names);
  const std::size_t n = p.flow->coordinates(), N = p.flow->entries(), states = eom::StateLayout{n}.first_order_begin(),
                    first_order = N - states;
  Trim trim{names, p.setting.inputs, p.z, 0, true};
  if (const model::SingularChart chart = find_singular_chart(p, p.z))
    throw trim_error(p, fmt::format("the equations have no slope at this state: {}", chart.what), chart.remedy,
                     ErrorKind::input);
  linear::Setting<Precise> setting = p.setting;
  std::vector<Precise> rates(N - n);
  double before = 1;
  try {
    if (const auto on_constraints = linear::project_onto_constraints(*p.flow, p.z, setting)) trim.z = *on_constraints;
    for (int k = 0; k < most_steps; ++k) {
      setting.inputs = trim.inputs;
      const linear::Field<Precise> field = p.flow->at(trim.z, setting);
      Matrix<Precise> J(N - n, places.size() + first_order), right(N - n, 1);
      for (std::size_t i = 0; i < N - n; ++i) {
        rates[i] = field.X(n + i, 0);
        right(i, 0) = -rates[i];
        for (std::size_t j = 0; j < places.size(); ++j) J(i, j) = field.input_jacobian(n + i, places[j]);
        for (std::size_t j = 0; j < first_order; ++j) J(i, places.size() + j) = field.jacobian(n + i, states + j);
      }
      if (k == 0) before = std::max(1.0, linear::to_double(largest_of(rates)));
      const Step step = smallest_solution(J, right);
      trim.unique = step.rank == J.cols;
      for (std::size_t j = 0; j < places.size(); ++j)
        trim.inputs[places[j]] = trim.inputs[places[j]] + step.change(j, 0);
      for (std::size_t j = 0; j < first_order; ++j)
        trim.z[states + j] = trim.z[states + j] + step.change(places.size() + j, 0);
      if (largest_of(step.change.a) <= linear::tiny<Precise>(settled_digits)) break;
    }
  } catch (const std::domain_error& error) {
    const NonsmoothTerm source = find_nonsmooth_term(p, trim.z);
    throw Error("equilibria", source.where, fmt::format("{} no slope at this state: {}", source.what, error.what()),
                "choose another state, take coordinates that are regular there, or put a smooth law in place of the "
                "one that has a kink or a root there");
  }
  std::vector<std::string> moving;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const double rate = std::abs(linear::to_double(rates[i]));
    trim.residual = std::max(trim.residual, rate);
    if (!(rate <= largest_residual * before)) moving.push_back(p.flow->names()[n + i]);
  }
  if (!moving.empty())
    throw trim_error(
        p, fmt::format("{} cannot hold this state: {} would change", fmt::join(names, ", "), fmt::join(moving, ", ")),
        "choose another state, or further inputs: --trim NAMES", ErrorKind::numerical);
  return trim;
}

}  // namespace eomgen::analysis
