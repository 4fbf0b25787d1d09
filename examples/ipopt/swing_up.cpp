// Swing-up of the cart and its pendulum in three seconds with little force, by direct collocation with Ipopt.
//   swing_up [MODE] [INTERVALS] [REPEATS]
// Prints iterations, cost and median times, then the end of the motion under the forces that were found.
#include <IpIpoptApplication.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "cart_pendulum.hpp"
#include "collocation.hpp"
#include "eom/discrete/step.hpp"

namespace cart = eom::cart_pendulum;

/// The emitted functions, with the model's parameters.
struct Cart {
  static constexpr std::size_t states = cart::state_count, inputs = cart::input_count;
  static const double* p() {
    static const auto values = [] {
      std::array<double, states> x;
      std::array<double, cart::parameter_count> p;
      cart::defaults(x.data(), p.data());
      return p;
    }();
    return values.data();
  }
  static int rhs(const double* x, const double* u, double* dx) { return cart::rhs<double>(0, x, p(), u, nullptr, dx); }
  static int jac(const double* x, const double* u, double* J) {
    return cart::jac<double>(0, x, p(), u, nullptr, J, nullptr);
  }
  static int jac_u(const double* x, const double* u, double* J) {
    return cart::jac_u<double>(0, x, p(), u, nullptr, J);
  }
  static int vjp(const double* x, const double* u, const double* w, double* wJ) {
    return cart::vjp<double>(0, x, p(), u, nullptr, w, wJ);
  }
  static int hvp(const double* x, const double* u, const double* v, double* Hd) {
    return cart::hvp<double>(0, x, p(), u, nullptr, v, Hd);
  }
};
using Problem = Collocation<Cart>;

/// The state after the forces of the solution, which are a parabola in each interval, by many small steps.
Problem::State motion_end(const std::vector<double>& z, const Problem::State& start, double duration) {
  constexpr std::size_t V = Problem::V, N = Problem::N;
  const std::size_t intervals = (z.size() / V - 1) / 2;
  constexpr int parts = 200;
  const double h = duration / static_cast<double>(intervals) / parts;
  const eom::discrete::Functions functions{.rhs = cart::rhs<double>};
  eom::discrete::Step step("rk4", {cart::state_count, cart::parameter_count, cart::input_count});
  Problem::State x = start;
  for (std::size_t k = 0; k < intervals; ++k)
    for (int part = 0; part < parts; ++part) {
      const double s = (part + 0.5) / parts;  // held at the value in the middle of the step
      const double a = z[2 * k * V + N], c = z[(2 * k + 1) * V + N], b = z[(2 * k + 2) * V + N];
      const double u = a * (1 - s) * (1 - 2 * s) + 4 * c * s * (1 - s) + b * s * (2 * s - 1);
      if (step(functions, {0, h, x.data(), Cart::p(), &u}, x.data()) != 0) std::exit(1);
    }
  return x;
}

/// The source of the derivatives.
struct Mode {
  const char* name;
  Derivatives derivatives;
  bool has_hessian;   // false: Ipopt approximates it (limited memory)
  bool has_jacobian;  // false: Ipopt computes it by differences of the constraints
};
constexpr Mode modes[] = {{"exact", Derivatives::exact, true, true},
                          {"exact_jacobian", Derivatives::exact, false, true},
                          {"quotients", Derivatives::quotients, true, true},
                          {"quotients_jacobian", Derivatives::quotients, false, true},
                          {"ipopt", Derivatives::quotients, false, false}};

/// Solves the problem once. Returns its processor time in seconds.
double solve(Problem* problem, const Mode& mode) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> solver = new Ipopt::IpoptApplication(false);
  const Ipopt::SmartPtr<Ipopt::OptionsList> options = solver->Options();
  options->SetIntegerValue("print_level", 0);
  options->SetStringValue("sb", "yes");
  options->SetNumericValue("tol", 1e-8);
  if (!mode.has_hessian) options->SetStringValue("hessian_approximation", "limited-memory");
  if (!mode.has_jacobian) options->SetStringValue("jacobian_approximation", "finite-difference-values");
  if (solver->Initialize() != Ipopt::Solve_Succeeded) std::exit(1);
  const std::clock_t begin = std::clock();
  solver->OptimizeTNLP(problem);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "exact";
  const std::size_t intervals = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 50;
  const std::size_t repeats = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1;
  const Mode* const mode =
      std::find_if(std::begin(modes), std::end(modes), [&](const Mode& known) { return known.name == name; });
  if (mode == std::end(modes) || intervals < 2 || intervals > 100'000 || repeats < 1 || repeats > 1000) {
    std::fputs("usage: swing_up [exact|exact_jacobian|quotients|quotients_jacobian|ipopt] [INTERVALS] [REPEATS]\n",
               stderr);
    return 2;
  }
  const double duration = 3, most_force = 20, most_travel = 1.5;  // s, N, m
  const Problem::State hanging{0, 0, 0, 0}, upright{0, std::acos(-1.0), 0, 0};
  std::vector<double> seconds, in_derivatives;
  Ipopt::SmartPtr<Problem> problem;
  for (std::size_t k = 0; k < repeats; ++k) {
    problem = new Problem(intervals, duration, hanging, upright, most_force, most_travel, mode->derivatives);
    seconds.push_back(solve(GetRawPtr(problem), *mode));
    in_derivatives.push_back(problem->seconds_in_derivatives);
  }
  const Problem::State end = motion_end(problem->solution, hanging, duration);
  const bool is_solved = problem->outcome == Ipopt::SUCCESS;
  std::printf("%s: %s after %d iterations, cost %.9g N^2 s\n", mode->name,
              is_solved                                             ? "solved"
              : problem->outcome == Ipopt::STOP_AT_ACCEPTABLE_POINT ? "stopped at an acceptable point"
                                                                    : "not solved",
              problem->iterations, problem->cost);
  if (repeats > 1)
    std::printf("medians of %zu: %.3g ms of processor time, of these %.3g ms in derivatives\n", repeats,
                1e3 * median(seconds), 1e3 * median(in_derivatives));
  const double miss = std::abs(end[cart::State::theta] - upright[1]);
  std::printf("theta at the end of the motion: pi within %.1e\n", miss);
  return is_solved && miss < 1e-2 ? 0 : 1;
}
