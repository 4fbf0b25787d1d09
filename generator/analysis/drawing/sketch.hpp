// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes of a drawing, in millimetres on paper. In: points in space and a view. Out: a Figure.
#pragma once

#include <functional>
#include <vector>

#include "analysis/drawing/solids.hpp"
#include "analysis/drawing/view.hpp"
#include "print/figure.hpp"

namespace eomgen::analysis {

class Sketch {
 public:
  using Weight = print::Figure::Weight;

  /// `extent`: points that must fit on the paper, at least one.
  Sketch(const View& view, const std::vector<Point>& extent);

  PlanePoint on_paper(const Point& r) const { return scale_ * (view_(r) - middle_); }
  const View& view() const { return view_; }
  double scale() const { return scale_; }  // millimetres per unit of length

  void line(const PlanePoint& from, const PlanePoint& to, Weight weight);
  void line(const Point& from, const Point& to, Weight weight) { line(on_paper(from), on_paper(to), weight); }
  void dashes(const PlanePoint& from, const PlanePoint& to);
  void path(const std::vector<PlanePoint>& points, Weight weight);
  /// A path given by points in space, simplified to as few strokes as look the same.
  void curve(const std::vector<Point>& points, Weight weight);
  void arrow(const PlanePoint& from, const PlanePoint& to, Weight weight);
  void dot(const PlanePoint& at, double diameter, bool filled);
  void spring(const Point& a, const Point& b);
  void damper(const Point& a, const Point& b);
  /// `world`: transformation from body axes to space. Edges that the solid itself hides are not drawn.
  void solid(const Solid& solid, const std::function<Point(const Point&)>& world);
  /// Places a label near `at` with the least overlap. finish() places labels in the order of the calls, after all
  /// strokes.
  void label(const PlanePoint& at, std::variant<std::string, reading::Formula> text);

  PlanePoint low() const { return low_; }
  PlanePoint high() const { return high_; }

  print::Figure finish();

 private:
  struct Wanted {
    PlanePoint at;
    std::variant<std::string, reading::Formula> text;
  };
  /// Draws all edges of a solid that is not convex.
  void wire(const Solid& solid, const std::function<Point(const Point&)>& world);
  void cover(const PlanePoint& p);
  void place_labels();

  const View& view_;
  PlanePoint middle_, low_, high_;
  double scale_;
  print::Figure figure_;
  std::vector<Wanted> wanted_;
};

}  // namespace eomgen::analysis
