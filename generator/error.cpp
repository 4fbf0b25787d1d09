// SPDX-License-Identifier: GPL-3.0-or-later
#include "error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace eomgen {
namespace {

// Replaces control characters, which must not reach the terminal from an untrusted file, by one byte each: columns stay
// valid.
std::string printable(const std::string& line) {
  std::string result = line;
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return result;
}

// Only the surroundings of the place are shown of a long line.
std::string source_excerpt(const SourceLocation& where) {
  constexpr std::size_t window = 100;
  std::string line = printable(where.text);
  std::size_t caret = where.column > 0 ? where.column - 1 : 0;
  std::size_t begin = 0;
  if (line.size() > window && caret > window / 2) begin = std::min(caret - window / 2, line.size() - window);
  line = line.substr(begin, window);
  caret -= std::min(caret, begin);
  const std::size_t length =
      std::clamp<std::size_t>(where.length, 1, std::max<std::size_t>(1, window - std::min(caret, window - 1)));
  const std::string number = std::to_string(where.line);
  return fmt::format("  {} | {}\n  {} | {}^{}\n", number, line, std::string(number.size(), ' '),
                     std::string(caret, ' '), std::string(length - 1, '~'));
}

std::string report(const char* grade, const SourceLocation& where, const std::string& message,
                   const std::string& remedy) {
  std::string result;
  if (!where.file.empty()) result += printable(where.file) + ":";
  if (where.line > 0) result += fmt::format("{}:{}:", where.line, where.column);
  if (!result.empty()) result += ' ';
  result += fmt::format("{}: {}\n", grade, message);
  if (where.line > 0 && !where.text.empty()) result += source_excerpt(where);
  if (!remedy.empty()) result += fmt::format("  remedy: {}\n", remedy);
  return result;
}

}  // namespace

Error::Error(std::string stage, SourceLocation where, std::string what, std::string remedy, ErrorKind fault)
    : stage_(std::move(stage)),
      where_(std::move(where)),
      message_(std::move(what)),
      remedy_(std::move(remedy)),
      fault_(fault),
      report_(report("error", where_, message_, remedy_)) {}

int Error::exit_code() const noexcept {
  switch (fault_) {
    case ErrorKind::check: return 1;
    case ErrorKind::input: return 2;
    case ErrorKind::numerical: return 3;
    case ErrorKind::tool: return 4;
  }
  return 2;
}

std::string format_warning(const Warning& warning) {
  return report("warning", warning.where, warning.message, warning.remedy);
}

}  // namespace eomgen
