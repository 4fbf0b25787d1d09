// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plot_file.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "cli/picture/svg_picture.hpp"
#include "cli/text_plot.hpp"

namespace eomgen::cli {
namespace {

std::size_t terminal_columns() {
  constexpr std::size_t usual = 80, most = 160;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return usual;
  return std::min<std::size_t>(size.ws_col, most);
}

}  // namespace

std::uint64_t PlotFile::write(const std::function<std::string()>& svg,
                              const std::function<std::string(std::size_t columns)>& characters) const {
  if (path_ == "-") return write_text(path_, characters(terminal_columns()));
  const std::string drawing = svg(), extension = lowered_extension(path_);
  return write_text(path_, extension == ".png"   ? svg_to_png(drawing)
                           : extension == ".pdf" ? svg_to_pdf(drawing)
                                                 : drawing);
}

std::uint64_t PlotFile::write(const eom::Plot& plot) const {
  return write([&] { return eom::svg(plot); },
               [&](std::size_t columns) { return plot.title + "\n\n" + render_text_plot(text_plot(plot), columns); });
}

}  // namespace eomgen::cli
