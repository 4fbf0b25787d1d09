// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/tracer.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace eomgen::analysis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double share = 0.02;      // step length relative to the size of the figure
constexpr double longest = 8;       // maximum curve length in each direction, relative to that size
constexpr double inside = 1e-9;     // tolerance at bounds
constexpr double standing = 1e-12;  // relative: the coordinates change but the position does not

}  // namespace

double CurveTracer::span(Index k) const { return place_.angle[static_cast<std::size_t>(k)] ? 1 : place_.size; }

double CurveTracer::step() const { return share * place_.size; }

bool CurveTracer::is_inside(const VectorXd& q, const VectorXd& low, const VectorXd& high) const {
  return ((q - low).array() >= -inside).all() && ((high - q).array() >= -inside).all();
}

std::optional<VectorXd> CurveTracer::project_onto(const CurveEquations& equations, VectorXd q, int tries) const {
  VectorXd S(n_);
  for (Index k = 0; k < n_; ++k) S[k] = span(k);
  for (; tries > 0; --tries) {
    const auto now = equations(q);
    if (!now) return std::nullopt;
    const MatrixXd A = now->second * S.asDiagonal();
    const MatrixXd gram = A * A.transpose();
    const VectorXd back = S.asDiagonal() * (A.transpose() * gram.fullPivLu().solve(now->first));
    if (!back.allFinite()) return std::nullopt;
    q -= back;
    if (back.cwiseQuotient(S).norm() < standing) break;
  }
  return q;
}

std::optional<VectorXd> CurveTracer::tangent(const CurveEquations& equations, const VectorXd& q) const {
  const auto now = equations(q);
  const auto at = f_(q);
  if (!now || !at) return std::nullopt;
  const MatrixXd& A = now->second;
  VectorXd t(n_);
  if (n_ == 2)
    t << -A(0, 1), A(0, 0);
  else
    t = Eigen::Vector3d(A.row(0)).cross(Eigen::Vector3d(A.row(1)));
  const double speed = (at->turn * t).norm();
  if (!(speed > standing * t.norm() * place_.size)) return std::nullopt;
  return VectorXd(t / speed);
}

std::vector<Point> CurveTracer::trace(const CurveEquations& equations, const VectorXd& start, const VectorXd& low,
                                      const VectorXd& high) const {
  const auto first = f_(start);
  if (!first || !first->x.allFinite()) return {};
  const Point begin = first->x;
  std::vector<Point> forth, back;
  for (std::vector<Point>* points : {&forth, &back}) {
    VectorXd q = start;
    std::optional<VectorXd> before;
    points->push_back(begin);
    for (int k = 0; k < static_cast<int>(longest / share); ++k) {
      auto d = tangent(equations, q);
      if (!d) break;
      const bool turned = before ? before->dot(*d) < 0 : points == &back;
      if (turned) *d = -*d;
      before = d;
      const auto next = project_onto(equations, q + step() * *d, 2);
      const auto at = next ? f_(*next) : std::nullopt;
      if (!at || !at->x.allFinite() || !is_inside(*next, low, high)) break;
      q = *next;
      points->push_back(at->x);
      if (k > 4 && (at->x - begin).norm() < 0.7 * step()) {
        points->push_back(begin);
        return *points;
      }
    }
  }
  std::reverse(back.begin(), back.end());
  back.insert(back.end(), forth.begin() + 1, forth.end());
  return back;
}

}  // namespace eomgen::analysis
