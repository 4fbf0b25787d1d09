// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture/svg_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <eom/output/decimal.hpp>
#include <numbers>
#include <stdexcept>

#include "cli/picture/stroke_font.hpp"

namespace eomgen::cli {
namespace {

using Colour = std::array<double, 3>;
using Point = std::pair<double, double>;

/// Attributes of one tag, as text.
class Tag {
 public:
  explicit Tag(const std::string& text) : text_(text) {}
  std::string name() const { return text_.substr(0, text_.find_first_of(" />")); }
  std::string get(const std::string& key) const {
    const std::size_t at = text_.find(" " + key + "=\"");
    if (at == std::string::npos) return "";
    const std::size_t begin = at + key.size() + 3;
    return text_.substr(begin, text_.find('"', begin) - begin);
  }
  double number(const std::string& key, double otherwise = 0) const {
    const std::string value = get(key);
    double result = value.empty() ? otherwise : 0;
    eom::decimals::read_decimal(value, result);
    return result;
  }

 private:
  std::string text_;
};

Colour colour_of(const std::string& text, const Colour& otherwise) {
  if (text.size() != 4 && text.size() != 7) return otherwise;
  const std::size_t digits = text.size() == 7 ? 2 : 1;
  Colour colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string part = text.substr(1 + k * digits, digits);
    colour[k] = static_cast<double>(std::strtol((digits == 2 ? part : part + part).c_str(), nullptr, 16));
  }
  return colour;
}

class Painter {
 public:
  Painter(double width, double height, double scale) : scale_(scale) {
    picture_.width = static_cast<std::size_t>(std::lround(width * scale));
    picture_.height = static_cast<std::size_t>(std::lround(height * scale));
    picture_.rgb.assign(3 * picture_.width * picture_.height, 255);
  }
  void shift(double y) { y_ = y; }
  Picture take() { return std::move(picture_); }

  void line(Point a, Point b, double width, const Colour& colour) {
    a = placed(a);
    b = placed(b);
    const double half = std::max(0.5, 0.5 * width * scale_), dx = b.first - a.first, dy = b.second - a.second,
                 squared = dx * dx + dy * dy;
    each(
        std::min(a.first, b.first) - half, std::max(a.first, b.first) + half, std::min(a.second, b.second) - half,
        std::max(a.second, b.second) + half,
        [&](double x, double y) {
          const double s = squared > 0 ? std::clamp(((x - a.first) * dx + (y - a.second) * dy) / squared, 0.0, 1.0) : 0;
          return half + 0.5 - std::hypot(x - a.first - s * dx, y - a.second - s * dy);
        },
        colour);
  }
  void rectangle(Point corner, double width, double height, const Colour& colour) {
    const Point a = placed(corner), b = placed({corner.first + width, corner.second + height});
    each(
        a.first, b.first, a.second, b.second,
        [&](double x, double y) {
          return 0.5 + std::min({x - a.first, b.first - x, y - a.second, b.second - y});
        },
        colour);
  }
  void disk(Point centre, double radius, const Colour& colour) {
    centre = placed(centre);
    radius *= scale_;
    each(
        centre.first - radius, centre.first + radius, centre.second - radius, centre.second + radius,
        [&](double x, double y) { return radius + 0.5 - std::hypot(x - centre.first, y - centre.second); }, colour);
  }
  /// A polyline in dashes, the first pattern from its beginning. Segments longer than any picture, and dashes too short
  /// to be seen, are drawn solid.
  void polyline(const std::vector<Point>& points, double width, const std::vector<double>& dashes,
                const Colour& colour) {
    if (points.size() == 1) line(points[0], points[0], width, colour);
    const bool dashed = !dashes.empty() && *std::min_element(dashes.begin(), dashes.end()) >= shortest_dash;
    std::size_t dash = 0;
    double left = dashed ? dashes[0] : 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double dx = points[i].first - points[i - 1].first, dy = points[i].second - points[i - 1].second,
                   length = std::hypot(dx, dy);
      if (!dashed || !(length < farthest)) {
        line(points[i - 1], points[i], width, colour);
        continue;
      }
      const auto at = [&](double s) {
        return Point{points[i - 1].first + dx * s / length, points[i - 1].second + dy * s / length};
      };
      double s = 0;
      for (; left <= length - s; left = dashes[dash]) {  // each turn ends one dash, so rounding cannot stop it
        if (dash % 2 == 0) line(at(s), at(s + left), width, colour);
        s += left;
        dash = (dash + 1) % dashes.size();
      }
      if (dash % 2 == 0 && s < length) line(at(s), at(length), width, colour);
      left -= length - s;
    }
  }

 private:
  static constexpr double farthest = 1e5;  // pixels; nothing beyond is seen
  static constexpr double shortest_dash = 0.1;
  Point placed(Point p) const {
    return {std::clamp(p.first * scale_, -farthest, farthest),
            std::clamp((p.second + y_) * scale_, -farthest, farthest)};
  }

  template <typename Coverage>
  void each(double left, double right, double top, double bottom, const Coverage& coverage, const Colour& colour) {
    const auto first = [](double value) { return static_cast<std::size_t>(std::max(0.0, std::floor(value - 1))); };
    const auto last = [](double value, std::size_t end) {
      return value < -1 ? 0 : std::min(end, static_cast<std::size_t>(value + 2));
    };
    for (std::size_t y = first(top); y < last(bottom, picture_.height); ++y) {
      for (std::size_t x = first(left); x < last(right, picture_.width); ++x) {
        const double share = std::clamp(coverage(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5), 0.0, 1.0);
        if (share == 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          std::uint8_t& value = picture_.rgb[3 * (y * picture_.width + x) + k];
          value = static_cast<std::uint8_t>(std::lround(value + (colour[k] - value) * share));
        }
      }
    }
  }

  Picture picture_;
  double scale_, y_ = 0;
};

std::vector<double> numbers(const std::string& text) {
  std::vector<double> result;
  const char* const last = text.data() + text.size();
  for (const char* at = text.data(); at != last;) {
    double value = 0;
    const auto [end, error] = eom::decimals::read_decimal(at, last, value);
    if (error == std::errc()) result.push_back(value);
    at = end == at ? at + 1 : end;
  }
  return result;
}

/// Polylines of a path with the commands M, L, H and V.
std::vector<std::vector<Point>> pieces(const std::string& d) {
  std::vector<std::vector<Point>> result;
  for (std::size_t i = 0; i < d.size();) {
    const char command = d[i];
    const std::size_t end = std::min(d.find_first_of("MLHV", i + 1), d.size());
    const std::vector<double> values = numbers(d.substr(i + 1, end - i - 1));
    i = end;
    if (values.empty() || (result.empty() && command != 'M')) continue;
    if (command == 'M') result.emplace_back();
    const Point before = result.back().empty() ? Point{} : result.back().back();
    if (command == 'H')
      result.back().emplace_back(values[0], before.second);
    else if (command == 'V')
      result.back().emplace_back(before.first, values[0]);
    else if (values.size() > 1)
      result.back().emplace_back(values[0], values[1]);
  }
  return result;
}

std::string plain(std::string text) {
  for (const auto& [escaped, character] : {std::pair<std::string, std::string>{"&lt;", "<"},
                                           {"&gt;", ">"},
                                           {"&quot;", "\""},
                                           {"&#39;", "'"},
                                           {"&amp;", "&"}}) {
    for (std::size_t at = 0; (at = text.find(escaped, at)) != std::string::npos; at += character.size())
      text.replace(at, escaped.size(), character);
  }
  return text;
}

class Reader {
 public:
  Reader(const std::string& svg, double scale) : svg_(svg), painter_(size("width"), size("height"), scale) {}

  Picture run() {
    for (std::size_t at = svg_.find('<'); at != std::string::npos; at = svg_.find('<', at)) {
      const std::size_t end = svg_.find('>', at);
      const Tag tag(svg_.substr(at + 1, end - at - 1));
      at = end;
      const std::string name = tag.name();
      if (name == "title") at = svg_.find("</title>", end);
      if (name == "svg") painter_.shift(tag.number("y"));
      if (name == "g") group_ = colour_of(tag.get("fill"), group_);
      if (name == "rect" && tag.get("width").find('%') == std::string::npos)  // else the background
        painter_.rectangle({tag.number("x"), tag.number("y")}, tag.number("width"), tag.number("height"),
                           colour_of(tag.get("fill"), ink));
      if (name == "line")
        painter_.polyline({{tag.number("x1"), tag.number("y1")}, {tag.number("x2"), tag.number("y2")}},
                          tag.number("stroke-width", 1), numbers(tag.get("stroke-dasharray")),
                          colour_of(tag.get("stroke"), ink));
      if (name == "circle")
        painter_.disk({tag.number("cx"), tag.number("cy")}, tag.number("r"), colour_of(tag.get("fill"), group_));
      if (name == "path") {
        for (const std::vector<Point>& piece : pieces(tag.get("d")))
          painter_.polyline(piece, tag.number("stroke-width", 1), numbers(tag.get("stroke-dasharray")),
                            colour_of(tag.get("stroke"), ink));
      }
      if (name == "text") {
        const std::size_t close = svg_.find("</text>", end);
        text(tag, svg_.substr(end + 1, close - end - 1));
        at = close;
      }
    }
    return painter_.take();
  }

 private:
  static constexpr Colour ink{51, 51, 51};
  static constexpr double usual = 12.5;

  double size(const std::string& key) const {
    const double value = Tag(svg_.substr(1, svg_.find('>') - 1)).number(key);
    if (!(value >= 1 && value <= 20000)) throw std::logic_error("a drawing without a size");
    return value;
  }

  struct Run {
    std::string text;
    double size, dy;
  };
  /// Parses a sequence of text and <tspan dy=".." font-size="..">text</tspan>.
  static std::vector<Run> runs(const std::string& content, double size) {
    std::vector<Run> result;
    double dy = 0;
    for (std::size_t i = 0; i < content.size();) {
      if (content[i] != '<') {
        const std::size_t end = std::min(content.find('<', i), content.size());
        result.push_back({plain(content.substr(i, end - i)), size, dy});
        i = end;
        continue;
      }
      const std::size_t open = content.find('>', i), close = content.find("</tspan>", open);
      const Tag tag(content.substr(i + 1, open - i - 1));
      dy += tag.number("dy");
      result.push_back({plain(content.substr(open + 1, close - open - 1)), tag.number("font-size", size), dy});
      i = close + 8;
    }
    return result;
  }

  void text(const Tag& tag, const std::string& content) {
    const double size = tag.number("font-size", usual);
    const std::vector<Run> all = runs(content, size);
    std::vector<StrokedText> parts;
    double width = 0;
    for (const Run& run : all) {
      parts.push_back(stroke_text(run.text, run.size));
      width += parts.back().width + 0.1 * run.size;
    }
    const std::string anchor = tag.get("text-anchor"), transform = tag.get("transform");
    // The only transform is that of a label along the vertical axis: translate(x y) rotate(-90).
    const std::vector<double> moved =
        transform.empty() ? std::vector<double>{} : numbers(transform.substr(transform.find('(') + 1));
    const bool turned = moved.size() >= 2;
    const double x0 = turned ? moved[0] : tag.number("x"), y0 = turned ? moved[1] : tag.number("y");
    double start = anchor == "middle" ? -0.5 * width : anchor == "end" ? -width : 0;
    const bool bold = !tag.get("font-weight").empty();
    const Colour colour = colour_of(tag.get("fill"), ink);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      for (const Stroke& stroke : parts[k].strokes) {
        std::vector<Point> points;
        for (const auto& [x, y] : stroke) {
          const double along = start + x, up = y - all[k].dy;
          points.push_back(turned ? Point{x0 - up, y0 - along} : Point{x0 + along, y0 - up});
        }
        // Dots are larger than lines are wide, so that 1.0 does not read 10 in a picture that is scaled down.
        const bool dot = std::all_of(points.begin(), points.end(), [&](const Point& p) { return p == points[0]; });
        painter_.polyline(points, (bold ? 0.13 : 0.1) * (dot ? 1.9 : 1) * all[k].size, {}, colour);
      }
      start += parts[k].width + 0.1 * all[k].size;
    }
  }

  const std::string& svg_;
  Painter painter_;
  Colour group_ = ink;
};

}  // namespace

Picture rasterise(const std::string& svg, double scale) { return Reader(svg, scale).run(); }

}  // namespace eomgen::cli
