// SPDX-License-Identifier: GPL-3.0-or-later
// A plane drawing for a document. In: strokes, dots and labels in millimetres. Out: LaTeX with the picture environment
// and rotated rules (graphicx), which every engine supports.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "reading/formula.hpp"

namespace eomgen::print {

class LatexWriter;

struct Figure {
  using Point = std::array<double, 2>;  // x to the right, y upwards
  enum class Weight { fine, plain, strong };

  struct Stroke {
    Point from, to;
    Weight weight;
  };
  struct Dot {
    Point at;
    double diameter;  // at most 4: LaTeX has no larger ones
    bool filled;
  };
  struct Label {
    Point at;                                          // centre of the label
    std::variant<std::string, reading::Formula> text;  // a name of the model, or a formula
  };

  Point low{}, high{};  // corners of the bounding box
  std::vector<Stroke> strokes;
  std::vector<Dot> dots;
  std::vector<Label> labels;
};

/// LaTeX of the figure, centred between paragraphs.
std::string figure_in_latex(const Figure& figure, const LatexWriter& text);

}  // namespace eomgen::print
