// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/level_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace eomgen::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int cells = 32, blocks = 24;

bool cross(double a, double b) { return std::isfinite(a) && std::isfinite(b) && (a < 0) != (b < 0); }

/// A stroke between two edges of the grid. An edge is given by its start and its direction.
using Edge = std::array<int, 3>;
using Strokes = std::multimap<Edge, Edge>;

void take_out(Strokes& strokes, const Edge& from, const Edge& to) {
  const auto [begin, end] = strokes.equal_range(from);
  const auto found = std::find_if(begin, end, [&](const auto& other) { return other.second == to; });
  if (found != end) strokes.erase(found);
}

}  // namespace

std::vector<std::vector<VectorXd>> level_lines(const Field& f, const VectorXd& low, const VectorXd& high, Index k,
                                               double value) {
  const Index i = (k + 1) % 3, j = (k + 2) % 3;
  const auto at = [&](double a, double b) {
    VectorXd q(3);
    q[k] = value;
    q[i] = low[i] + (high[i] - low[i]) * a / cells;
    q[j] = low[j] + (high[j] - low[j]) * b / cells;
    return q;
  };
  std::vector<std::vector<double>> values(cells + 1, std::vector<double>(cells + 1));
  for (int a = 0; a <= cells; ++a) {
    for (int b = 0; b <= cells; ++b) values[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = f(at(a, b));
  }
  const auto of = [&](int a, int b) { return values[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)]; };
  Strokes strokes;
  for (int a = 0; a < cells; ++a) {
    for (int b = 0; b < cells; ++b) {
      std::vector<Edge> found;
      if (cross(of(a, b), of(a + 1, b))) found.push_back({a, b, 0});
      if (cross(of(a + 1, b), of(a + 1, b + 1))) found.push_back({a + 1, b, 1});
      if (cross(of(a, b + 1), of(a + 1, b + 1))) found.push_back({a, b + 1, 0});
      if (cross(of(a, b), of(a, b + 1))) found.push_back({a, b, 1});
      for (std::size_t e = 0; e + 1 < found.size(); e += 2) {
        strokes.emplace(found[e], found[e + 1]);
        strokes.emplace(found[e + 1], found[e]);
      }
    }
  }
  // Bisection: there is one sign change between the ends.
  const auto point = [&](const Edge& edge) {
    double from = 0, to = 1;
    const bool first = of(edge[0], edge[1]) < 0;
    const auto on = [&](double s) { return edge[2] == 0 ? at(edge[0] + s, edge[1]) : at(edge[0], edge[1] + s); };
    for (int n = 0; n < 30; ++n) {
      const double middle = (from + to) / 2;
      ((f(on(middle)) < 0) == first ? from : to) = middle;
    }
    return on((from + to) / 2);
  };
  std::vector<std::vector<VectorXd>> result;
  while (!strokes.empty()) {
    // Start at an end with a single stroke if there is one; the remaining lines are closed.
    auto begin =
        std::find_if(strokes.begin(), strokes.end(), [&](const auto& s) { return strokes.count(s.first) == 1; });
    if (begin == strokes.end()) begin = strokes.begin();
    Edge now = begin->first;
    std::vector<VectorXd> line{point(now)};
    for (auto next = strokes.find(now); next != strokes.end(); next = strokes.find(now)) {
      const Edge there = next->second;
      take_out(strokes, now, there);
      take_out(strokes, there, now);
      now = there;
      line.push_back(point(now));
    }
    result.push_back(std::move(line));
  }
  return result;
}

std::optional<std::pair<VectorXd, VectorXd>> box_around(const Field& f, const VectorXd& low, const VectorXd& high) {
  VectorXd least = high, most = low;
  const VectorXd cell = (high - low) / blocks;
  std::optional<bool> outside;
  for (int a = 0; a <= blocks; ++a) {
    for (int b = 0; b <= blocks; ++b) {
      for (int c = 0; c <= blocks; ++c) {
        VectorXd q(3);
        q << low[0] + a * cell[0], low[1] + b * cell[1], low[2] + c * cell[2];
        const double value = f(q);
        if (!std::isfinite(value)) continue;
        const bool border = a == 0 || b == 0 || c == 0 || a == blocks || b == blocks || c == blocks;
        if (!outside) outside = value < 0;
        if ((value < 0) == *outside) continue;
        if (border) return std::nullopt;
        least = least.cwiseMin(q - cell);
        most = most.cwiseMax(q + cell);
      }
    }
  }
  if ((most.array() < least.array()).any()) return std::nullopt;
  return std::pair{least, most};
}

}  // namespace eomgen::analysis
