// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/ledger.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "cli/output.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

constexpr const char* mark = "# sweep: ";

[[noreturn]] void lost(const std::string& path) {
  throw Error("sweep", {}, fmt::format("{} cannot be written: {}", model::quote(path), std::strerror(errno)),
              "see to space on that disk and to your rights there; the same command goes on from what is there", Fault::tool);
}

}  // namespace

Ledger::Ledger(std::string file, std::string key) : file_(std::move(file)), partial_(file_ + ".partial"), key_(std::move(key)) {
  if (!read(partial_)) {
    if (std::filesystem::exists(partial_)) {
      throw Error("sweep", {}, fmt::format("{} is the unfinished table of another sweep", model::quote(partial_)),
                  "finish that sweep with its own options, remove the file, or write to another one with --out");
    }
    read(file_);
  }
}

// Whole lines only: the last may have been cut off.
bool Ledger::read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return false;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::size_t begin = 0, number = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1, ++number) {
    const std::string line = text.substr(begin, end - begin);
    if (number == 0 && line != mark + key_) return false;
    if (number == 1) header_ = line;
    if (number < 2) continue;
    std::size_t run = 0;
    const auto [stop, error] = std::from_chars(line.data(), line.data() + line.size(), run);
    if (error == std::errc() && stop != line.data() + line.size() && *stop == ',') rows_[run] = line;
  }
  return number > 0;
}

void Ledger::set_header(const std::string& header) {
  if (header_ != header) rows_.clear();  // a table of other columns cannot be gone on with
  header_ = header;
  out_.reset(std::fopen((partial_ + ".new").c_str(), "wb"));
  if (out_ == nullptr) lost(partial_);
  std::string text = mark + key_ + "\n" + header_ + "\n";
  for (const auto& [run, line] : rows_) text += line + "\n";
  write(text);
  if (std::rename((partial_ + ".new").c_str(), partial_.c_str()) != 0) lost(partial_);
}

void Ledger::add(std::size_t run, const std::string& line) {
  rows_[run] = line;
  write(line + "\n");
}

void Ledger::finish() {
  if (out_ == nullptr) return;  // all was there
  out_.reset();
  std::string text = mark + key_ + "\n" + header_ + "\n";
  for (const auto& [run, line] : rows_) text += line + "\n";
  const std::filesystem::path path(file_);
  write_results(path.has_parent_path() ? path.parent_path().string() : ".", {{path.filename().string(), text}});
  std::filesystem::remove(partial_);
}

void Ledger::write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), out_.get()) != text.size() || std::fflush(out_.get()) != 0) lost(partial_);
}

}  // namespace eomgen::cli
