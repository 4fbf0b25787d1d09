// SPDX-License-Identifier: MIT
// A line plot as a self-contained SVG document. In: named series, labels, linear or logarithmic axes. Out: a string.
// A curve that coincides with an earlier one is dashed, and the legend says so.
// Values that cannot be drawn (not finite, beyond 1e300, not positive on a logarithmic axis) interrupt the line. All
// text is escaped.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "eom/output/axis.hpp"

namespace eom {

/// One curve of a plot.
struct PlotSeries {
  std::string name;          // empty: not in the legend
  std::vector<double> x, y;  // of equal length
  bool line = true;
  bool markers = false;
  double error_at_end = 0;  // of the last value: drawn as a bar if longer than the line width
};

/// A mark on the horizontal axis, such as an event.
struct PlotMark {
  double x = 0;
  std::string name;
};

/// Contents and size (px) of a plot.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotSeries> series;
  bool log_x = false, log_y = false;
  bool equal_scales = false;  // equal units on both axes, for paths in space (linear axes only)
  int width = 760, height = 460;
  std::vector<PlotMark> marks;
};

namespace plot {

// dark enough on white, and as distinguishable as eight colours can be with any kind of colour vision
inline constexpr std::array<const char*, 8> colours{"#0b6ab0", "#d1495b", "#1f8a5b", "#e08e0b",
                                                    "#7a4fb5", "#12889a", "#a0527a", "#5b6770"};
inline constexpr std::array<const char*, 3> dashes{"", "7 4", "2 3"};  // for the second and third eight

/// The text with the special characters of XML escaped.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;  // XML forbids most control characters
    }
  }
  return out;
}

/// A coordinate in the drawing, rounded to a hundredth.
inline std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f", std::clamp(value, -1e6, 1e6));
  std::string out = text;
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

/// Builds the document from axes to legend.
class Drawing {
 public:
  /// Throws std::invalid_argument if the legend leaves no space for the axes.
  explicit Drawing(const Plot& given) : plot_(given) {
    find_ranges();
    find_coinciding();
    place_legend();
    const double legend_height = legend_rows_ > 0 ? 20.0 * legend_rows_ + 4 : 0;
    left_ = 78;
    right_ = plot_.width - 22;
    top_ = (plot_.title.empty() ? 16 : 44) + legend_height;
    const double below = plot_.x_label.empty() ? 36 : 56;
    height_ = plot_.height;
    // A legend of many rows increases the height of the drawing; it does not shrink the axes.
    if (legend_rows_ > 1) height_ = std::max(height_, static_cast<int>(top_ + least_height + below));
    bottom_ = height_ - below;
    if (right_ - left_ < 40 || bottom_ - top_ < 40) throw std::invalid_argument("svg plot: too small for its legend");
    make_axes();
    if (!note(y_).empty()) top_ += 16;
  }

  /// The SVG document.
  std::string document() {
    open();
    draw_grid();
    draw_marks();
    for (std::size_t k = 0; k < plot_.series.size(); ++k) draw_series(k);
    draw_frame_and_labels();
    draw_legend();
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void include(double value) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  };

  void find_ranges() {
    for (const PlotSeries& series : plot_.series) {
      if (series.x.size() != series.y.size())
        throw std::invalid_argument("svg plot: series '" + series.name + "' has x and y of different lengths");
      for (std::size_t i = 0; i < series.x.size(); ++i) {
        if (!is_showable(series.x[i], plot_.log_x) || !is_showable(series.y[i], plot_.log_y)) continue;
        x_range_.include(series.x[i]);
        y_range_.include(series.y[i]);
      }
    }
  }

  /// Finds for each curve the first one that it covers: they differ by less than a line width everywhere.
  void find_coinciding() {
    coinciding_.assign(plot_.series.size(), none);
    for (std::size_t k = 1; k < plot_.series.size(); ++k) {
      for (std::size_t j = 0; j < k && coinciding_[k] == none; ++j) {
        if (coinciding_[j] == none && coincide(plot_.series[j], plot_.series[k])) coinciding_[k] = j;
      }
    }
  }

  bool coincide(const PlotSeries& a, const PlotSeries& b) const {
    if (!a.line || !b.line || a.name.empty() || b.name.empty() || a.x.empty() || a.x.size() != b.x.size()) return false;
    const auto near = [](double u, double v, const Range& range, bool log) {
      return u == v || (!log && std::abs(u - v) < line_width / 400 * (range.high - range.low)) ||
             (std::isnan(u) && std::isnan(v));
    };
    for (std::size_t i = 0; i < a.x.size(); ++i) {
      if (!near(a.x[i], b.x[i], x_range_, plot_.log_x) || !near(a.y[i], b.y[i], y_range_, plot_.log_y)) return false;
    }
    return true;
  }

  std::string legend_text(std::size_t k) const {
    const std::string& name = plot_.series[k].name;
    return coinciding_[k] == none ? name : name + " (as " + plot_.series[coinciding_[k]].name + ")";
  }

  void make_axes() {
    Range x = x_range_, y = y_range_;
    if (plot_.equal_scales && !plot_.log_x && !plot_.log_y && x.low <= x.high) equalise(x, y);
    x_ = make_axis(x.low, x.high, plot_.log_x, static_cast<int>((right_ - left_) / 90));
    y_ = make_axis(y.low, y.high, plot_.log_y, static_cast<int>((bottom_ - top_) / 50));
  }

  /// Widens the shorter range about its middle until units have the same length on both axes.
  void equalise(Range& x, Range& y) const {
    const double per_x = (x.high - x.low) / (right_ - left_);
    const double per_y = (y.high - y.low) / (bottom_ - top_);
    const double per = std::max(per_x, per_y);
    const auto widen = [per](Range& range, double pixels) {
      const double middle = range.low + 0.5 * (range.high - range.low);
      range = {middle - 0.5 * per * pixels, middle + 0.5 * per * pixels};
    };
    widen(x, right_ - left_);
    widen(y, bottom_ - top_);
  }

  double x_at(double value) const { return left_ + x_.fraction(value) * (right_ - left_); }
  double y_at(double value) const { return bottom_ - y_.fraction(value) * (bottom_ - top_); }

  void open() {
    const std::string width = std::to_string(plot_.width);
    const std::string height = std::to_string(height_);
    out_ += "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
            "\" viewBox=\"0 0 " + width + " " + height +
            "\" role=\"img\" font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\" font-size=\"12.5\" "
            "fill=\"#333\">\n";
    if (!plot_.title.empty()) out_ += "<title>" + escaped(plot_.title) + "</title>\n";
    out_ += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  }

  void line(double x1, double y1, double x2, double y2, const char* style) {
    out_ += "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
            "\" " + style + "/>\n";
  }

  void text(double x, double y, const char* style, const std::string& content) {
    out_ += "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + style + ">" + content + "</text>\n";
  }

  static std::string with_minus(std::string label) {
    if (!label.empty() && label[0] == '-') label.replace(0, 1, "\u2212");
    return label;
  }

  static std::string power_of_ten(const std::string& exponent) {
    return "10<tspan dy=\"-5\" font-size=\"9.5\">" + with_minus(exponent) + "</tspan>";
  }

  static std::string tick_text(const Tick& tick) {
    if (tick.exponent.empty()) return with_minus(tick.label);
    return (tick.label.empty() ? "" : with_minus(tick.label) + "\u00b7") + power_of_ten(tick.exponent);
  }

  /// The parts factored out of the labels of an axis: "2.5 + ... 10^-7".
  static std::string note(const Axis& axis) {
    std::string out;
    if (axis.power != 0) out = "\u00d7 " + power_of_ten(std::to_string(axis.power));
    if (axis.offset_label.empty()) return out;
    const std::string sign = axis.offset < 0 ? "\u2212 " + axis.offset_label.substr(1) : "+ " + axis.offset_label;
    return out + (out.empty() ? sign : "<tspan dy=\"5\">\u00a0" + sign + "</tspan>");
  }

  void draw_grid() {
    constexpr const char* major = "stroke=\"#e3e6ea\"";
    constexpr const char* minor = "stroke=\"#f3f4f6\"";
    for (const bool drawing_major : {false, true}) {
      for (const Tick& tick : x_.ticks)
        if (tick.minor != drawing_major)
          line(x_at(tick.value), top_, x_at(tick.value), bottom_, drawing_major ? major : minor);
      for (const Tick& tick : y_.ticks)
        if (tick.minor != drawing_major)
          line(left_, y_at(tick.value), right_, y_at(tick.value), drawing_major ? major : minor);
    }
    for (const Tick& tick : x_.ticks)
      if (!tick.minor) text(x_at(tick.value), bottom_ + 18, "text-anchor=\"middle\"", tick_text(tick));
    for (const Tick& tick : y_.ticks)
      if (!tick.minor) text(left_ - 8, y_at(tick.value) + 4.3, "text-anchor=\"end\"", tick_text(tick));
    if (!note(x_).empty()) text(right_, bottom_ + 34, "text-anchor=\"end\" font-size=\"11.5\"", note(x_));
    if (!note(y_).empty()) text(left_, top_ - 7, "font-size=\"11.5\"", note(y_));
  }

  void draw_frame_and_labels() {
    line(left_, bottom_, right_, bottom_, "stroke=\"#6b7280\" stroke-width=\"1.2\"");
    line(left_, top_, left_, bottom_, "stroke=\"#6b7280\" stroke-width=\"1.2\"");
    if (!plot_.title.empty())
      text(left_, 28, "font-size=\"17\" font-weight=\"600\" fill=\"#111\"", escaped(plot_.title));
    if (!plot_.x_label.empty())
      text(0.5 * (left_ + right_), height_ - 14, "text-anchor=\"middle\" font-size=\"13.5\"", escaped(plot_.x_label));
    if (!plot_.y_label.empty()) {
      const double middle = 0.5 * (top_ + bottom_);
      text(0, 0,
           ("text-anchor=\"middle\" font-size=\"13.5\" transform=\"translate(18 " + number(middle) + ") rotate(-90)\"")
               .c_str(),
           escaped(plot_.y_label));
    }
  }

  std::string stroke_of(std::size_t k) const {
    const std::string dash = coinciding_[k] == none ? dashes[(k / colours.size()) % dashes.size()] : "8 8";
    return std::string("stroke=\"") + colours[k % colours.size()] + "\" stroke-width=\"1.9\"" +
           (dash.empty() ? "" : " stroke-dasharray=\"" + dash + "\"");
  }

  /// Draws the marks within the axis; of many only as many as can be distinguished.
  void draw_marks() {
    double last = -1e300;
    for (const PlotMark& mark : plot_.marks) {
      if (!x_.shows(mark.x)) continue;
      const double x = x_at(mark.x);
      if (x < left_ - 0.5 || x > right_ + 0.5 || std::abs(x - last) < 1) continue;
      out_ += "<line x1=\"" + number(x) + "\" y1=\"" + number(top_) + "\" x2=\"" + number(x) + "\" y2=\"" +
              number(bottom_) + "\" stroke=\"#8b949e\" stroke-dasharray=\"2 4\"><title>" + escaped(mark.name) +
              "</title></line>\n";
      last = x;
    }
  }

  /// Draws the estimated error of the last value if it exceeds the line width.
  void draw_error(const PlotSeries& series, std::size_t k) {
    if (!(series.error_at_end > 0) || series.x.empty() || !x_.shows(series.x.back()) || !y_.shows(series.y.back()))
      return;
    const double x = x_at(series.x.back()), high = y_at(std::min(series.y.back() + series.error_at_end, 1e300)),
                 low = y_at(std::max(series.y.back() - series.error_at_end, -1e300));
    if (!(low - high > 2 * line_width)) return;
    const std::string top = number(std::max(high, top_)), bottom = number(std::min(low, bottom_)), left = number(x - 4),
                      right = number(x + 4), middle = number(x);
    out_ += "<path d=\"M" + middle + " " + top + "V" + bottom + "M" + left + " " + top + "H" + right + "M" + left +
            " " + bottom + "H" + right + "\" fill=\"none\" " + stroke_of(k) + "><title>estimated error of " +
            escaped(series.name) + "</title></path>\n";
  }

  /// Points closer than a third of a pixel to the previous one are skipped, so that long runs give small files.
  void draw_series(std::size_t k) {
    const PlotSeries& series = plot_.series[k];
    std::string path;
    std::string marks;
    bool pen_down = false;
    double last_x = 0;
    double last_y = 0;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!x_.shows(series.x[i]) || !y_.shows(series.y[i])) {
        pen_down = false;
        continue;
      }
      const double x = x_at(series.x[i]);
      const double y = y_at(series.y[i]);
      const bool ends = i + 1 == series.x.size();
      if (pen_down && !ends && std::abs(x - last_x) < 0.33 && std::abs(y - last_y) < 0.33) continue;
      path += (pen_down ? "L" : "M") + number(x) + " " + number(y);
      marks += "<circle cx=\"" + number(x) + "\" cy=\"" + number(y) + "\" r=\"3.2\"/>";
      pen_down = true;
      last_x = x;
      last_y = y;
    }
    if (series.line && !path.empty())
      out_ += "<path d=\"" + path + "\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" " +
              stroke_of(k) + "/>\n";
    if (series.line) draw_error(series, k);
    if (series.markers && !marks.empty())
      out_ += std::string("<g stroke=\"#fff\" fill=\"") + colours[k % colours.size()] + "\">" + marks + "</g>\n";
  }

  /// Places legend entries in rows above the plot. Text widths are estimated.
  void place_legend() {
    double x = 0;
    for (std::size_t k = 0; k < plot_.series.size(); ++k) {
      if (plot_.series[k].name.empty()) continue;
      const double width = 44 + 7.2 * static_cast<double>(characters(legend_text(k)));
      if (legend_rows_ == 0 || x + width > plot_.width - 100) {
        ++legend_rows_;
        x = 0;
      }
      legend_.push_back({k, x, legend_rows_ - 1});
      x += width;
    }
  }

  static std::size_t characters(const std::string& text) {  // in UTF-8: bytes that are not continuation bytes
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  }

  void draw_legend() {
    const double first = plot_.title.empty() ? 20 : 48;
    for (const Entry& entry : legend_) {
      const PlotSeries& series = plot_.series[entry.series];
      const double x = left_ + entry.x;
      const double y = first + 20 * entry.row;
      if (series.line) line(x, y, x + 22, y, stroke_of(entry.series).c_str());
      if (series.markers)
        out_ += "<circle cx=\"" + number(x + 11) + "\" cy=\"" + number(y) + "\" r=\"3.2\" fill=\"" +
                colours[entry.series % colours.size()] + "\"/>\n";
      text(x + 28, y + 4.3, "", escaped(legend_text(entry.series)));
    }
  }

  struct Entry {
    std::size_t series;
    double x;
    int row;
  };

  static constexpr double least_height = 160;  // of the axes
  static constexpr double line_width = 1.9;
  static constexpr auto none = static_cast<std::size_t>(-1);

  const Plot& plot_;
  int height_ = 0;
  double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;
  Range x_range_, y_range_;
  std::vector<std::size_t> coinciding_;  // per series: the earlier one that it covers, or none
  Axis x_, y_;
  std::vector<Entry> legend_;
  int legend_rows_ = 0;
  std::string out_;
};

}  // namespace plot

/// The plot as an SVG document. Throws std::invalid_argument if x and y of a series have different lengths.
inline std::string svg(const Plot& given) { return plot::Drawing(given).document(); }

}  // namespace eom
