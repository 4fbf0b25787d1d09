// The SVG is well-formed XML for any text and numbers, and contains the data.
#include "eom/output/svg_plot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

/// Empty for well-formed XML of the kind drawn here (elements, quoted attributes, the five entities); else the error.
std::string defect_of(const std::string& xml) {
  std::vector<std::string> open;
  std::size_t i = 0;
  while (i < xml.size()) {
    if (xml[i] != '<') {
      const std::size_t end = std::min(xml.find('<', i), xml.size());
      const std::string text = xml.substr(i, end - i);
      for (std::size_t k = text.find('&'); k != std::string::npos; k = text.find('&', k + 1)) {
        const std::string entity = text.substr(k, text.find(';', k) - k + 1);
        if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;" && entity != "&#39;")
          return "entity " + entity;
      }
      if (text.find('>') != std::string::npos) return "a bare >";
      i = end;
      continue;
    }
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return "a tag without an end";
    const std::string tag = xml.substr(i + 1, end - i - 1);
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0 || tag.find('<') != std::string::npos)
      return "quotes in " + tag;
    const std::string name = tag.substr(0, tag.find_first_of(" /", tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "closes " + tag;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    i = end + 1;
  }
  return open.empty() ? "" : "never closed: " + open.back();
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t k = text.find(word); k != std::string::npos; k = text.find(word, k + 1)) ++found;
  return found;
}

eom::Plot two_lines() {
  eom::Plot plot;
  plot.title = "A <title> & \"more\"";
  plot.x_label = "t in s";
  plot.y_label = "x'";
  plot.series = {{"first", {0, 1, 2}, {0, 1, 0}}, {"a < b", {0, 1, 2}, {1, 2, 3}, true, true}};
  return plot;
}

}  // namespace

TEST_CASE("svg: well-formed, text escaped, one path per line, names in the legend") {
  const std::string svg = eom::svg(two_lines());
  CHECK(defect_of(svg) == "");
  CHECK(svg.find("A &lt;title&gt; &amp; &quot;more&quot;") != std::string::npos);
  CHECK(svg.find("a &lt; b") != std::string::npos);
  CHECK(svg.find("xmlns=\"http://www.w3.org/2000/svg\"") != std::string::npos);
  CHECK(count(svg, "<path ") == 2);
  CHECK(count(svg, "<circle ") == 4);  // three points and the legend
  CHECK(svg.find(eom::plot::colours[0]) != std::string::npos);
  CHECK(svg.find(eom::plot::colours[1]) != std::string::npos);
}

TEST_CASE("svg: well-formed and finite for ranges that are empty, flat, huge, tiny, far from zero, or not numbers") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double not_a_number = std::nan("");
  const std::vector<std::vector<double>> values{
      {},
      {5, 5},
      {0, 0},
      {-1e300, 1e300},
      {1e-300, 2e-300},
      {1e6, 1e6 + 1e-3},
      {1, 1 + 1e-15},
      {not_a_number, infinity},
      {-1, 0},
      {1e-30, 1e30},
      {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()}};
  for (const std::vector<double>& y : values)
    for (const bool logarithmic : {false, true}) {
      CAPTURE(y.size());
      CAPTURE(y.empty() ? 0 : y[0]);
      CAPTURE(logarithmic);
      eom::Plot plot;
      plot.log_x = plot.log_y = logarithmic;
      plot.series = {{"one", y, y, true, true}};
      const std::string svg = eom::svg(plot);
      CHECK(defect_of(svg) == "");
      CHECK(svg.find("nan") == std::string::npos);
      CHECK(svg.find("inf") == std::string::npos);
      CHECK(svg.size() < 40000);
    }
}

TEST_CASE("svg: a value that cannot be drawn interrupts the line") {
  eom::Plot plot;
  plot.series = {{"", {0, 1, 2, 3, 4}, {0, 1, std::nan(""), 1, 0}}};
  const std::string svg = eom::svg(plot);
  const std::size_t path = svg.find("<path d=");
  CHECK(count(svg.substr(path, svg.find("/>", path) - path), "M") == 2);
}

TEST_CASE("svg: a million coincident points give a small file") {
  eom::PlotSeries series{"sine", {}, {}};
  for (int i = 0; i < 1000000; ++i) {
    series.x.push_back(1e-5 * i);
    series.y.push_back(std::sin(1e-5 * i));
  }
  eom::Plot plot;
  plot.series = {series};
  CHECK(eom::svg(plot).size() < 100000);
}

TEST_CASE("svg: series with x and y of different lengths are refused, and named") {
  eom::Plot plot;
  plot.series = {{"crooked", {0, 1}, {0}}};
  try {
    eom::svg(plot);
    FAIL("accepted");
  } catch (const std::invalid_argument& error) {
    CHECK(std::string(error.what()).find("crooked") != std::string::npos);
  }
}

TEST_CASE("axis: ticks are at 1, 2 or 5 times powers of ten, and zero is labelled 0") {
  const eom::plot::Axis axis = eom::plot::make_axis(-0.9, 1.1, false, 5);
  REQUIRE(axis.ticks.size() == 4);
  CHECK(axis.ticks[0].label == "-0.5");
  CHECK(axis.ticks[1].label == "0");
  CHECK(axis.ticks[3].label == "1.0");
}

TEST_CASE("svg: a legend of a hundred names increases the height of the drawing") {
  eom::Plot plot;
  plot.height = 320;
  for (int k = 0; k < 100; ++k) plot.series.push_back({"coordinate" + std::to_string(k), {0, 1}, {0, double(k)}});
  const std::string text = eom::svg(plot);
  CHECK(text.find("coordinate99") != std::string::npos);
  const std::size_t at = text.find("height=\"") + 8;
  CHECK(std::stoi(text.substr(at)) > 500);
}

TEST_CASE("svg: a curve that covers an earlier one is dashed, and its legend names that one") {
  eom::Plot plot;
  plot.series = {
      {"first", {0, 1, 2}, {0, 1, 0}}, {"second", {0, 1, 2}, {0, 1.001, 0}}, {"third", {0, 1, 2}, {0, 0.9, 0}}};
  const std::string svg = eom::svg(plot);
  CHECK(count(svg, "stroke-dasharray") == 2);  // curve and legend
  CHECK(svg.find(">second (as first)<") != std::string::npos);
  CHECK(svg.find(">third<") != std::string::npos);
  plot.log_y = true;
  CHECK(eom::svg(plot).find(" (as ") == std::string::npos);
}
