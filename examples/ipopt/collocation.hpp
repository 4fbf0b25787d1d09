// Direct collocation of an optimal control problem for Ipopt. In: the emitted functions of a model with forces that are
// linear in its inputs, the two ends, bounds. Out: states and inputs that minimise the integral of the squared inputs.
//
// Hermite-Simpson in separated form, with the middle c of each interval [a, b] of length h as a point of its own:
//   x_c = (x_a + x_b)/2 + h/8 (f_a - f_b),   x_b = x_a + h/6 (f_a + 4 f_c + f_b).
// Source: Betts, Practical Methods for Optimal Control and Estimation Using Nonlinear Programming, section 4.5.
// Each constraint is linear in the x and f of three points. So the Jacobian has blocks of df/dx and df/du, and the
// Hessian of the Lagrangian has one block at each point: that of w^T f, with w from the multipliers.
#pragma once

#include <IpTNLP.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <vector>

enum class Derivatives {
  exact,      // df/dx, df/du, and the Hessian of w^T f
  quotients,  // the same by central differences of f
};

/// Model: a type with the emitted rhs, jac, jac_u, vjp, hvp of N states and U inputs (swing_up.cpp).
template <class Model>
class Collocation : public Ipopt::TNLP {
 public:
  static constexpr std::size_t N = Model::states, U = Model::inputs, V = N + U;
  using State = std::array<double, N>;

  Collocation(std::size_t intervals, double duration, const State& start, const State& end, double most_force,
              double most_travel, Derivatives derivatives)
      : points_(2 * intervals + 1),
        h_(duration / static_cast<double>(intervals)),
        start_(start),
        end_(end),
        most_force_(most_force),
        most_travel_(most_travel),
        derivatives_(derivatives),
        slopes_(points_ * N),
        tangents_(points_ * N * V) {}

  std::vector<double> solution;  // of each point x, then u
  int iterations = 0;
  double cost = 0;
  double seconds_in_derivatives = 0;  // processor time of Jacobians and Hessians
  Ipopt::SolverReturn outcome = Ipopt::UNASSIGNED;

  bool get_nlp_info(int& n, int& m, int& of_jacobian, int& of_hessian, IndexStyleEnum& style) override {
    n = static_cast<int>(points_ * V);
    m = static_cast<int>((points_ - 1) * N);
    of_jacobian = of_hessian = 0;
    each_entry([&](auto...) { ++of_jacobian; });
    of_hessian = static_cast<int>(points_ * V * (V + 1) / 2);
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(int n, double* lower, double* upper, int m, double* g_lower, double* g_upper) override {
    std::fill_n(lower, n, -1e20);
    std::fill_n(upper, n, 1e20);
    for (std::size_t k = 0; k < points_; ++k) {
      lower[k * V] = -most_travel_, upper[k * V] = most_travel_;
      for (std::size_t j = N; j < V; ++j) lower[k * V + j] = -most_force_, upper[k * V + j] = most_force_;
    }
    std::copy_n(start_.data(), N, lower), std::copy_n(start_.data(), N, upper);
    std::copy_n(end_.data(), N, lower + (points_ - 1) * V), std::copy_n(end_.data(), N, upper + (points_ - 1) * V);
    std::fill_n(g_lower, m, 0.0);
    std::fill_n(g_upper, m, 0.0);
    return true;
  }

  /// A straight line between the ends, without forces.
  bool get_starting_point(int, bool, double* z, bool, double*, double*, int, bool, double*) override {
    for (std::size_t k = 0; k < points_; ++k) {
      const double s = static_cast<double>(k) / static_cast<double>(points_ - 1);
      for (std::size_t i = 0; i < N; ++i) z[k * V + i] = (1 - s) * start_[i] + s * end_[i];
      for (std::size_t j = N; j < V; ++j) z[k * V + j] = 0;
    }
    return true;
  }

  bool eval_f(int, const double* z, bool, double& value) override {
    value = 0;
    each_force(z, [&](std::size_t, double weight, double u) { value += weight * u * u; });
    return true;
  }

  bool eval_grad_f(int n, const double* z, bool, double* gradient) override {
    std::fill_n(gradient, n, 0.0);
    each_force(z, [&](std::size_t place, double weight, double u) { gradient[place] = 2 * weight * u; });
    return true;
  }

  bool eval_g(int, const double* z, bool, int, double* g) override {
    for (std::size_t k = 0; k < points_; ++k)
      if (Model::rhs(z + k * V, z + k * V + N, &slopes_[k * N]) != 0) return false;
    for (std::size_t a = 0; a + 2 < points_; a += 2)
      for (std::size_t i = 0; i < N; ++i) {
        const auto x = [&](std::size_t k) { return z[k * V + i]; };
        const auto f = [&](std::size_t k) { return slopes_[k * N + i]; };
        g[a * N + i] = x(a + 1) - (x(a) + x(a + 2)) / 2 - h_ / 8 * (f(a) - f(a + 2));
        g[a * N + N + i] = x(a + 2) - x(a) - h_ / 6 * (f(a) + 4 * f(a + 1) + f(a + 2));
      }
    return true;
  }

  bool eval_jac_g(int, const double* z, bool, int, int, int* rows, int* columns, double* values) override {
    if (values == nullptr) {
      each_entry([&](std::size_t row, std::size_t point, std::size_t, std::size_t j, double, double) {
        *rows++ = static_cast<int>(row);
        *columns++ = static_cast<int>(point * V + j);
      });
      return true;
    }
    const Timer timer{seconds_in_derivatives};
    for (std::size_t k = 0; k < points_; ++k)
      if (!tangents(z + k * V, &tangents_[k * N * V])) return false;
    each_entry([&](std::size_t, std::size_t point, std::size_t i, std::size_t j, double of_x, double of_f) {
      *values++ = (i == j ? of_x : 0) + of_f * tangents_[point * N * V + i + N * j];
    });
    return true;
  }

  bool eval_h(int, const double* z, bool, double factor, int, const double* multipliers, bool, int, int* rows,
              int* columns, double* values) override {
    if (values == nullptr) {
      for (std::size_t k = 0; k < points_; ++k)
        for (std::size_t i = 0; i < V; ++i)
          for (std::size_t j = 0; j <= i; ++j) {
            *rows++ = static_cast<int>(k * V + i);
            *columns++ = static_cast<int>(k * V + j);
          }
      return true;
    }
    const Timer timer{seconds_in_derivatives};
    for (std::size_t k = 0; k < points_; ++k) {
      State w{};  // the multipliers of f at this point
      each_use(k, [&](std::size_t row, double, double of_f) {
        for (std::size_t i = 0; i < N; ++i) w[i] += of_f * multipliers[row + i];
      });
      std::array<double, V * V> block{};
      if (!hessian(z + k * V, w, block)) return false;
      for (std::size_t i = 0; i < V; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          *values++ = block[i + V * j] + (i == j && i >= N ? 2 * factor * weight_of(k) : 0);
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, int iteration, double, double, double, double, double, double,
                             double, double, int, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    iterations = iteration;
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn status, int n, const double* z, const double*, const double*, int,
                         const double*, const double*, double value, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    outcome = status;
    solution.assign(z, z + n);
    cost = value;
  }

 private:
  /// Adds the processor time of its life to a sum of seconds.
  struct Timer {
    double& sum;
    std::clock_t begin = std::clock();
    ~Timer() { sum += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; }
  };

  /// Simpson's weight of a point.
  double weight_of(std::size_t k) const { return h_ / 6 * (k % 2 == 1 ? 4 : k == 0 || k + 1 == points_ ? 1 : 2); }

  template <class Visit>
  void each_force(const double* z, Visit visit) const {
    for (std::size_t k = 0; k < points_; ++k)
      for (std::size_t j = N; j < V; ++j) visit(k * V + j, weight_of(k), z[k * V + j]);
  }

  /// Calls visit(first row, factor of x, factor of f) for the groups of N constraints that use point k.
  template <class Visit>
  void each_use(std::size_t k, Visit visit) const {
    if (k % 2 == 1) {
      visit((k - 1) * N, 1.0, 0.0);
      visit((k - 1) * N + N, 0.0, -4 * h_ / 6);
      return;
    }
    if (k > 0) {  // the end of an interval
      visit((k - 2) * N, -0.5, h_ / 8);
      visit((k - 2) * N + N, 1.0, -h_ / 6);
    }
    if (k + 1 < points_) {  // the start of one
      visit(k * N, -0.5, -h_ / 8);
      visit(k * N + N, -1.0, -h_ / 6);
    }
  }

  /// Calls visit(row, point, i, j, factor of x, factor of f) for the entries of the Jacobian that are not always 0.
  template <class Visit>
  void each_entry(Visit visit) const {
    for (std::size_t k = 0; k < points_; ++k)
      each_use(k, [&](std::size_t row, double of_x, double of_f) {
        for (std::size_t i = 0; i < N; ++i)
          for (std::size_t j = 0; j < V; ++j) {
            const bool depends =
                of_f != 0 && (i < N / 2 ? j == i + N / 2 : true);  // the rate of a coordinate is a state
            if (depends || (of_x != 0 && i == j)) visit(row + i, k, i, j, of_x, of_f);
          }
      });
  }

  /// df/dx, then df/du: N x V by columns.
  bool tangents(const double* at, double* to) const {
    if (derivatives_ != Derivatives::quotients)
      return Model::jac(at, at + N, to) == 0 && Model::jac_u(at, at + N, to + N * N) == 0;
    std::array<double, V> moved;
    std::copy_n(at, V, moved.data());
    State up, down;
    for (std::size_t j = 0; j < V; ++j) {
      const double by = 1e-6 * std::max(1.0, std::abs(at[j]));  // the cube root of the rounding
      moved[j] = at[j] + by;
      if (Model::rhs(moved.data(), moved.data() + N, up.data()) != 0) return false;
      moved[j] = at[j] - by;
      if (Model::rhs(moved.data(), moved.data() + N, down.data()) != 0) return false;
      moved[j] = at[j];
      for (std::size_t i = 0; i < N; ++i) to[i + N * j] = (up[i] - down[i]) / (2 * by);
    }
    return true;
  }

  /// The Hessian of w^T f by (x, u), its lower triangle.
  bool hessian(const double* at, const State& w, std::array<double, V * V>& to) const {
    if (derivatives_ == Derivatives::quotients) return hessian_by_quotients(at, w, to);
    std::array<double, 2 * N> v{};
    std::copy_n(w.data(), N, v.data());
    for (std::size_t j = 0; j < N; ++j) {
      v[N + j] = 1;
      if (Model::hvp(at, at + N, v.data(), &to[V * j]) != 0) return false;
      v[N + j] = 0;
    }
    // f is linear in u: the mixed part is the change of w^T df/dx with u.
    std::array<double, U> u{};
    State none, one;
    if (Model::vjp(at, u.data(), w.data(), none.data()) != 0) return false;
    for (std::size_t j = 0; j < U; ++j) {
      u[j] = 1;
      if (Model::vjp(at, u.data(), w.data(), one.data()) != 0) return false;
      u[j] = 0;
      for (std::size_t i = 0; i < N; ++i) to[N + j + V * i] = one[i] - none[i];
    }
    return true;
  }

  bool hessian_by_quotients(const double* at, const State& w, std::array<double, V * V>& to) const {
    constexpr double by = 1e-4;  // the fourth root of the rounding
    std::array<double, V> moved;
    const auto value = [&](std::size_t i, double by_i, std::size_t j, double by_j, double& result) {
      std::copy_n(at, V, moved.data());
      moved[i] += by_i;
      moved[j] += by_j;
      State f;
      if (Model::rhs(moved.data(), moved.data() + N, f.data()) != 0) return false;
      result = 0;
      for (std::size_t k = 0; k < N; ++k) result += w[k] * f[k];
      return true;
    };
    for (std::size_t i = 0; i < V; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double a, b, c, d;
        if (!value(i, by, j, by, a) || !value(i, by, j, -by, b) || !value(i, -by, j, by, c) ||
            !value(i, -by, j, -by, d))
          return false;
        to[i + V * j] = (a - b - c + d) / (4 * by * by);
      }
    return true;
  }

  std::size_t points_;
  double h_;
  State start_, end_;
  double most_force_, most_travel_;
  Derivatives derivatives_;
  std::vector<double> slopes_, tangents_;
};
