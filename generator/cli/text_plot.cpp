// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/text_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eomgen::cli {
namespace {

constexpr std::size_t rows = 16, margin = 11;  // width of the labels on the left
constexpr const char* letters = "*+ox#@%&=~abcdefghijklmnpqrstuvwyz";

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// Widens an empty range, so that a constant is a line in the middle.
  void close() {
    if (!(low <= high)) low = high = 0;
    const double least = 1e-9 * std::max(std::fabs(low), std::fabs(high));
    if (high - low > least) return;
    const double half = std::max(0.5 * std::fabs(low), 0.5);
    low -= half;
    high += half;
  }
  /// Index of the cell that contains `value`, 0 .. cells - 1.
  std::size_t cell(double value, std::size_t cells) const {
    const double place = (value - low) / (high - low) * static_cast<double>(cells - 1);
    return static_cast<std::size_t>(std::clamp(std::round(place), 0.0, static_cast<double>(cells - 1)));
  }
};

}  // namespace

TextPlot text_plot(const eom::Plot& plot) {
  TextPlot result{plot.y_label, plot.x_label, {}, {}, plot.log_x, plot.log_y};
  for (const eom::PlotSeries& series : plot.series) result.curves.push_back({series.name, &series.x, &series.y});
  for (const eom::PlotMark& mark : plot.marks) result.marks.push_back(mark.x);
  return result;
}

std::string render_text_plot(const TextPlot& plot, std::size_t columns) {
  const auto place_of = [](double value, bool logarithmic) { return logarithmic ? std::log10(value) : value; };
  const auto label = [](double place, bool logarithmic) {
    return fmt::format("{:.{}g}", logarithmic ? std::pow(10, place) : place, logarithmic ? 2 : 4);
  };
  const std::size_t wide = std::max<std::size_t>(columns, margin + 24) - margin - 2;
  Range x, y;
  const auto for_each_point = [&](const TextCurve& curve, auto&& take) {
    for (std::size_t i = 0; i < curve.x->size(); ++i) {
      const double a = place_of((*curve.x)[i], plot.log_x), b = place_of((*curve.y)[i], plot.log_y);
      if (std::isfinite(a) && std::isfinite(b)) take(a, b);
    }
  };
  for (const TextCurve& curve : plot.curves)
    for_each_point(curve, [&](double a, double b) { x.include(a), y.include(b); });
  x.close();
  y.close();
  std::vector<std::string> field(rows, std::string(wide, ' '));
  for (const double mark : plot.marks) {
    if (mark < x.low || mark > x.high) continue;
    for (std::string& line : field) line[x.cell(mark, wide)] = ':';
  }
  const std::size_t known = std::string(letters).size();
  std::vector<std::string> legend;  // lines
  for (std::size_t k = 0; k < plot.curves.size(); ++k) {
    const char letter = letters[k % known];
    if (!plot.curves[k].name.empty()) {
      const std::string entry = fmt::format("{} {}", letter, plot.curves[k].name);
      if (legend.empty() || legend.back().size() + 3 + entry.size() > columns)
        legend.push_back(entry);
      else
        legend.back() += "   " + entry;
    }
    for_each_point(plot.curves[k],
                   [&](double a, double b) { field[rows - 1 - y.cell(b, rows)][x.cell(a, wide)] = letter; });
  }
  std::string text = plot.y_label + "\n";
  for (const std::string& line : legend) text += line + "\n";
  for (std::size_t r = 0; r < rows; ++r) {
    const bool is_labelled = r % 5 == 0;
    const double value = y.high - (y.high - y.low) * static_cast<double>(r) / static_cast<double>(rows - 1);
    std::string line = fmt::format(
        "{:>{}} {}{}", is_labelled ? label(std::fabs(value) < 1e-12 * (y.high - y.low) ? 0.0 : value, plot.log_y) : "",
        margin - 1, is_labelled ? '+' : '|', field[r]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  text += std::string(margin, ' ') + "+" + std::string(wide, '-') + "\n";
  const std::string low = label(x.low, plot.log_x), high = label(x.high, plot.log_x);
  std::string below = std::string(margin + 1, ' ') + low;
  const std::size_t end = margin + 1 + wide - high.size(),
                    middle = margin + 1 + (wide - std::min(wide, plot.x_label.size())) / 2;
  if (below.size() + 1 < middle && middle + plot.x_label.size() + 1 < end)
    below += std::string(middle - below.size(), ' ') + plot.x_label;
  if (below.size() < end) below += std::string(end - below.size(), ' ') + high;
  return text + below + "\n";
}

}  // namespace eomgen::cli
