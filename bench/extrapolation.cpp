// SPDX-License-Identifier: GPL-3.0-or-later
#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "published_equations.hpp"

namespace published {

Quad number(const std::string& decimal) {
  if (decimal == "2 pi") return 2 * M_PIq;
  return strtoflt128(decimal.c_str(), nullptr);
}

std::string text(Quad x, int digits) {
  char buffer[64];
  quadmath_snprintf(buffer, sizeof buffer, "%.*Qe", digits - 1, x);
  return buffer;
}

namespace {

using Rhs = std::function<void(Quad t, const State& x, State& dx)>;

/// Gragg's modified midpoint rule over H in n steps, n even. Its error has an expansion in even powers of H/n.
State midpoint(const Rhs& rhs, const State& x, const State& slope, Quad t, Quad H, int n) {
  const std::size_t size = x.size();
  const Quad h = H / n;
  State before = x, at(size), dx(size);
  for (std::size_t i = 0; i < size; ++i) at[i] = x[i] + h * slope[i];
  for (int k = 1; k < n; ++k) {
    rhs(t + k * h, at, dx);
    for (std::size_t i = 0; i < size; ++i) {
      const Quad next = before[i] + 2 * h * dx[i];
      before[i] = at[i];
      at[i] = next;
    }
  }
  rhs(t + H, at, dx);
  for (std::size_t i = 0; i < size; ++i) at[i] = (at[i] + before[i] + h * dx[i]) / 2;
  return at;
}

struct Attempt {
  State x;
  Quad error;
};

/// Extrapolation over 2, 4, 6, .. steps (Aitken and Neville).
Attempt step(const Rhs& rhs, const State& x, Quad t, Quad H, int columns, const State& scale) {
  State slope(x.size());
  rhs(t, x, slope);
  std::vector<State> row, last;
  for (int j = 0; j < columns; ++j) {
    last = std::move(row);
    row = {midpoint(rhs, x, slope, t, H, 2 * (j + 1))};
    for (int k = 1; k <= j; ++k) {
      const Quad ratio = static_cast<Quad>(j + 1) / static_cast<Quad>(j + 1 - k), factor = 1 / (ratio * ratio - 1);
      State next = row.back();
      for (std::size_t i = 0; i < x.size(); ++i)
        next[i] += (next[i] - last[static_cast<std::size_t>(k - 1)][i]) * factor;
      row.push_back(std::move(next));
    }
  }
  Quad error = 0;
  const State& best = row.back();
  const State& second = row[row.size() - 2];
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Quad size = fmaxq(scale[i], fabsq(best[i]));
    if (size > 0) error = fmaxq(error, fabsq(best[i] - second[i]) / size);
  }
  return {best, error};
}

}  // namespace

State integrate(const Rhs& rhs, State x, Quad t1, int columns, Quad tolerance) {
  Quad t = 0, H = t1 / 100;
  State scale = x;
  const auto note_sizes = [&] {
    Quad largest = 0;
    for (const Quad value : x) largest = fmaxq(largest, fabsq(value));
    for (std::size_t i = 0; i < x.size(); ++i)
      scale[i] = fmaxq(fmaxq(scale[i], fabsq(x[i])), 1e-2Q * largest);  // excludes components that pass through 0
  };
  for (Quad& s : scale) s = 0;
  note_sizes();
  for (int steps = 0; t < t1; ++steps) {
    if (steps > 2000000 || H < 1e-12Q * t1) throw std::runtime_error("steps become too short or too many");
    const bool last = t + H >= t1;
    const Quad length = last ? t1 - t : H;
    const Attempt tried = step(rhs, x, t, length, columns, scale);
    const bool bad = !(tried.error <= tolerance) || isnanq(tried.error);
    const Quad wanted = isnanq(tried.error) || isinfq(tried.error)
                            ? 1e-3Q
                            : 0.9Q * powq(tolerance / fmaxq(tried.error, 1e-60Q), 1.0Q / (2 * columns - 1));
    H = length * fminq(fmaxq(wanted, 0.1Q), 2);
    if (bad) continue;
    t = last ? t1 : t + length;
    x = tried.x;
    note_sizes();
  }
  return x;
}

}  // namespace published
