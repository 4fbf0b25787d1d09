// SPDX-License-Identifier: GPL-3.0-or-later
// Command stress: runs every solver on stiff and extreme variations of a scene.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <eom/output/svg_plot.hpp>
#include <string>
#include <vector>

#include "analysis/stress_test.hpp"
#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/plot_file.hpp"
#include "cli/shared_options.hpp"
#include "pipeline/limits.hpp"

namespace eomgen::cli::stress_command {

using eom::plot::escaped;
using stress::Verdict;

namespace {

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

/// Plot of the verdicts of `stress`, one row per case and one column per solver, as SVG or text.
struct StressPlot {
  const analysis::StressFindings& found;
  std::string title;

  std::string svg() const {
    const std::vector<Line> lines = lines_of(found);
    const double left = std::max(
        170.0,
        24 + letter * static_cast<double>(longest(lines, [](const Line& l) { return std::string_view(l.name); })));
    const double heads = 12 + letter * static_cast<double>(longest(
                                           found.solvers, [](const std::string& s) { return std::string_view(s); }));
    const double top = 70 + heads, height = top + line_height * static_cast<double>(lines.size()) + 20;
    const double width = std::max({left + column * static_cast<double>(found.solvers.size()) + 24, 480.0,
                                   48 + 9.8 * static_cast<double>(title.size())});
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
        "{1:.0f}\" "
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
      out +=
          text(0, 0,
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

  /// Plot as text, at most `columns` wide.
  std::string text_plot(std::size_t columns) const {
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
};

struct Options : SceneOptions {
  std::string model, plot;
  std::vector<std::string> solvers;
  double seconds = 60;
  std::uint64_t steps = 20000;
  bool quick = false;
};

Json of(const stress::Extreme& extreme) {
  if (extreme.value == stress::no_value) return nullptr;
  return {{"value", finite_or_null(extreme.value)}, {"case", extreme.at}};
}

Json of(const stress::Audit& audit) {
  Json denominators = Json::array();
  for (const stress::Denominator& d : audit.denominators) {
    const bool seen = d.smallest != stress::no_value;
    denominators.push_back({{"expression", d.expression},
                            {"zero", d.zero},
                            {"test", d.test},
                            {"smallest", seen ? Json(d.smallest) : Json(nullptr)},
                            {"largest", seen ? Json(d.largest) : Json(nullptr)},
                            {"case", d.at}});
  }
  return {{"states", audit.states},
          {"denominators", denominators},
          {"mass_condition", of(audit.mass_condition)},
          {"scaled_mass_condition", of(audit.scaled_mass_condition)},
          {"pivot_cancellation", of(audit.pivot)},
          {"digits_lost", of(audit.digits_lost)},
          {"without_value", audit.without_digits}};
}

Json document(const model::Model& model, const analysis::StressFindings& found) {
  const auto entry = [](const stress::Row& row) {
    Json of_row{{"case", row.test}, {"solver", row.solver}, {"verdict", stress::name(row.verdict)}};
    of_row.update(EOMGEN_MEMBERS(row, error, estimate, condition, seconds, outcome, note));
    return of_row;
  };
  return {{"format", 1},
          {"model", model.id},
          {"scene", found.scene},
          {"rows", list_of(found.rows, entry)},
          {"left_out", list_of(found.left_out,
                               [](const auto& one) -> Json {
                                 return {{"case", one.first}, {"reason", one.second}};
                               })},
          {"pass", found.count(Verdict::pass)},
          {"reported", found.count(Verdict::reported)},
          {"undetected", found.count(Verdict::undetected)},
          {"denominator_audit", of(found.audit)},
          {"verdict", found.count(Verdict::undetected) == 0 ? "pass" : "fail"}};
}

std::string audited(const Json& audit) {
  const auto value = [](const Json& v, const char* format) {
    return v.is_null() ? std::string("none") : fmt::format(fmt::runtime(format), v.get<double>());
  };
  std::string out = fmt::format("denominator audit, {} states\n", audit["states"].get<std::size_t>());
  for (const auto& [key, what] : {std::pair{"mass_condition", "condition of the mass matrix"},
                                  {"scaled_mass_condition", "with its diagonal scaled to 1"},
                                  {"pivot_cancellation", "largest cancellation in a pivot"},
                                  {"digits_lost", "digits lost, of 16"}}) {
    const Json& extreme = audit[key];
    if (!extreme.is_null())
      out += fmt::format("  {:<32}{:>10}  {}\n", what, value(extreme["value"], "{:.3g}"),
                         extreme["case"].get<std::string>());
  }
  if (!audit["denominators"].empty()) out += fmt::format("  {:<32}{:>10}\n", "divided by, zero where", "least");
  for (const Json& d : audit["denominators"]) {
    out += fmt::format("  {:<32}{:>10}  {}; {}\n", d["zero"].get<std::string>(), value(d["smallest"], "{:.2g}"),
                       d["case"].get<std::string>(), d["test"].get<std::string>());
  }
  return out + "\n";
}

std::string readable(const Json& found, const std::vector<std::string>& solvers) {
  std::string out = fmt::format("model  {}, scene {}\n\n  {:<28}", found["model"].get<std::string>(),
                                found["scene"].get<std::string>(), "case");
  const auto entry = [](const std::string& solver, const std::string& text) {
    return fmt::format(" {:>{}}", text, std::max<std::size_t>(9, solver.size()));
  };
  for (const std::string& solver : solvers) out += entry(solver, solver);
  std::string test;
  std::size_t column = 0;
  for (const Json& row : found["rows"]) {
    if (row["case"] != test) {
      test = row["case"].get<std::string>();
      out += fmt::format("\n  {:<28}", test);
      column = 0;
    }
    for (; column < solvers.size() && solvers[column] != row["solver"]; ++column) out += entry(solvers[column], "-");
    ++column;
    out += entry(row["solver"].get<std::string>(),
                 row["verdict"] == "undetected" ? "UNDETECTED" : row["verdict"].get<std::string>());
  }
  out += "\n\n";
  for (const Json& l : found["left_out"])
    out += fmt::format("left out: {}: {}\n", l["case"].get<std::string>(), l["reason"].get<std::string>());
  out += audited(found["denominator_audit"]);
  for (const Json& row : found["rows"]) {
    if (row["verdict"] != "undetected") continue;
    const auto shown = [&](const char* key) {
      return row[key].is_null() ? std::string("none") : fmt::format("{:.2e}", row[key].get<double>());
    };
    out +=
        fmt::format("undetected: {}, {}: error {}, estimate {}, condition {}, outcome {} {}\n",
                    row["case"].get<std::string>(), row["solver"].get<std::string>(), shown("error"), shown("estimate"),
                    shown("condition"), row["outcome"].get<std::string>(), row["note"].get<std::string>());
  }
  out += fmt::format("{}: {} pass, {} reported, {} undetected\n", found["verdict"].get<std::string>(),
                     found["pass"].get<std::size_t>(), found["reported"].get<std::size_t>(),
                     found["undetected"].get<std::size_t>());
  return out;
}

int execute(const Options& options, const CommonOptions& common) {
  const PlotFile plot(options.plot);
  if (plot.wanted()) require_writable_targets({plot.target()}, locate_model(options.model), common.json);
  analysis::StressRequest request;
  request.take(scene_request("stress", options.model, options, common.seed));
  request.solvers = options.solvers;
  request.max_seconds = options.seconds;
  request.max_steps = options.steps;
  request.quick = options.quick;
  request.interrupt = &InterruptGuard::flag();
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) request.progress = [](const std::string& what) { print_message(fmt::format("\r{:60}\r{}", "", what)); };
  const analysis::StressFindings findings = analysis::stress_test(request);
  const InterruptGuard interrupt;
  if (terminal) print_message(fmt::format("\r{:60}\r", ""));
  const Json found = document(*request.model, findings);
  const model::Model& model = *request.model;
  const StressPlot verdicts{findings, model.title.empty() ? model.id : model.title};
  if (plot.wanted())
    plot.write([&] { return verdicts.svg(); }, [&](std::size_t columns) { return verdicts.text_plot(columns); });
  print_result(common.json, found, readable(found, findings.solvers), is_standard_output(options.plot));
  return InterruptGuard::flag() ? 3 : found["verdict"] == "pass" ? 0 : 1;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_scene(app, *options);
  add_values(app, *options);
  app.add_option("--t-end", options->t_end, "the end of the run").check(finite_number());
  app.add_list("--solver", options->solvers, "only these solvers").suggest_values(run::solver_names());
  app.add_option("--steps", options->steps, "a run with more steps is ended and reported")
      .check(whole_number(limits::stress_steps.least, limits::stress_steps.most))
      .show_default();
  app.add_option("--seconds", options->seconds, "a guard: a run that takes longer is interrupted and reported")
      .check(positive_number())
      .show_default();
  app.add_output_path("--plot", options->plot,
                      "the verdicts, SVG, PNG or PDF by its ending; - draws them with characters");
  app.add_flag("--quick", options->quick, "a few variations of each kind");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::stress_command
