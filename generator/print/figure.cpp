// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/figure.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "print/latex_writer.hpp"

namespace eomgen::print {
namespace {

using Point = Figure::Point;

constexpr double shortest = 0.005;  // mm; shorter strokes are invisible

const char* thickness(Figure::Weight weight) {
  return weight == Figure::Weight::strong ? "1pt" : weight == Figure::Weight::plain ? "0.5pt" : "0.25pt";
}

// Avoids "-0.00", whose sign would come from rounding.
std::string written(double millimetres) {
  std::string text = fmt::format("{:.2f}", millimetres);
  return text == "-0.00" ? "0.00" : text;
}

// A box rotates about its left end, where the stroke begins.
std::string in_latex(Figure::Stroke stroke) {
  if (stroke.from[0] > stroke.to[0] || (stroke.from[0] == stroke.to[0] && stroke.from[1] > stroke.to[1]))
    std::swap(stroke.from, stroke.to);
  const double x = stroke.to[0] - stroke.from[0], y = stroke.to[1] - stroke.from[1], length = std::hypot(x, y);
  if (length < shortest) return "";
  return fmt::format("\\stroke{{{}}}{{{}}}{{{}}}{{{}}}{{{}}}\n", written(stroke.from[0]), written(stroke.from[1]),
                     written(std::atan2(y, x) * 180 / std::numbers::pi), written(length), thickness(stroke.weight));
}

}  // namespace

std::string figure_in_latex(const Figure& figure, const LatexWriter& text) {
  std::string result =
      "\\begin{center}\n\\setlength{\\unitlength}{1mm}\\small\n"
      "\\newcommand{\\stroke}[5]{\\put(#1,#2){\\rotatebox{#3}{\\rule[-0.5\\dimexpr#5\\relax]{#4mm}{#5}}}}\n";
  result += fmt::format("\\begin{{picture}}({},{})({},{})\n", written(figure.high[0] - figure.low[0]),
                        written(figure.high[1] - figure.low[1]), written(figure.low[0]), written(figure.low[1]));
  for (const Figure::Stroke& stroke : figure.strokes) result += in_latex(stroke);
  for (const Figure::Dot& dot : figure.dots) {
    result += fmt::format("\\put({},{}){{\\circle{}{{{}}}}}\n", written(dot.at[0]), written(dot.at[1]),
                          dot.filled ? "*" : "", written(dot.diameter));
  }
  for (const Figure::Label& label : figure.labels) {
    const std::string* name = std::get_if<std::string>(&label.text);
    result +=
        fmt::format("\\put({},{}){{\\makebox(0,0){{{}}}}}\n", written(label.at[0]), written(label.at[1]),
                    name ? "\\textbf{" + escape_latex(*name) + "}" : text.math(std::get<reading::Formula>(label.text)));
  }
  return result + "\\end{picture}\n\\end{center}\n";
}

}  // namespace eomgen::print
