// A user's program: integrates x'' = -x over one period with the installed runtime.
#include <cmath>
#include <cstdio>
#include <eom/ode.hpp>
#include <numbers>
#include <vector>

int main() {
  const auto oscillator = [](double, const double* x, double* dx) {
    dx[0] = x[1];
    dx[1] = -x[0];
    return 0;
  };
  const std::vector<double> start{1, 0};
  const eom::Result result = eom::integrate("dop853", oscillator, 0, start, 2 * std::numbers::pi, {});
  const double error = std::hypot(result.x[0] - 1, result.x[1]);
  std::printf("%s, error %.1e after %zu steps\n", eom::name(result.outcome), error, result.statistics.steps);
  return result.outcome == eom::Outcome::done && error < 1e-7 ? 0 : 1;
}
