// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/surfaces_at_start.hpp"

#include <map>
#include <stdexcept>

#include "linear/tape.hpp"

namespace eomgen::analysis {

using Eigen::Index;
using symbolic::Symbol;

std::vector<SurfaceLine> surfaces_at_start(const mechanics::Mechanics& m, const DrawnParts& parts,
                                           const run::Scene& scene, const std::vector<double>& values, const View& view,
                                           double size) {
  std::vector<SurfaceLine> result;
  for (const DrawnSurface& surface : parts.surfaces) {
    const auto n = static_cast<Index>(surface.coordinates.size()), bound = static_cast<Index>(surface.psi.size());
    std::map<std::uint32_t, double> at;  // of coordinates
    for (std::size_t k = 0; k < surface.others.size(); ++k) at[surface.others[k]] = values[surface.others_at[k]];
    SurfaceSetting place;
    place.q.resize(n);
    place.low.resize(n);
    place.high.resize(n);
    place.size = size;
    std::vector<Symbol> directions;
    for (Index k = 0; k < n; ++k) {
      const std::uint32_t c = surface.coordinates[static_cast<std::size_t>(k)];
      place.q[k] = values[surface.at + static_cast<std::size_t>(k)];
      place.low[k] = scene.lower[c];
      place.high[k] = scene.upper[c];
      place.angle.push_back(m.model->coordinates[c].unit.text == "rad");
      directions.push_back({SymbolKind::coordinate, c, 0});
    }
    std::vector<symbolic::Ref> roots = surface.psi;
    roots.insert(roots.end(), surface.position.begin(), surface.position.end());
    const linear::Tape tape(*m.dag, roots, directions);
    const SurfaceFunction function = [&](const Eigen::VectorXd& q) -> std::optional<SurfacePoint> {
      for (Index k = 0; k < n; ++k) at[surface.coordinates[static_cast<std::size_t>(k)]] = q[k];
      try {
        const auto found = tape.at<double>([&](const Symbol& s) -> double {
          switch (s.kind) {
            case SymbolKind::time: return scene.t0;
            case SymbolKind::coordinate: {
              const auto value = at.find(s.index);
              return s.order == 0 && value != at.end() ? value->second : std::nan("");
            }
            case SymbolKind::parameter: return scene.parameters[s.index];
            default: return s.kind == SymbolKind::integral ? 0 : std::nan("");  // integrals are 0 at the start
          }
        });
        SurfacePoint point{Eigen::VectorXd(bound), Eigen::MatrixXd(bound, n), Point::Zero(), Eigen::Matrix3Xd(3, n)};
        for (Index i = 0; i < bound + 3; ++i) {
          (i < bound ? point.psi[i] : point.x[i - bound]) = found.value[static_cast<std::size_t>(i)];
          for (Index k = 0; k < n; ++k)
            (i < bound ? point.slope(i, k) : point.turn(i - bound, k)) =
                found.jacobian(static_cast<std::size_t>(i), static_cast<std::size_t>(k));
        }
        return point;
      } catch (const std::domain_error&) {
        return std::nullopt;
      }
    };
    for (SurfaceLine& line : surface_lines(function, place, view)) result.push_back(std::move(line));
  }
  return result;
}

}  // namespace eomgen::analysis
