// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <eom/output/svg_plot.hpp>

#include "cli/text_plot.hpp"
#include "error.hpp"

namespace eomgen::cli {
namespace {

constexpr int panel_height = 300, width = 760;

std::string with_unit(const std::vector<system::Output>& outputs, const std::string& name) {
  const std::string unit = unit_of(outputs, name);
  return unit.empty() || unit == "1" ? name : name + " in " + unit;
}

}  // namespace

RunPlot::RunPlot(std::vector<Panel> panels, const std::vector<system::Output>& outputs,
                 const std::vector<std::string>& code)
    : panels_(std::move(panels)) {
  const auto keep = [&](const std::string& name) {
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) return;
    const auto found = std::find(code.begin(), code.end(), name);
    if (found == code.end()) {
      throw Error("run", {}, fmt::format("'{0}' stands for several outputs, and a curve is of one", name),
                  fmt::format("name one of them, such as {}.1", name));
    }
    names_.push_back(name);
    index_.push_back(static_cast<std::size_t>(found - code.begin()));
  };
  for (const Panel& panel : panels_) {
    std::for_each(panel.names.begin(), panel.names.end(), keep);
    equal_scales_.push_back(!panel.x_name.empty() && unit_of(outputs, panel.x_name) == "m" &&
                            std::all_of(panel.names.begin(), panel.names.end(),
                                        [&](const std::string& name) { return unit_of(outputs, name) == "m"; }));
    x_labels_.push_back(panel.x_name.empty() ? "t in s" : with_unit(outputs, panel.x_name));
    if (!panel.x_name.empty()) keep(panel.x_name);
  }
  columns_.resize(names_.size());
}

void RunPlot::row(double t, std::span<const double> values) {
  t_.push_back(t);
  for (std::size_t i = 0; i < index_.size(); ++i) columns_[i].push_back(values[index_[i]]);
}

const std::vector<double>& RunPlot::curve(const std::string& name) const {
  return columns_[static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin())];
}

std::string RunPlot::svg(const std::string& title, const run::RunResult& result) const {
  std::string body;
  int top = 0;
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    const Panel& panel = panels_[k];
    eom::Plot plot;
    plot.title = k == 0 ? title : "";
    plot.x_label = x_labels_[k];
    plot.y_label = panel.title;
    plot.equal_scales = equal_scales_[k];
    plot.width = width;
    plot.height = panel_height + (k == 0 ? 28 : 0);
    for (const std::string& name : panel.names) {
      eom::PlotSeries series;
      series.name = panel.names.size() > 1 ? name : "";
      series.x = panel.x_name.empty() ? t_ : curve(panel.x_name);
      series.y = curve(name);
      const auto estimate = std::find_if(result.error_estimate.begin(), result.error_estimate.end(),
                                         [&](const auto& e) { return e.first == name; });
      if (panel.x_name.empty() && estimate != result.error_estimate.end()) series.error_at_end = estimate->second;
      plot.series.push_back(std::move(series));
    }
    if (panel.x_name.empty()) {
      for (const run::RunEvent& event : result.events) plot.marks.push_back({event.t, event.name});
    }
    std::string drawn = eom::svg(plot);
    if (panels_.size() == 1) return drawn;
    const std::size_t at = drawn.find("height=\"") + 8;
    const int height = std::stoi(drawn.substr(at));
    drawn.replace(0, 4, fmt::format("<svg y=\"{}\"", top));
    body += drawn;
    top += height;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n{2}</svg>\n",
      width, top, body);
}

std::string RunPlot::text_plot(const std::string& title, const run::RunResult& result, std::size_t columns) const {
  std::string text = title + "\n";
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    const Panel& panel = panels_[k];
    TextPlot plot{panel.title, x_labels_[k], {}, {}};
    for (const std::string& name : panel.names)
      plot.curves.push_back(
          {panel.names.size() > 1 ? name : "", panel.x_name.empty() ? &t_ : &curve(panel.x_name), &curve(name)});
    if (panel.x_name.empty()) {
      for (const run::RunEvent& event : result.events) plot.marks.push_back(event.t);
    }
    text += "\n" + render_text_plot(plot, columns);
  }
  return text;
}

}  // namespace eomgen::cli
