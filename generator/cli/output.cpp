// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/output.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <eom/output/atomic_file.hpp>
#include <filesystem>
#include <system_error>

#include "emit/write_files.hpp"
#include "error.hpp"

namespace eomgen::cli {
namespace {

namespace fs = std::filesystem;

/// File extensions that denote a format; others (.out, .2026, none) do not.
constexpr std::array known_extensions{
    ".csv", ".tsv",  ".svg",  ".png",  ".jpg", ".jpeg", ".gif", ".bmp", ".pdf", ".ps",  ".eps",  ".html", ".htm",
    ".xml", ".json", ".toml", ".yaml", ".md",  ".tex",  ".c",   ".h",   ".cpp", ".hpp", ".py",   ".m",    ".mat",
    ".npy", ".npz",  ".h5",   ".hdf5", ".xls", ".xlsx", ".ods", ".zip", ".gz",  ".doc", ".docx", ".webp", ".mp4"};

void remove_signs_of_zeros(Json& value) {
  if (value.is_number_float()) value = unsigned_zero(value.get<double>());
  if (!value.is_structured()) return;
  for (Json& element : value) remove_signs_of_zeros(element);
}

struct Identity {
  bool there = false;
  dev_t device = 0;
  ino_t inode = 0;
  mode_t mode = 0;
};

Identity identity(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {true, found.st_dev, found.st_ino, found.st_mode};
}

bool same_file(const Identity& a, const Identity& b) {
  return a.there && b.there && a.device == b.device && a.inode == b.inode;
}

bool is_device(const Identity& place) { return place.there && S_ISCHR(place.mode); }

/// Canonical path of a file that need not exist; equal for two names of the same file.
std::string final_path(const std::string& path) {
  std::error_code none;
  const fs::path absolute = fs::absolute(path, none);
  const fs::path resolved = fs::weakly_canonical(absolute, none);
  return (resolved.empty() ? absolute : resolved).string();
}

[[noreturn]] void refuse(const OutputTarget& place, const std::string& what, const std::string& remedy) {
  throw Error("cli", {}, fmt::format("{} {}: {}", place.option, place.path.empty() ? "''" : place.path, what), remedy);
}

void require_extension(const OutputTarget& place) {
  if (place.extension.empty()) return;
  const std::string extension = lowered_extension(place.path);
  if (extension == place.extension || (place.extension == ".html" && extension == ".htm")) return;
  std::vector<std::string> allowed{place.extension};
  allowed.insert(allowed.end(), place.alternatives.begin(), place.alternatives.end());
  const auto is_any = [&](const auto& list) { return std::find(list.begin(), list.end(), extension) != list.end(); };
  const bool chooses = allowed.size() > 1;
  if (chooses ? extension.size() < 2 || is_any(allowed) : !is_any(known_extensions)) return;
  std::string formats, names;
  for (const std::string& other : allowed) {
    const char* const before = formats.empty() ? "" : &other == &allowed.back() ? " or " : ", ";
    formats += before + other.substr(1);
    names += before + fs::path(place.path).replace_extension(other).string();
  }
  refuse(place, fmt::format("this option writes {}, and the name ends with {}", formats, extension.substr(1)),
         "name it " + names);
}

void require_writable(const OutputTarget& place, const std::string& model_file) {
  // Compare the opened file: the target of a link such as /dev/stdout need not have a path.
  const Identity opened = identity(place.path);
  if (opened.there && !S_ISREG(opened.mode) && !S_ISDIR(opened.mode)) {
    if (::access(place.path.c_str(), W_OK) != 0) refuse(place, "this may not be written to", "choose another place");
    return;  // pipes and devices are written to directly
  }
  std::string path = place.path;
  try {
    path = eom::AtomicFile::resolve_links(place.path).string();
  } catch (const std::system_error&) {
    refuse(place, "the links lead in a circle", "choose another name");
  }
  const Identity target = identity(path);
  if (target.there && S_ISDIR(target.mode)) refuse(place, "this is a folder, not a file", "name a file in it");
  if (!model_file.empty() && same_file(target, identity(model_file))) {
    refuse(place, "this is the model's own file, which the results would replace", "choose another name");
  }
  if (target.there && ::access(path.c_str(), W_OK) != 0)
    refuse(place, "this file may not be written to", "choose another name, or chmod u+w it");
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  const std::string name = fs::path(path).filename().string();
  constexpr std::size_t longest_name = 255;  // on Linux file systems
  if (name.size() > longest_name)
    refuse(place, fmt::format("the name has {} bytes, and a file's has at most {}", name.size(), longest_name),
           "choose a shorter one");
  std::error_code ignored;  // an inaccessible folder fails in access() as well
  if (!fs::is_directory(folder, ignored))
    refuse(place, "there is no folder " + folder.string(), "make the folder first");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(place, "the folder " + folder.string() + " may not be written to", "choose another folder");
}

template <typename Write>
auto writing(Write write) {
  try {
    return write();
  } catch (const std::system_error& error) {  // the writer belongs to the runtime, which has no Error
    throw Error("cli", {}, error.what(),
                error.code() == std::errc::broken_pipe ? "let the program that reads it read to the end"
                                                       : "see to space on that disk and to your rights there",
                emit::write_fault(error.code()));
  }
}

eom::AtomicFile open(const std::string& path) {
  return writing([&] { return path == "-" ? eom::AtomicFile::standard_output() : eom::AtomicFile(path); });
}

}  // namespace

void print_document(const Json& document) {
  Json shown = document;
  remove_signs_of_zeros(shown);
  fmt::print("{}\n", serialised(shown, 2));
}

void print_message(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string lowered_extension(const std::string& path) {
  std::string text = fs::path(path).extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_standard_output(const std::string& path) {
  if (path.empty()) return false;
  if (path == "-") return true;
  struct stat standard {};
  const Identity place = identity(path);
  return place.there && ::fstat(STDOUT_FILENO, &standard) == 0 && standard.st_dev == place.device &&
         standard.st_ino == place.inode && path != "/dev/null";
}

void require_writable_targets(const std::vector<OutputTarget>& places, const std::string& model_file, bool json) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const OutputTarget& place = places[i];
    if (place.path.empty()) refuse(place, "names no file", "name one, or - for standard output");
    const bool standard = is_standard_output(place.path);
    if (standard && json)
      refuse(place, "standard output has the JSON document already", "name a file, or leave --json out");
    for (std::size_t j = 0; j < i; ++j) {
      const OutputTarget& other = places[j];
      const Identity here = identity(place.path);
      const bool same = (standard && is_standard_output(other.path)) ||
                        (!is_device(here) && same_file(here, identity(other.path))) ||
                        (!here.there && final_path(place.path) == final_path(other.path));
      if (same) refuse(place, fmt::format("{} writes to the same place", other.option), "give each a file of its own");
    }
    if (place.path == "-") continue;
    require_extension(place);
    if (!standard || same_file(identity(place.path), identity(model_file))) require_writable(place, model_file);
  }
}

void require_folder(const std::string& folder) {
  std::error_code none;
  const std::string extension = lowered_extension(folder);
  const bool of_a_file =
      std::find(known_extensions.begin(), known_extensions.end(), extension) != known_extensions.end();
  const OutputTarget place{"--out", folder, ""};
  if (folder == "-") refuse(place, "several files do not fit into standard output", "name a folder for them");
  if (fs::exists(folder, none) && !fs::is_directory(folder, none))
    refuse(place, "this is a file, and a folder is asked", "name a folder; the files have their own names");
  if (of_a_file && !fs::is_directory(folder, none))
    refuse(place, fmt::format("a folder is required, and the name ends with {}", extension.substr(1)),
           "name a folder; the files have their own names");
}

std::uint64_t write_text(const std::string& path, const std::string& text) {
  eom::AtomicFile file = open(path);
  return writing([&] {
    try {
      file.write(text);
      file.finish();
    } catch (const std::system_error&) {
      file.discard();  // the file can be generated again, so no part is kept
      throw;
    }
    return file.bytes();
  });
}

TableFile::TableFile(const std::string& path, std::span<const std::string> columns)
    : writer_(writing([&] { return eom::CsvWriter(open(path), columns); })) {}
void TableFile::row(double t, std::span<const double> values) {
  writing([&] { writer_.row(t, values); });
}
void TableFile::finish(eom::Outcome outcome) {
  writing([&] { writer_.finish(outcome); });
}

std::vector<std::string> write_results(const std::string& folder, const std::vector<emit::EmittedFile>& files,
                                       const std::string& model_file) {
  for (const emit::EmittedFile& file : files) {
    const std::string path = (fs::path(folder) / file.name).string();
    if (same_file(identity(path), identity(model_file))) {
      throw Error("cli", {}, fmt::format("{} is the model's own file, which the results would replace", path),
                  "choose another folder");
    }
  }
  return emit::write_files(folder, files);
}

void print_readable(std::string_view text, bool output_taken) {
  if (output_taken) {
    print_message(text);
  } else {
    fmt::print("{}", text);
  }
}

void print_result(bool json, const Json& document, std::string_view text, bool output_taken) {
  if (json)
    print_document(document);
  else
    print_readable(text, output_taken);
}

std::string size_text(double bytes) {
  constexpr std::array units{"bytes", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  for (; bytes >= 1000 && unit + 1 < units.size(); ++unit) bytes /= 1000;
  return unit == 0 ? fmt::format("{:.0f} {}", bytes, units[unit]) : fmt::format("{:.3g} {}", bytes, units[unit]);
}

std::string shortest(double value) { return fmt::format("{}", unsigned_zero(value)); }

}  // namespace eomgen::cli
