// A two-joint arm under computed torque at 1 kHz; its equations from eight threads; a saved and restored simulation.
#include <cmath>
#include <cstdio>
#include <eomgen/eomgen.hpp>
#include <thread>
#include <vector>

using eomgen::Value;

namespace {

eomgen::Definition arm() {
  eomgen::Definition d("Two-joint arm");
  d.parameter("m", "2 kg").parameter("L", "0.5 m").parameter("g", "9.81 m/s^2");
  d.set("coordinates", "q1", "rad").set("coordinates", "q2", "rad");
  d.set("inputs", "tau1", Value::table({{"unit", "N*m"}, {"default", 0}}));
  d.set("inputs", "tau2", Value::table({{"unit", "N*m"}, {"default", 0}}));
  d.add("particle", {{"name", "elbow"}, {"mass", "m"}, {"position", Value::list({"L*cos(q1)", 0, "L*sin(q1)"})}});
  d.add("particle", {{"name", "hand"},
                     {"mass", "m"},
                     {"position", Value::list({"L*cos(q1) + L*cos(q1 + q2)", 0, "L*sin(q1) + L*sin(q1 + q2)"})}});
  d.add("force", {{"gravity", "-g*E3"}});
  d.add("force", {{"generalized", Value::table({{"q1", "tau1"}, {"q2", "tau2"}})}});
  d.set("scene.default", "t", Value::list({0, 2}));
  d.set("scene.default", "initial", Value::table({{"q1", 0.1}, {"q2", 0.4}}));
  return d;
}

/// Torques that move the joints along q1 = sin(t)/2, q2 = 0.5 - cos(t)/2.
std::vector<double> computed_torque(const eomgen::CompiledModel& f, double t, const std::vector<double>& x) {
  const double q[] = {std::sin(t) / 2, 0.5 - std::cos(t) / 2}, v[] = {std::cos(t) / 2, std::sin(t) / 2};
  double M[4], h[2], a[2];
  f.mass({.t = t, .x = x.data()}, M, h);  // M qddot + h = 0 without torques
  for (int i = 0; i < 2; ++i) {
    const double feedforward = i == 0 ? -q[0] : std::cos(t) / 2;
    a[i] =
        feedforward + 40 * (v[i] - x[static_cast<std::size_t>(2 + i)]) + 400 * (q[i] - x[static_cast<std::size_t>(i)]);
  }
  return {M[0] * a[0] + M[2] * a[1] + h[0], M[1] * a[0] + M[3] * a[1] + h[1]};
}

}  // namespace

int main() try {
  const eomgen::CompiledModel f = eomgen::Model::from(arm(), "arm").compile();

  // The loop of a digital controller: torques are held for 1 ms.
  eomgen::Simulation simulation(f, {.rtol = 1e-8, .atol = 1e-10});
  std::vector<double> reached;
  const auto control_until = [&f](eomgen::Simulation& s, int first, int last) {
    for (int k = first; k < last; ++k) {
      s.set_inputs(computed_torque(f, s.t(), s.state()));
      const eomgen::Advance end = s.advance(1e-3 * (k + 1));
      if (!end.is_complete()) throw std::runtime_error(end.outcome + ": " + end.detail);
    }
  };
  control_until(simulation, 0, 1000);
  const eomgen::SimulationState saved = simulation.save();
  control_until(simulation, 1000, 2000);
  reached = simulation.state();
  std::printf("t = %g: q1 = %.6f, wanted %.6f\n", simulation.t(), reached[0], std::sin(2.0) / 2);

  // The same second half from the saved state, in another simulation.
  eomgen::Simulation other(f, {.rtol = 1e-8, .atol = 1e-10});
  other.restore(saved);
  control_until(other, 1000, 2000);
  std::printf("restored: %s\n", other.state() == reached ? "the same bits" : "another motion");

  // Eight threads evaluate the equations and their Jacobian at once, without a lock.
  std::vector<double> sums(8);
  {
    std::vector<std::jthread> threads;
    for (double& sum : sums) {
      threads.emplace_back([&f, &sum] {
        for (int k = 0; k < 1000; ++k) {
          const double x[] = {0.001 * k, 0.5, 1, -1};
          double dx[4], J[16];
          if (f.rhs({.x = x}, dx) != 0 || f.jac({.x = x}, J, nullptr) != 0) return;
          sum += dx[2] + J[2];
        }
      });
    }
  }
  bool equal = true;
  for (const double sum : sums) equal = equal && sum == sums[0];
  std::printf("eight threads: %s, %.6f\n", equal ? "equal sums" : "different sums", sums[0]);
  const bool tracks = std::abs(reached[0] - std::sin(2.0) / 2) < 1e-3;
  return tracks && equal && other.state() == reached ? 0 : 3;
} catch (const eomgen::Error& error) {
  std::fputs(error.what(), stderr);
  return error.exit_code();
}
