// SPDX-License-Identifier: GPL-3.0-or-later
#include "models/rough.hpp"

#include <doctest/doctest.h>

#include <utility>

#include "numeric/numbers.hpp"
#include "support/reference_integration.hpp"

namespace eomgen::test {

FinishedRun run_rough(const std::string& model, const std::string& scene,
                      const std::function<void(pipeline::SimulationRequest&)>& adjust) {
  return run_model(model, [&](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
    request.overrides.every = 0.02;
    if (adjust) adjust(request);
  });
}

std::function<void(pipeline::SimulationRequest&)> with(std::map<std::string, double> parameters) {
  return [parameters](pipeline::SimulationRequest& request) {
    for (const auto& [name, value] : parameters) request.overrides.values[name] = numeric::exact(value);
  };
}

std::vector<run::RunEvent> events_of(const FinishedRun& run) { return run.simulation.result.events; }

void HandWrittenMotion::advance_to(double t) {
  const auto f = [this](double at, const double* state, double* dx) { return rates_(at, state, dx), 0; };
  x = integrate_reference(f, t_, x, t, 1e-12, 1e-14);
  t_ = t;
}

StateEvaluation::StateEvaluation(const FinishedRun& run, const std::string& model)
    : rough_(read_text(model_path(model)), run.simulation.scene.parameters) {}

bool StateEvaluation::slide(double t, std::vector<double> x) {
  t_ = t, x_ = std::move(x);
  dx.assign(x_.size(), 0);
  const std::vector<eom::Contact> contacts = rough_.contact_list();
  std::vector<double> g(eom::contact_values * contacts.size());
  for (int high = 0; high < 2; ++high) {
    mode_ = 0;
    rough_.contacts(t, x_.data(), 0, g.data());
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const bool back = contacts[j].dimensions == 1 && g[eom::contact_values * j] < 0;
      const bool pulls = high == 1 && contacts[j].surface && !contacts[j].unilateral;
      mode_ = eom::with_contact_digit(mode_, j, (pulls ? 3 : 0) + (back ? 2 : 1));
    }
    if (rough_.rhs(t, x_.data(), mode_, dx.data()) != 0) continue;
    rough_.contacts(t, x_.data(), mode_, g.data());
    bool holds = true;
    for (std::size_t j = 0; j < contacts.size(); ++j) holds = holds && g[eom::contact_values * j + 3] >= 0;
    if (holds) return true;
  }
  return false;
}

double simpson(const std::function<double(double)>& f, double a, double b, int intervals) {
  const double h = (b - a) / intervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(a + i * h);
  return sum * h / 3;
}

double root_between(const std::function<double(double)>& f, double a, double b) {
  const bool rises = f(a) < 0;
  for (int i = 0; i < 200; ++i) (f((a + b) / 2) < 0) == rises ? a = (a + b) / 2 : b = (a + b) / 2;
  return (a + b) / 2;
}

}  // namespace eomgen::test
