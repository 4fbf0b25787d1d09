// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/surface_lines.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "analysis/drawing/level_lines.hpp"
#include "numeric/dense.hpp"

namespace eomgen::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Curve tracing by continuation. In: n - 1 equations in n coordinates, and the position as a function of them. Out:
// points in space at equal distances along the solution curve.

/// Values (n - 1) and Jacobian (n - 1 x n) of the equations; nullopt if they are undefined.
using CurveEquations =
    std::function<std::optional<std::pair<Eigen::VectorXd, Eigen::MatrixXd>>(const Eigen::VectorXd&)>;

constexpr double share = 0.02;      // step length relative to the size of the figure
constexpr double longest = 8;       // maximum curve length in each direction, relative to that size
constexpr double inside = 1e-9;     // tolerance at bounds
constexpr double standing = 1e-12;  // relative: the coordinates change but the position does not

class CurveTracer {
 public:
  CurveTracer(const SurfaceFunction& function, const SurfaceSetting& place)
      : f_(function), place_(place), n_(place.q.size()) {}

  /// Change of coordinate k that moves the position by about the size of the figure.
  double span(Index k) const { return place_.angle[static_cast<std::size_t>(k)] ? 1 : place_.size; }

  /// Step length in space.
  double step() const { return share * place_.size; }

  bool is_inside(const VectorXd& q, const VectorXd& low, const VectorXd& high) const {
    return ((q - low).array() >= -inside).all() && ((high - q).array() >= -inside).all();
  }

  /// Projects q onto the curve by Newton's method with minimum-norm steps, scaled by span(). Returns nullopt if it does
  /// not converge in `tries` iterations.
  std::optional<VectorXd> project_onto(const CurveEquations& equations, VectorXd q, int tries) const {
    VectorXd S(n_);
    for (Index k = 0; k < n_; ++k) S[k] = span(k);
    for (; tries > 0; --tries) {
      const auto now = equations(q);
      if (!now) return std::nullopt;
      const MatrixXd A = now->second * S.asDiagonal();
      const MatrixXd gram = A * A.transpose();
      const VectorXd back = S.asDiagonal() * (A.transpose() * numeric::solve(gram, now->first));
      if (!back.allFinite()) return std::nullopt;
      q -= back;
      if (back.cwiseQuotient(S).norm() < standing) break;
    }
    return q;
  }

  /// Traces the curve in both directions from a point until it closes (then the first and last points are equal) or
  /// leaves the box.
  std::vector<Point> trace(const CurveEquations& equations, const VectorXd& start, const VectorXd& low,
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

 private:
  /// Tangent of the curve, per unit of distance in space.
  std::optional<VectorXd> tangent(const CurveEquations& equations, const VectorXd& q) const {
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

  const SurfaceFunction& f_;
  const SurfaceSetting& place_;
  Eigen::Index n_;
};

constexpr double pi = std::numbers::pi;
constexpr double around = 0.6;         // extent of a net along a length, relative to the size
constexpr double flat = 1e-7;          // relative tolerance of a plane
constexpr double same_slope = 1e-9;    // relative: psi is linear in a coordinate
constexpr int points_of_line = 48;     // of a net
constexpr int spokes = 12, rings = 4;  // of a net: around, and across

class Lines {
 public:
  Lines(const SurfaceFunction& function, const SurfaceSetting& place, const View& view)
      : f_(function), place_(place), view_(view), tracer_(function, place), n_(place.q.size()) {}

  std::vector<SurfaceLine> draw() {
    const auto begin = tracer_.project_onto(psi(), place_.q, 20);
    if (!begin) return {};
    here_ = *begin;
    const auto at = f_(here_);
    if (!at || !at->x.allFinite()) return {};
    x_ = at->x;
    if (at->psi.size() == n_ - 1)
      curve();
    else if (n_ == 3 && at->psi.size() == 1)
      surface(*at);
    return lines_;
  }

 private:
  CurveEquations psi() const {
    return [this](const VectorXd& q) -> std::optional<std::pair<VectorXd, MatrixXd>> {
      const auto p = f_(q);
      if (!p || !p->psi.allFinite() || !p->slope.allFinite()) return std::nullopt;
      return std::pair{p->psi, p->slope};
    };
  }
  void curve() {
    VectorXd low = place_.low, high = place_.high;
    const VectorXd none = VectorXd::Constant(n_, std::numeric_limits<double>::infinity());
    std::vector<Point> points = tracer_.trace(psi(), here_, -none, none);
    const bool closed = points.size() > 2 && points.front() == points.back();
    if (!closed) {  // limited to a full turn of an angle, or to the size of the figure
      for (Index k = 0; k < n_; ++k) {
        const double reach = place_.angle[static_cast<std::size_t>(k)] ? pi : 1.2 * place_.size;
        low[k] = std::max(low[k], here_[k] - reach);
        high[k] = std::min(high[k], here_[k] + reach);
      }
      points = tracer_.trace(psi(), here_, low, high);
    }
    if (points.size() > 2) lines_.push_back({points, true});
  }

  static Point normal(const SurfacePoint& p) {
    const Point a = p.turn.col(0), b = p.turn.col(1), c = p.turn.col(2);
    const Point n = b.cross(c) * p.slope(0, 0) + c.cross(a) * p.slope(0, 1) + a.cross(b) * p.slope(0, 2);
    return n.norm() > 0 ? Point(n / n.norm()) : Point(Point::Zero());
  }

  /// The coordinate in which psi is linear with a nonzero slope. The others are then the parameters of the net.
  std::optional<Index> solved_for() const {
    std::optional<Index> best;
    double least = 0.3;  // least slope relative to its variation
    for (Index k = 0; k < 3; ++k) {
      double smallest = std::numeric_limits<double>::infinity(), largest = 0;
      bool linear = true;
      for (int sample = 0; sample < 9 && linear; ++sample) {
        VectorXd q = here_;
        for (Index i = 0; i < 3; ++i) {
          if (i != k) q[i] += 0.4 * tracer_.span(i) * std::sin(1.7 * sample + 2.3 * static_cast<double>(i));
        }
        q = q.cwiseMax(place_.low).cwiseMin(place_.high);
        const auto at = f_(q);
        q[k] += 0.3 * tracer_.span(k);
        const auto other = f_(q);
        linear = at && other && std::abs(at->slope(0, k) - other->slope(0, k)) <= same_slope * at->slope.norm();
        if (!linear) break;
        smallest = std::min(smallest, std::abs(at->slope(0, k)));
        largest = std::max(largest, std::abs(at->slope(0, k)));
      }
      if (!linear || !(largest > 0) || 1 - smallest / largest >= least) continue;
      best = k;
      least = 1 - smallest / largest;
    }
    return best;
  }

  void surface(const SurfacePoint& at) {
    const auto k = solved_for();
    if (k)
      graph(*k, at);
    else
      sliced();
    if (is_plane(at)) {
      lines_.clear();
      return parallelogram(at);
    }
    outline();
  }

  bool is_plane(const SurfacePoint& at) const {
    const Point n = normal(at);
    return std::all_of(net_.begin(), net_.end(), [&](const std::vector<VectorXd>& line) {
      return std::all_of(line.begin(), line.end(),
                         [&](const VectorXd& q) { return std::abs(n.dot(f_(q)->x - x_)) <= flat * place_.size; });
    });
  }

  /// One side is horizontal if possible.
  void parallelogram(const SurfacePoint& at) {
    const Point n = normal(at);
    Point u = Point::Unit(2).cross(n);
    if (u.norm() < 0.1) u = Point::Unit(1).cross(n);
    u.normalize();
    const Point v = n.cross(u), foot = n.dot(x_) * n;  // projection of the origin
    const bool near = (foot - x_).norm() < 1.5 * place_.size && std::abs(n.dot(x_)) < 0.5 * place_.size;
    const Point middle = near ? Point((foot + x_) / 2) : x_;
    const double a = around * place_.size + (near ? std::abs(u.dot(foot - x_)) / 2 : 0),
                 b = around * place_.size + (near ? std::abs(v.dot(foot - x_)) / 2 : 0);
    lines_.push_back({{middle - a * u - b * v, middle + a * u - b * v, middle + a * u + b * v, middle - a * u + b * v,
                       middle - a * u - b * v},
                      true});
  }

  /// Range of a coordinate of the net, and the values at which it has lines.
  void range(Index k, const SurfacePoint& at) {
    const bool angle = place_.angle[static_cast<std::size_t>(k)];
    const bool bounded = std::isfinite(place_.low[k]) && std::isfinite(place_.high[k]);
    const double speed = at.turn.col(k).norm(), reach = around * place_.size / std::max(speed, 1e-3);
    low_[k] = angle ? here_[k] - pi : here_[k] - reach;
    high_[k] = angle ? here_[k] + pi : here_[k] + reach;
    if (angle && bounded) low_[k] = place_.low[k], high_[k] = place_.high[k];
    // A radius starts at its axis.
    if (!angle && std::isfinite(place_.low[k]) && low_[k] - place_.low[k] < reach) low_[k] = place_.low[k];
    low_[k] = std::max(low_[k], place_.low[k]);
    high_[k] = std::min(high_[k], place_.high[k]);
  }

  void graph(Index k, const SurfacePoint& at) {
    const Index i = (k + 1) % 3, j = (k + 2) % 3;
    low_ = VectorXd::Constant(3, -std::numeric_limits<double>::infinity());
    high_ = -low_;
    range(i, at);
    range(j, at);
    for (const auto& [across, run] : {std::pair{i, j}, std::pair{j, i}}) {
      const bool round =
          place_.angle[static_cast<std::size_t>(across)] && std::abs(high_[across] - low_[across] - 2 * pi) < 1e-9;
      const int count = round ? spokes : rings;
      for (int line = 0; line <= count - (round ? 1 : 0); ++line) {
        std::vector<VectorXd> points;
        for (int s = 0; s <= points_of_line; ++s) {
          VectorXd q = here_;
          q[across] = low_[across] + (high_[across] - low_[across]) * line / count;
          q[run] = low_[run] + (high_[run] - low_[run]) * s / points_of_line;
          const auto there = f_(q);
          if (there && there->slope(0, k) != 0) q[k] -= there->psi[0] / there->slope(0, k);
          if (there && q.allFinite() && f_(q) && f_(q)->x.allFinite())
            points.push_back(q);
          else
            add(std::exchange(points, {}));
        }
        add(std::move(points));
      }
    }
  }

  /// For surfaces that are no graph over two coordinates: level lines in slices across each coordinate.
  void sliced() {
    const auto psi_at = [this](const VectorXd& q) {
      const auto p = f_(q);
      return p ? p->psi[0] : std::nan("");
    };
    const VectorXd reach = VectorXd::NullaryExpr(
        3, [this](Index k) { return place_.angle[static_cast<std::size_t>(k)] ? pi : 2.2 * place_.size; });
    low_ = (here_ - reach).cwiseMax(place_.low);
    high_ = (here_ + reach).cwiseMin(place_.high);
    if (const auto box = box_around(psi_at, low_, high_)) {
      std::tie(low_, high_) = *box;
    } else {
      for (Index k = 0; k < 3; ++k) {
        if (place_.angle[static_cast<std::size_t>(k)]) continue;
        low_[k] = std::max(place_.low[k], here_[k] - 1.2 * place_.size);
        high_[k] = std::min(place_.high[k], here_[k] + 1.2 * place_.size);
      }
    }
    for (Index k = 0; k < 3; ++k) {
      for (int s = 0; s < rings; ++s) {
        const double value = low_[k] + (high_[k] - low_[k]) * (s + 0.5) / rings;
        for (const std::vector<VectorXd>& line : level_lines(psi_at, low_, high_, k, value)) add(line);
      }
    }
  }

  void add(std::vector<VectorXd> points) {
    if (points.size() < 2) return;
    std::vector<Point> line;
    for (const VectorXd& q : points) {
      const auto at = f_(q);
      if (at && at->x.allFinite()) line.push_back(at->x);
    }
    if (line.size() != points.size()) return;
    lines_.push_back({std::move(line), false});
    net_.push_back(std::move(points));
  }
  /// Component of the unit normal towards the viewer.
  std::optional<double> facing(const VectorXd& q) const {
    const auto p = f_(q);
    if (!p) return std::nullopt;
    const Point n = normal(*p);
    return n.norm() > 0 ? std::optional(n.dot(view_.toward())) : std::nullopt;
  }
  CurveEquations seen_sideways() const {
    return [this](const VectorXd& q) -> std::optional<std::pair<VectorXd, MatrixXd>> {
      const auto p = f_(q);
      const auto g = facing(q);
      if (!p || !g) return std::nullopt;
      VectorXd value(2);
      MatrixXd slope(2, 3);
      value << p->psi[0], *g;
      slope.row(0) = p->slope.row(0);
      for (Index k = 0; k < 3; ++k) {
        VectorXd up = q, down = q;
        const double small = 1e-5 * tracer_.span(k);
        up[k] += small;
        down[k] -= small;
        const auto a = facing(up), b = facing(down);
        if (!a || !b) return std::nullopt;
        slope(1, k) = (*a - *b) / (2 * small);
      }
      return std::pair{value, slope};
    };
  }

  /// Silhouette, traced from points where lines of the net turn away from the viewer.
  void outline() {
    const CurveEquations equations = seen_sideways();
    std::vector<std::vector<Point>> found;
    VectorXd low = low_, high = high_;
    for (Index k = 0; k < 3; ++k) {
      if (place_.angle[static_cast<std::size_t>(k)] && high[k] - low[k] > 2 * pi - 1e-9) low[k] -= 7, high[k] += 7;
    }
    for (const std::vector<VectorXd>& line : net_) {
      for (std::size_t i = 1; i < line.size(); ++i) {
        const auto a = facing(line[i - 1]), b = facing(line[i]);
        if (!a || !b || (*a < 0) == (*b < 0)) continue;
        const auto start = tracer_.project_onto(equations, (line[i - 1] + line[i]) / 2, 12);
        if (!start || !tracer_.is_inside(*start, low, high)) continue;
        const Point here = f_(*start)->x;
        const auto near = [&](const Point& p) { return (p - here).norm() < 2 * tracer_.step(); };
        if (std::any_of(found.begin(), found.end(),
                        [&](const auto& other) { return std::any_of(other.begin(), other.end(), near); }))
          continue;
        found.push_back(tracer_.trace(equations, *start, low, high));
      }
    }
    for (std::vector<Point>& points : found) {
      if (points.size() > 2) lines_.push_back({std::move(points), true});
    }
  }

  const SurfaceFunction& f_;
  const SurfaceSetting& place_;
  const View& view_;
  CurveTracer tracer_;
  Index n_;
  VectorXd here_, low_, high_;
  Point x_;
  std::vector<SurfaceLine> lines_;
  std::vector<std::vector<VectorXd>> net_;
};

}  // namespace

std::vector<SurfaceLine> surface_lines(const SurfaceFunction& function, const SurfaceSetting& place, const View& view) {
  return Lines(function, place, view).draw();
}

}  // namespace eomgen::analysis
