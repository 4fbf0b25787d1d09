// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/npz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <eom/output/decimal.hpp>
#include <limits>
#include <stdexcept>

#include "cli/sweep/archive.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

/// Header of a .npy file: version 1.0, padded so that the data are aligned.
std::string npy_header(const std::string& type, const std::string& shape) {
  constexpr std::size_t fixed = 10, alignment = 64;
  std::string dictionary = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  dictionary.resize((fixed + dictionary.size() + 1 + alignment - 1) / alignment * alignment - fixed - 1, ' ');
  dictionary += '\n';
  const std::size_t length = dictionary.size();
  return std::string("\x93NUMPY\x01", 7) + '\0' + static_cast<char>(length & 0xff) + static_cast<char>(length >> 8) +
         dictionary;
}

std::string bytes_type(std::size_t width) { return fmt::format("|S{}", std::max<std::size_t>(width, 1)); }

/// The fields of a row or of the header up to the detail, without the checksum.
std::vector<std::string_view> fields_of(std::string_view line, std::size_t count) {
  std::vector<std::string_view> fields;
  line = line.substr(0, line.rfind(','));
  for (; fields.size() + 1 < count; line.remove_prefix(fields.back().size() + 1))
    fields.push_back(line.substr(0, line.find(',')));
  fields.push_back(line);  // the detail may be quoted
  return fields;
}

/// Removes the quotation of a CSV field.
std::string unquoted(std::string_view field) {
  if (field.empty() || field.front() != '"') return std::string(field);
  std::string text;
  for (std::size_t i = 1; i + 1 < field.size(); ++i) {
    text += field[i];
    if (field[i] == '"') ++i;
  }
  return text;
}

double value_of(std::string_view field) {
  double value = std::numeric_limits<double>::quiet_NaN();
  const auto [stop, error] = eom::decimals::read_decimal(field, value);
  return error == std::errc() && stop == field.data() + field.size() ? value : std::numeric_limits<double>::quiet_NaN();
}

/// Eight bytes, little-endian.
template <class T>
void append(std::string& text, T value) {
  std::uint64_t bits = 0;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 8; ++i) text += static_cast<char>(bits >> (8 * i) & 0xff);
}

void append(std::string& text, std::string_view bytes, std::size_t width) {
  text += bytes;
  text.append(width - bytes.size(), '\0');
}

class ColumnArchive {
 public:
  ColumnArchive(const std::string& key, const std::string& header, const Rows& rows) : rows_(rows), key_(key) {
    const auto commas = static_cast<std::size_t>(std::count(header.begin(), header.end(), ','));
    for (const std::string_view name : fields_of(header, commas)) names_.emplace_back(name);
    outcome_ = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), "outcome") - names_.begin());
    rows_.for_each(0, rows_.size(), [this](std::size_t, std::string_view line) {
      const std::vector<std::string_view> fields = fields_of(line, names_.size());
      if (outcome_ < fields.size()) outcome_width_ = std::max(outcome_width_, fields[outcome_].size());
      if (fields.back().empty()) return;
      ++details_;
      detail_width_ = std::max(detail_width_, unquoted(fields.back()).size());
    });
  }

  void write(const std::string& path) {
    const std::string each = fmt::format("{},", rows_.size()), some = fmt::format("{},", details_);
    add("sweep", bytes_type(key_.size()), "", 1, key_.size());
    for (std::size_t k = 0; k + 1 < names_.size(); ++k) {
      if (k == 0)
        add(names_[k], "<i8", each, rows_.size(), 8);
      else if (k == outcome_)
        add(names_[k], bytes_type(outcome_width_), each, rows_.size(), outcome_width_);
      else
        add(names_[k], "<f8", each, rows_.size(), 8);
    }
    add("detail_run", "<i8", some, details_, 8);
    add("detail", bytes_type(detail_width_), some, details_, detail_width_);
    Archive archive(path, members_);
    try {
      for (std::size_t i = 0; i < headers_.size(); ++i) archive.write(i, headers_[i]);
      archive.write(0, key_);
      fill(archive);
      archive.finish();
    } catch (...) {
      archive.discard();
      throw;
    }
  }

 private:
  void add(const std::string& name, const std::string& type, const std::string& shape, std::size_t count,
           std::size_t width) {
    headers_.push_back(npy_header(type, shape));
    members_.push_back({name + ".npy", headers_.back().size() + count * std::max<std::size_t>(width, 1)});
  }

  void fill(Archive& archive) {
    constexpr std::size_t enough = 4096;  // rows at a time
    std::vector<std::string> columns(members_.size());
    for (std::size_t first = 0; first < rows_.size(); first += enough) {
      rows_.for_each(first, std::min(first + enough, rows_.size()), [&](std::size_t run, std::string_view line) {
        const std::vector<std::string_view> fields = fields_of(line, names_.size());
        for (std::size_t k = 0; k + 1 < names_.size(); ++k) {
          if (k == 0)
            append(columns[k + 1], static_cast<std::uint64_t>(run));
          else if (k == outcome_)
            append(columns[k + 1], fields[k], std::max<std::size_t>(outcome_width_, 1));
          else
            append(columns[k + 1], value_of(fields[k]));
        }
        if (fields.back().empty()) return;
        append(columns[names_.size()], static_cast<std::uint64_t>(run));
        append(columns[names_.size() + 1], unquoted(fields.back()), detail_width_);
      });
      for (std::size_t i = 0; i < columns.size(); ++i) {
        archive.write(i, columns[i]);
        columns[i].clear();
      }
    }
  }

  const Rows& rows_;
  std::string key_;
  std::vector<std::string> names_, headers_;
  std::vector<Archive::Member> members_;
  std::size_t outcome_ = 0, outcome_width_ = 0, details_ = 0, detail_width_ = 0;
};

}  // namespace

bool is_npz(const std::string& path) { return path.ends_with(".npz"); }

void write_npz(const std::string& path, const std::string& key, const std::string& header, const Rows& rows) try {
  ColumnArchive(key, header, rows).write(path);
} catch (const std::invalid_argument&) {
  throw Error("sweep", {}, fmt::format("{} is no file, and an archive of columns needs one", model::quote(path)),
              "name a file, or write the table as .csv");
}

}  // namespace eomgen::cli
