// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stress_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <eom/output/svg_plot.hpp>
#include <vector>

namespace eomgen::cli {
namespace {

using eom::plot::escaped;
using stress::Verdict;

constexpr double letter = 7.2, line_height = 18, column = 22, cell = 13;  // pixels; text widths are estimated

struct Line {
  std::string name;
  std::vector<const stress::Row*> rows;  // per solver; nullptr: no row
};

std::vector<Line> lines_of(const analysis::StressFindings& found) {
  std::vector<Line> lines;
  for (const stress::Row& row : found.rows) {
    if (lines.empty() || lines.back().name != row.test)
      lines.push_back({row.test, std::vector<const stress::Row*>(found.solvers.size(), nullptr)});
    const auto at = std::find(found.solvers.begin(), found.solvers.end(), row.solver) - found.solvers.begin();
    lines.back().rows[static_cast<std::size_t>(at)] = &row;
  }
  return lines;
}

template <class List, class Name>
std::size_t longest(const List& list, Name&& name) {
  std::size_t result = 0;
  for (const auto& entry : list) result = std::max(result, name(entry).size());
  return result;
}

std::string rectangle(double x, double y, double width, double height, const char* fill) {
  using eom::plot::number;
  return fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" fill="{}"/>)", number(x), number(y), number(width),
                     number(height), fill);
}

// The verdicts also differ in shape: a square, a bar, a square with a cross.
std::string status_mark(Verdict verdict, double x, double y) {
  switch (verdict) {
    case Verdict::pass: return rectangle(x, y, cell, cell, eom::plot::colours[0]);
    case Verdict::reported: return rectangle(x, y + cell / 2 - 2, cell, 4, eom::plot::colours[3]);
    case Verdict::undetected: break;
  }
  using eom::plot::number;
  return rectangle(x, y, cell, cell, eom::plot::colours[1]) +
         fmt::format(R"(<path d="M{0} {2}L{1} {3}M{0} {3}L{1} {2}" stroke="#fff" stroke-width="2" fill="none"/>)",
                     number(x + 3), number(x + cell - 3), number(y + 3), number(y + cell - 3));
}

std::string text(double x, double y, const std::string& style, const std::string& content) {
  using eom::plot::number;
  return fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", number(x), number(y), style, escaped(content));
}

std::string row_summary(const stress::Row& row) {
  const auto value = [](double x) { return std::isfinite(x) ? fmt::format("{:.1e}", x) : std::string("none"); };
  return fmt::format("{}, {}: {}, error {}, estimate {}, {}", row.test, row.solver, stress::name(row.verdict),
                     value(row.error), value(row.estimate), row.outcome);
}

constexpr std::array verdicts{Verdict::pass, Verdict::reported, Verdict::undetected};

std::string counted(const analysis::StressFindings& found, Verdict verdict) {
  return fmt::format("{} {}", found.count(verdict), stress::name(verdict));
}

}  // namespace

std::string StressPlot::svg() const {
  const std::vector<Line> lines = lines_of(found);
  const double left = std::max(
      170.0, 24 + letter * static_cast<double>(longest(lines, [](const Line& l) { return std::string_view(l.name); })));
  const double heads = 12 + letter * static_cast<double>(longest(
                                         found.solvers, [](const std::string& s) { return std::string_view(s); }));
  const double top = 70 + heads, height = top + line_height * static_cast<double>(lines.size()) + 20;
  const double width = std::max({left + column * static_cast<double>(found.solvers.size()) + 24, 480.0,
                                 48 + 9.8 * static_cast<double>(title.size())});
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "role=\"img\" font-family=\"system-ui, 'Segoe UI', Helvetica, Arial, sans-serif\" font-size=\"12.5\" "
      "fill=\"#333\">\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      width, height, escaped(title));
  out += text(24, 28, R"( font-size="17" font-weight="600" fill="#111")", title);
  double x = 24;
  for (const Verdict verdict : verdicts) {
    out += status_mark(verdict, x, 43) + text(x + cell + 6, 54, "", counted(found, verdict));
    x += 120;
  }
  if (!found.left_out.empty()) out += text(x, 54, "", fmt::format("{} left out", found.left_out.size()));
  for (std::size_t s = 0; s < found.solvers.size(); ++s) {
    out += text(0, 0,
                fmt::format(" transform=\"translate({} {}) rotate(-90)\"",
                            eom::plot::number(left + column * static_cast<double>(s) + 11), eom::plot::number(top - 6)),
                found.solvers[s]);
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double y = top + line_height * static_cast<double>(k);
    if (k % 2 == 0) out += rectangle(12, y, width - 24, line_height, "#f3f4f6") + "\n";
    out += text(left - 10, y + 13.5, " text-anchor=\"end\"", lines[k].name);
    for (std::size_t s = 0; s < lines[k].rows.size(); ++s) {
      const stress::Row* row = lines[k].rows[s];
      if (row == nullptr) continue;
      out += "<g><title>" + escaped(row_summary(*row)) + "</title>" +
             status_mark(row->verdict, left + column * static_cast<double>(s), y + 2.5) + "</g>\n";
    }
  }
  return out + "</svg>\n";
}

std::string StressPlot::text_plot(std::size_t columns) const {
  const std::vector<Line> lines = lines_of(found);
  const std::size_t wanted = longest(lines, [](const Line& l) { return std::string_view(l.name); });
  const std::size_t taken = 2 * found.solvers.size();
  const std::size_t names = std::min(wanted, columns > taken + 12 ? columns - taken : 12);
  std::string result = title + "\n";
  for (std::size_t k = 0; k < verdicts.size(); ++k)
    result += fmt::format("{}{} {}", k == 0 ? "" : "   ", "+-#"[k], counted(found, verdicts[k]));
  result += "\n\n";
  const auto add = [&](std::string text) {
    text.erase(text.find_last_not_of(' ') + 1);
    result += text + "\n";
  };
  // Vertical names of solvers that end above their columns.
  const std::size_t high = longest(found.solvers, [](const std::string& s) { return std::string_view(s); });
  for (std::size_t r = 0; r < high; ++r) {
    std::string head(names, ' ');
    for (const std::string& solver : found.solvers) {
      const std::size_t begin = high - solver.size();
      head += std::string(" ") + (r < begin ? ' ' : solver[r - begin]);
    }
    add(head);
  }
  for (const Line& l : lines) {
    std::string row = fmt::format("{:<{}}", l.name.substr(0, names), names);
    for (const stress::Row* r : l.rows)
      row += std::string(" ") + (r == nullptr ? ' ' : "+-#"[static_cast<std::size_t>(r->verdict)]);
    add(row);
  }
  return result;
}

}  // namespace eomgen::cli
