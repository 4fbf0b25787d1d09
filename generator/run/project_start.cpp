// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/project_start.hpp"

#include <algorithm>
#include <eom/automatic.hpp>
#include <eom/constraints/projection.hpp>
#include <eom/hybrid/constraint_rows.hpp>

#include "run/bind.hpp"

namespace eomgen::run {
namespace {

class StartProjection {
 public:
  StartProjection(const Scene& scene, const RunRequest& run)
      : run_(run),
        n_(run.code.free.size()),
        problem_(make_problem(run, eom::Automatic::name)),
        rows_(problem_),
        x_(run.state_names.size()) {
    for (std::size_t i = 0; i < n_; ++i) {
      x_[i] = scene.q[run.code.free[i]];
      x_[n_ + i] = scene.qdot[run.code.free[i]];
    }
    std::copy(scene.z.begin(), scene.z.end(),
              x_.begin() + static_cast<std::ptrdiff_t>(run.code.layout().first_order_begin()));
    for (const Signal& signal : scene.inputs) u_.push_back(signal(scene.t0, scene.t0));
    rows_.start(scene.t0, x_.data(), u_.data());
  }

  bool meet(Scene& scene, const std::vector<std::uint32_t>& kept) {
    std::vector<std::size_t> still;
    for (const std::uint32_t q : kept) {
      const auto found = std::find(run_.code.free.begin(), run_.code.free.end(), q);
      if (found != run_.code.free.end()) still.push_back(static_cast<std::size_t>(found - run_.code.free.begin()));
    }
    eom::Projection projection(n_, rows_.size(), rows_.position_row_count());
    const auto constraints = [&](double t, const double* x, double* psi, double* A, double* b) {
      return bound(still, t, x, psi, A, b);
    };
    const auto mass = [&](double t, const double* x, double* M, double* h) { return metric(still, t, x, M, h); };
    if (projection(scene.t0, x_.data(), constraints, mass).code != 0) return false;
    for (std::size_t i = 0; i < n_; ++i) {
      scene.q[run_.code.free[i]] = x_[i];
      scene.qdot[run_.code.free[i]] = x_[n_ + i];
    }
    return true;
  }

 private:
  // Fixed coordinates are constants of the constraints: their columns in A are 0, and their rates are added to b.
  int bound(const std::vector<std::size_t>& still, double t, const double* x, double* psi, double* A, double* b) {
    const int code = rows_(t, x, u_.data(), psi, A, b);
    const std::size_t m = rows_.size();
    for (const std::size_t k : still) {
      for (std::size_t r = 0; r < m; ++r) {
        b[r] += A[r + m * k] * x[n_ + k];
        A[r + m * k] = 0;
      }
    }
    return code;
  }

  int metric(const std::vector<std::size_t>& still, double t, const double* x, double* M, double* h) const {
    const int code = run_.code.mass(t, x, run_.scene.parameters.data(), M, h);
    for (const std::size_t k : still) {
      for (std::size_t i = 0; i < n_; ++i) M[i + n_ * k] = M[k + n_ * i] = i == k ? 1 : 0;
    }
    return code;
  }

  const RunRequest& run_;
  std::size_t n_;
  eom::hybrid::Problem problem_;
  eom::hybrid::ConstraintRows rows_;
  std::vector<double> x_, u_;
};

}  // namespace

bool project_start(Scene& scene, const RunRequest& run, const std::vector<std::uint32_t>& kept) {
  return StartProjection(scene, run).meet(scene, kept);
}

}  // namespace eomgen::run
