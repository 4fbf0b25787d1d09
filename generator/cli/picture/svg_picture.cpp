// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture/svg_picture.hpp"

#include <cairo/cairo-pdf.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <eom/output/decimal.hpp>
#include <functional>
#include <memory>
#include <numbers>
#include <pugixml.hpp>
#include <stdexcept>
#include <vector>

#include "utf8.hpp"

namespace eomgen::cli {
namespace {

constexpr const char* font = "DejaVu Sans";
constexpr double usual_size = 12.5;

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

double number(const std::string& text, double otherwise) {
  const std::vector<double> values = numbers(text);
  return values.empty() ? otherwise : values[0];
}

double number(const pugi::xml_node& node, const char* name, double otherwise = 0) {
  return number(node.attribute(name).value(), otherwise);
}

struct Release {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, Release>;

void require(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(cairo_status_to_string(status));
}

class Painter {
 public:
  explicit Painter(const Surface& surface) : context_(cairo_create(surface.get())), cairo_(context_.get()) {
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
    cairo_font_options_t* const options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo_, options);
    cairo_font_options_destroy(options);
  }
  void require_success() const { require(cairo_status(cairo_)); }

  void draw(const pugi::xml_node& node) {
    const std::string name = node.name();
    if (name == "svg" || name == "g") {
      cairo_save(cairo_);
      cairo_translate(cairo_, 0, number(node, "y"));
      for (const pugi::xml_node& child : node.children()) draw(child);
      cairo_restore(cairo_);
    } else if (name == "text") {
      text(node);
    } else if (name == "rect") {
      const bool is_background = std::string(node.attribute("width").value()) == "100%";
      const pugi::xml_node size = is_background ? node.parent() : node;
      cairo_rectangle(cairo_, number(node, "x"), number(node, "y"), number(size, "width"), number(size, "height"));
      paint(node, cairo_fill);
    } else if (name == "circle") {
      cairo_arc(cairo_, number(node, "cx"), number(node, "cy"), number(node, "r"), 0, 2 * std::numbers::pi);
      paint(node, cairo_fill);
    } else if (name == "line") {
      cairo_move_to(cairo_, number(node, "x1"), number(node, "y1"));
      cairo_line_to(cairo_, number(node, "x2"), number(node, "y2"));
      paint(node, cairo_stroke);
    } else if (name == "path") {
      path(node);
    }
  }

 private:
  /// The attribute of a node or of the nearest one around it.
  static std::string inherited(pugi::xml_node node, const char* name) {
    while (node && !node.attribute(name)) node = node.parent();
    return node.attribute(name).value();
  }

  void set_colour(const std::string& text) {  // #rgb or #rrggbb
    const bool is_short = text.size() < 7;
    const auto code = static_cast<unsigned>(std::strtoul(text.substr(text.empty() ? 0 : 1).c_str(), nullptr, 16));
    const auto part = [&](unsigned k) {
      return is_short ? (code >> 4 * k & 0xf) / 15.0 : (code >> 8 * k & 0xff) / 255.0;
    };
    cairo_set_source_rgb(cairo_, part(2), part(1), part(0));
  }

  /// Ends the current path by cairo_fill or cairo_stroke, with dashes as if `before` of it were drawn.
  void paint(const pugi::xml_node& node, void (*end)(cairo_t*), double before = 0) {
    const bool is_line = end == cairo_stroke;
    const std::vector<double> dashes = numbers(node.attribute("stroke-dasharray").value());
    cairo_set_dash(cairo_, dashes.data(), static_cast<int>(dashes.size()), before);
    cairo_set_line_width(cairo_, number(node, "stroke-width", 1));
    set_colour(inherited(node, is_line ? "stroke" : "fill"));
    const std::string edge = is_line ? "" : inherited(node, "stroke");
    if (edge.empty()) return end(cairo_);
    cairo_fill_preserve(cairo_);
    set_colour(edge);
    cairo_stroke(cairo_);
  }

  /// The commands M, L, H and V, in pieces: Cairo's time to stroke a path grows with the square of its crossings.
  void path(const pugi::xml_node& node) {
    constexpr int most_segments = 50;
    const std::string d = node.attribute("d").value();
    double x = 0, y = 0, length = 0, drawn = 0;  // length from the last M; the part of it in earlier pieces
    int segments = 0;
    for (std::size_t i = 0; i < d.size();) {
      const char command = d[i];
      const std::size_t end = std::min(d.find_first_of("MLHV", i + 1), d.size());
      const std::vector<double> values = numbers(d.substr(i + 1, end - i - 1));
      i = end;
      if (values.empty()) continue;
      const double x0 = x, y0 = y;
      if (command != 'V') x = values.front();
      if (command != 'H') y = values.back();
      const bool is_start = command == 'M';
      if (is_start || ++segments > most_segments) {
        paint(node, cairo_stroke, drawn);
        drawn = is_start ? 0 : length;
        length = drawn;
        segments = 0;
        cairo_move_to(cairo_, is_start ? x : x0, is_start ? y : y0);
      }
      cairo_line_to(cairo_, x, y);  // after M: a dot if nothing follows
      if (!is_start) length += std::hypot(x - x0, y - y0);
    }
    paint(node, cairo_stroke, drawn);
  }

  /// Calls `take` with the parts of a text, each <tspan dy=".." font-size=".."> or the text between.
  void for_each_part(const pugi::xml_node& node, const std::function<void(const char* text, double dy)>& take) {
    const double size = number(inherited(node, "font-size"), usual_size);
    for (const pugi::xml_node& part : node.children()) {
      const bool is_span = part.type() == pugi::node_element;
      cairo_set_font_size(cairo_, is_span ? number(part, "font-size", size) : size);
      take(is_span ? part.text().get() : part.value(), is_span ? number(part, "dy") : 0);
    }
  }

  void text(const pugi::xml_node& node) {
    const bool is_bold = node.attribute("font-weight");
    cairo_select_font_face(cairo_, font, CAIRO_FONT_SLANT_NORMAL,
                           is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    double width = 0;
    for_each_part(node, [&](const char* part, double) {
      cairo_text_extents_t extents;
      cairo_text_extents(cairo_, part, &extents);
      width += extents.x_advance;
    });
    cairo_save(cairo_);
    // The only transform is that of a label along the vertical axis: translate(x y) rotate(-90).
    const std::vector<double> moved = numbers(node.attribute("transform").value());
    cairo_translate(cairo_, moved.empty() ? number(node, "x") : moved.at(0),
                    moved.empty() ? number(node, "y") : moved.at(1));
    if (!moved.empty()) cairo_rotate(cairo_, -0.5 * std::numbers::pi);
    const std::string anchor = node.attribute("text-anchor").value();
    cairo_move_to(cairo_, anchor == "middle" ? -0.5 * width : anchor == "end" ? -width : 0, 0);
    set_colour(inherited(node, "fill"));
    for_each_part(node, [&](const char* part, double dy) {
      cairo_rel_move_to(cairo_, 0, dy);
      cairo_show_text(cairo_, part);
    });
    cairo_restore(cairo_);
  }

  std::unique_ptr<cairo_t, Release> context_;
  cairo_t* cairo_;
};

cairo_status_t append(void* text, const unsigned char* bytes, unsigned length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), length);
  return CAIRO_STATUS_SUCCESS;
}

struct Drawing {
  explicit Drawing(const std::string& svg) {
    document.load_string(valid_utf8(svg).c_str(), pugi::parse_default | pugi::parse_ws_pcdata);
    width = number(document.first_child(), "width");
    height = number(document.first_child(), "height");
    if (!(width >= 1 && height >= 1)) throw std::logic_error("a drawing without a size");
  }
  void draw(const Surface& surface, double scale) const {
    cairo_surface_set_device_scale(surface.get(), scale, scale);
    Painter painter(surface);
    painter.draw(document.first_child());
    painter.require_success();
    cairo_surface_flush(surface.get());
  }

  pugi::xml_document document;
  double width = 0, height = 0;
};

}  // namespace

std::string svg_to_png(const std::string& svg) {
  constexpr double usual = 2, most_pixels = 32767;
  const Drawing drawing(svg);
  const double scale = std::min({usual, most_pixels / drawing.width, most_pixels / drawing.height});
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(drawing.width * scale),
                                                   static_cast<int>(drawing.height * scale)));
  drawing.draw(surface, scale);
  std::string bytes;
  require(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  return bytes;
}

std::string svg_to_pdf(const std::string& svg) {
  constexpr double points_of_a_pixel = 0.75;
  const Drawing drawing(svg);
  std::string bytes;
  const Surface surface(cairo_pdf_surface_create_for_stream(append, &bytes, drawing.width * points_of_a_pixel,
                                                            drawing.height * points_of_a_pixel));
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "1980-01-01T00:00:00Z");
  drawing.draw(surface, points_of_a_pixel);
  cairo_surface_finish(surface.get());
  require(cairo_surface_status(surface.get()));
  return bytes;
}

}  // namespace eomgen::cli
