// SPDX-License-Identifier: GPL-3.0-or-later
// Plots of `run` (panels by units, phase planes, events, estimated errors, text), of `bench` and of `stress`.
#include <doctest/doctest.h>

#include <map>
#include <regex>
#include <sstream>

#include "program.hpp"

using namespace eomgen::test;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

std::string plotted(const Folder& folder, Words words) {
  words.insert(words.begin(), "run");
  words.insert(words.end(), {"--plot", "plot.svg"});
  expect(0, folder, words);
  return folder.read("plot.svg");
}

// Checks that the text is printable and fits the width of a terminal.
void check_characters(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    CHECK(line.size() <= 80);
    for (const char c : line) CHECK((c >= ' ' && c <= '~'));
  }
}

/// Reads the PNG of argv[2]: [width, height, RGB of the pixels by rows].
const char* const png_reader = R"(
const b = require('fs').readFileSync(process.argv[2]), zlib = require('zlib'), data = [];
let at = 8, w, h;
while (at < b.length) {
  const n = b.readUInt32BE(at), kind = b.toString('latin1', at + 4, at + 8);
  if (kind === 'IHDR') [w, h] = [b.readUInt32BE(at + 8), b.readUInt32BE(at + 12)];
  if (kind === 'IDAT') data.push(b.subarray(at + 8, at + 8 + n));
  at += 12 + n;
}
const raw = zlib.inflateSync(Buffer.concat(data)), row = 3 * w, p = Buffer.alloc(row * h);
const paeth = (a, b, c) => { const d = a + b - c, e = [a, b, c].map(x => Math.abs(d - x)); return [a, b, c][e.indexOf(Math.min(...e))]; };
for (let y = 0; y < h; ++y) for (let i = 0; i < row; ++i) {
  const to = y * row + i, left = i < 3 ? 0 : p[to - 3], above = y === 0 ? 0 : p[to - row], corner = i < 3 || y === 0 ? 0 : p[to - row - 3];
  const predicted = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][raw[y * (row + 1)]];
  p[to] = raw[y * (row + 1) + 1 + i] + predicted;
}
module.exports = [w, h, p];
if (raw.length !== (row + 1) * h) throw 'the picture is not whole';
)";

/// What the script prints about a PNG; null without node.
Json found_in_png(const Folder& folder, const std::string& name, const std::string& script) {
  folder.write("png.js", png_reader);
  folder.write("read.js", "const [w, h, p] = require('./png.js');\n" + script);
  try {
    const ChildResult result = run_child({{"node", "read.js", name}, folder.path()});
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    return Json::parse(result.out);
  } catch (const std::runtime_error&) {
    MESSAGE("skipped: there is no node");
    return nullptr;
  }
}

}  // namespace

TEST_CASE("plot: one panel for each unit, with the unit at its axis and one title") {
  const Folder folder;
  const std::string cart = plotted(folder, {"cart_pendulum"});
  CHECK(contains(cart, ">x in m<"));
  CHECK(contains(cart, ">theta in rad<"));
  CHECK(count(cart, "<svg") == 3);
  CHECK(count(cart, "font-size=\"17\"") == 1);
  CHECK(count(plotted(folder, {"S6_chain_2"}), "<svg") == 1);
  CHECK(contains(plotted(folder, {"S5_double_pendulum"}), ">coordinates in rad<"));
}

TEST_CASE("plot: requested outputs by units; a phase plane is one quantity over another") {
  const Folder folder;
  const std::string chosen =
      plotted(folder, {"S5_double_pendulum", "--plot-of", "energy", "--plot-of", "theta1", "--plot-of", "theta2",
                       "--plot-of", "kinetic", "--plot-of", "theta1,theta1_dot"});
  CHECK(count(chosen, "<svg") == 4);
  CHECK(contains(chosen, ">in J<"));
  CHECK(contains(chosen, ">in rad<"));
  CHECK(contains(chosen, ">theta1 in rad<"));
  CHECK(contains(chosen, ">theta1_dot in rad/s<"));
  CHECK(count(chosen, ">t in s<") == 2);
  CHECK(contains(plotted(folder, {"S5_double_pendulum", "--plot-of", "P2.position1,P2.position2"}),
                 ">P2.position2 in m<"));
}

TEST_CASE("plot: a path of lengths over lengths has equal scales, other phase planes do not") {
  const Folder folder;
  // Distances of neighbouring grid lines, per unit, along both axes.
  const auto scales = [&](const std::string& of) {
    expect(0, folder, {"run", "S5_double_pendulum", "--t-end", "2", "--plot", "p.svg", "--plot-of", of});
    const std::string svg = folder.read("p.svg");
    const std::regex label("<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" text-anchor=\"(middle|end)\">([^<]+)</text>");
    std::map<std::string, std::vector<std::pair<double, double>>> axes;
    for (std::sregex_iterator at(svg.begin(), svg.end(), label), end; at != end; ++at) {
      std::string value = (*at)[4];
      if (value.rfind("\u2212", 0) == 0) value.replace(0, 3, "-");
      axes[(*at)[3]].emplace_back(std::stod(value), std::stod((*at)[(*at)[3] == "middle" ? 1 : 2]));
    }
    const auto scale = [](const auto& ticks) {
      REQUIRE(ticks.size() > 1);
      return std::abs((ticks[1].second - ticks[0].second) / (ticks[1].first - ticks[0].first));
    };
    return std::pair{scale(axes["middle"]), scale(axes["end"])};
  };
  const auto [across, up] = scales("P2.position1,P2.position2");
  CHECK(across == doctest::Approx(up).epsilon(1e-3));
  const auto [angle, rate] = scales("theta1,theta1_dot");
  CHECK(angle > 1.5 * rate);
}

TEST_CASE("plot: events are marked by name, and an estimated error wider than a line is a bar") {
  const Folder folder;
  const std::string sphere = plotted(folder, {"leaving_sphere"});
  CHECK(contains(sphere, "<title>halfway</title>"));
  CHECK_FALSE(contains(sphere, "estimated error"));
  CHECK(contains(plotted(folder, {"S5_double_pendulum", "--rtol", "1e-2", "--atol", "1e-2", "--t-end", "20"}),
                 "estimated error of theta2"));
}

TEST_CASE("plot: a PNG has the pixels of the SVG: white background, coloured curves, valid checksums") {
  const Folder folder;
  expect(0, folder, {"run", "cart_pendulum", "--plot", "plot.PNG"});
  const std::string png = folder.read("plot.PNG");
  CHECK(png.substr(0, 8) == std::string("\x89PNG\r\n\x1a\n", 8));
  CHECK(png.size() < 400000);
  CHECK(png.substr(png.size() - 8) == std::string("IEND\xae\x42\x60\x82", 8));
  expect(0, folder, {"run", "cart_pendulum", "--plot", "again.png"});
  CHECK(folder.read("again.png") == png);
  // Node decompresses the stream and counts the drawn pixels.
  const Json found = found_in_png(folder, "plot.PNG", R"(
let white = 0, blue = 0;
for (let i = 0; i < p.length; i += 3) {
  if (p[i] + p[i + 1] + p[i + 2] === 765) ++white;
  if (p[i] === 0x0b && p[i + 1] === 0x6a && p[i + 2] === 0xb0) ++blue;
}
console.log(JSON.stringify({w, white, blue}));)");
  if (found.is_null()) return;
  CHECK(found["w"] == 1520);
  CHECK(found["white"] > 500000);
  CHECK(found["blue"] > 2000);
}

TEST_CASE("plot: a PDF has the curves and the text of the SVG, and equal runs give equal bytes") {
  const Folder folder;
  for (const char* name : {"a.pdf", "b.pdf"}) expect(0, folder, {"run", "cart_pendulum", "--plot", name});
  const std::string pdf = folder.read("a.pdf");
  CHECK(pdf.starts_with("%PDF-"));
  CHECK(contains(pdf, "/FontFile"));
  CHECK(contains(pdf, "/MediaBox [ 0 0 570 "));
  CHECK(folder.read("b.pdf") == pdf);
}

TEST_CASE("plot: a PNG with dashed curves ends, and their dashes and gaps have the stated lengths") {
  const Folder folder;
  std::string names, kinetic, potential, initial;
  for (int i = 1; i <= 17; ++i) {  // the ninth and the seventeenth curve have the colour of the first, in dashes
    const std::string x = "x" + std::to_string(i);
    names += x + " = {}\n";
    kinetic += (i > 1 ? " + " : "") + std::string("m*") + x + "_dot^2/2";
    potential += (i > 1 ? " + " : "") + std::string("k*") + x + "^2/2";
    initial += (i > 1 ? ", " : "") + x + " = " + std::to_string(i);
  }
  folder.write("a.toml", "format = 1\n[parameters]\nm = { value = 1, positive = true }\nk = 5e4\n[coordinates]\n" +
                             names + "[energy]\nkinetic = \"" + kinetic + "\"\npotential = \"" + potential +
                             "\"\n[scene.default]\nt = [0, 1]\ninitial = { " + initial + " }\n");
  // Steep segments hold many dashes each; their lengths are rounded, and so is where each begins.
  expect(0, folder, {"run", "a.toml", "--plot", "steep.png"});
  CHECK(folder.read("steep.png").starts_with("\x89PNG"));
  // With k = 0 curves are horizontal, in dashes of 14 of 22 and of 4 of 10 pixels; round ends add 3 pixels to each.
  expect(0, folder, {"run", "a.toml", "--set", "k=0", "--plot", "flat.png"});
  const Json drawn = found_in_png(folder, "flat.png", R"(const most = [];
for (let y = 0, last = -9; y < h; ++y) { let n = 0; for (let x = 0; x < w; ++x) if (p[3 * (y * w + x)] === 0x0b && p[3 * (y * w + x) + 1] === 0x6a) ++n; if (n > 300) { if (y - last > 5) most.push(n); else most[most.length - 1] = Math.max(n, most[most.length - 1]); last = y; } }
console.log(JSON.stringify(most));)");
  if (drawn.is_null()) return;
  CAPTURE(drawn.dump());
  REQUIRE(drawn.size() == 3);  // from the top: 17, 9, 1
  const double whole = drawn[2].get<double>();
  CHECK(drawn[1].get<double>() / whole == doctest::Approx(17.0 / 22).epsilon(0.03));
  CHECK(drawn[0].get<double>() / whole == doctest::Approx(7.0 / 10).epsilon(0.03));
}

TEST_CASE("plot: the decimal points of a PNG are wider than the strokes of its digits") {
  const Folder folder;
  expect(0, folder, {"run", "S5_double_pendulum", "--t-end", "1", "--plot", "dots.png", "--no-error-estimate"});
  const Json dots = found_in_png(folder, "dots.png", R"(
const ink = (x, y) => (255 - Math.max(...p.subarray(3 * (y * w + x), 3 * (y * w + x + 1)))) / (255 - 0x33);
const dots = [], dark = (x, y) => ink(x, y) > 0.2, seen = new Uint8Array(w * h);
for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) {
  if (seen[y * w + x] || !dark(x, y)) continue;
  let area = 0, box = [x, x, y, y]; const open = [[x, y]]; seen[y * w + x] = 1;
  while (open.length > 0) { const [u, v] = open.pop(); area += ink(u, v); box = [Math.min(box[0], u), Math.max(box[1], u), Math.min(box[2], v), Math.max(box[3], v)];
    for (const [a, c] of [[u + 1, v], [u - 1, v], [u, v + 1], [u, v - 1]]) if (a >= 0 && c >= 0 && a < w && c < h && !seen[c * w + a] && dark(a, c)) { seen[c * w + a] = 1; open.push([a, c]); } }
  if (box[1] - box[0] < 8 && box[3] - box[2] < 8) dots.push(area);
}
console.log(JSON.stringify(dots));)");
  if (dots.is_null()) return;
  CAPTURE(dots.dump());
  CHECK(dots.size() >= 4);
  constexpr double stroke = 2 * 12.5 * 0.09;  // of DejaVu Sans, in pixels
  for (const Json& area : dots) CHECK(area.get<double>() > 1.4 * stroke * stroke);
}

TEST_CASE("plot: characters fit into eighty columns and show each curve with a letter of its own") {
  const Folder folder;
  const std::string text =
      expect(0, folder, {"run", "S5_double_pendulum", "--plot", "-", "--plot-of", "theta1", "--plot-of", "theta2"}).out;
  CHECK(contains(text, "* theta1   + theta2"));
  CHECK(contains(text, "t in s"));
  check_characters(text);
  std::istringstream lines(text);
  std::size_t drawn = 0;
  for (std::string line; std::getline(lines, line);) {
    if (contains(line, "|") && (contains(line, "*") || contains(line, "+"))) ++drawn;
  }
  CHECK(drawn > 8);
}

TEST_CASE("plot: bench draws errors over run times, one line for each solver, on logarithmic axes") {
  const Folder folder;
  const Words bench{"bench", "P2_planar_pendulum", "--t-end", "1", "--solver", "tsit5,rk4", "--seconds", "1000000000"};
  const auto plotted = [&](const std::string& place) {
    Words words = bench;
    words.insert(words.end(), {"--plot", place});
    return expect(0, folder, words);
  };
  plotted("b.svg");
  const std::string svg = folder.read("b.svg");
  CHECK(contains(svg, ">Planar pendulum with both constraint forces</text>"));
  CHECK(contains(svg, ">tsit5</text>"));
  CHECK(contains(svg, ">rk4</text>"));
  CHECK(contains(svg, ">median run time in s</text>"));
  CHECK(contains(svg, "10<tspan"));
  CHECK(count(svg, "<path") == 2);
  plotted("b.png");
  CHECK(folder.read("b.png").starts_with("\x89PNG"));
  const ChildResult text = plotted("-");
  CHECK(contains(text.out, "* rk4   + tsit5"));
  check_characters(text.out);
  CHECK(contains(text.err, "reference"));  // the table goes to standard error
}

TEST_CASE("plot: stress draws each verdict of its table, distinguished by shape and colour") {
  const Folder folder;
  folder.write("hostile.toml", R"(format = 1
title = "<b> & \"both\""
[parameters]
k = "2 N/m"
[[particle]]
name = "P"
mass = "1 kg"
position = ["x", 0, 0]
[coordinates]
x = "m"
[[force]]
name = "spring"
generalized = { x = "-k*x" }
[scene.default]
t = [0, 1]
initial = { x = 0.1 }
)");
  const auto plotted = [&](const std::string& place, const Words& more) {
    Words words{"stress", "hostile.toml", "--quick",        "--steps", "300", "--seconds",
                "1e6",    "--solver",     "dopri5,rk4,ggl", "--plot",  place};
    words.insert(words.end(), more.begin(), more.end());
    return expect(0, folder, words).out;
  };
  const Json found = Json::parse(plotted("s.svg", {"--json"}));
  const std::string svg = folder.read("s.svg");
  CHECK(contains(svg, "<title>&lt;b&gt; &amp; &quot;both&quot;</title>"));
  CHECK_FALSE(contains(svg, "<b>"));
  CHECK(found["pass"].get<std::size_t>() > 3);
  CHECK(found["reported"].get<std::size_t>() > 3);
  CHECK(count(svg, ": pass, ") == found["pass"].get<std::size_t>());
  CHECK(count(svg, ": reported, ") == found["reported"].get<std::size_t>());
  CHECK(count(svg, "height=\"13\" fill=\"#0b6ab0\"") == found["pass"].get<std::size_t>() + 1);  // and one in the legend
  CHECK(count(svg, "height=\"4\" fill=\"#e08e0b\"") == found["reported"].get<std::size_t>() + 1);
  plotted("s.png", {});
  CHECK(folder.read("s.png").starts_with("\x89PNG"));
  const std::string text = plotted("-", {});
  check_characters(text);
  CHECK(contains(text, "+ " + std::to_string(found["pass"].get<int>()) + " pass"));
  CHECK(contains(text, "as it is"));
}

TEST_CASE("plot: unknown names and invalid phase planes are refused with a remedy") {
  const Folder folder;
  const auto refused = [&](const Words& words, const std::string& what) {
    Words all{"run", "S5_double_pendulum"};
    all.insert(all.end(), words.begin(), words.end());
    const ChildResult result = expect(2, folder, all);
    CAPTURE(result.err);
    CHECK(contains(result.err, what));
    CHECK(contains(result.err, "remedy: "));
  };
  refused({"--plot", "a.svg", "--plot-of", "theta3"}, "there is no output 'theta3'");
  refused({"--plot", "a.svg", "--plot-of", "theta1,theta2,theta1_dot"}, "there is no output 'theta2,theta1_dot'");
  refused({"--plot", "a.svg", "--plot-of", "theta1,"}, "is no phase plane");
  refused({"--plot", "a.svg", "--plot-of", "all"}, "stands for several outputs");
  refused({"--plot-of", "theta1"}, "there is no plot");
  CHECK(folder.names().empty());
}
