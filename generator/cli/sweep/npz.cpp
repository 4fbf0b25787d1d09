// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/npz.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <eom/output/atomic_file.hpp>
#include <eom/output/decimal.hpp>
#include <limits>

#include "emit/fmu/zip.hpp"
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

std::string bytes_type(std::size_t width) { return fmt::format("|S{}", width); }

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

/// A member of the archive.
struct Column {
  std::string name, type;
  std::size_t width, count;  // bytes of an entry; entries
};

class ColumnArchive {
 public:
  ColumnArchive(const std::string& key, const std::string& header, const Rows& rows) : rows_(rows), key_(key) {
    const auto commas = static_cast<std::size_t>(std::count(header.begin(), header.end(), ','));
    for (const std::string_view name : fields_of(header, commas)) names_.emplace_back(name);
    const auto outcome = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), "outcome") - names_.begin());
    std::size_t outcome_width = 1, details = 0, detail_width = 1;
    rows_.for_each(0, rows_.size(), [&](std::size_t, std::string_view line) {
      const std::vector<std::string_view> fields = fields_of(line, names_.size());
      if (outcome < fields.size()) outcome_width = std::max(outcome_width, fields[outcome].size());
      if (fields.back().empty()) return;
      ++details;
      detail_width = std::max(detail_width, unquoted(fields.back()).size());
    });
    for (std::size_t k = 0; k + 1 < names_.size(); ++k) {
      const std::size_t width = k == outcome ? outcome_width : 8;
      columns_.push_back({names_[k], k == 0 ? "<i8" : k == outcome ? bytes_type(width) : "<f8", width, rows_.size()});
    }
    columns_.push_back({"detail_run", "<i8", 8, details});
    columns_.push_back({"detail", bytes_type(detail_width), detail_width, details});
  }

  void write(const std::string& path) const {
    eom::AtomicFile file(path);
    if (file.partial().empty())
      throw Error("sweep", {}, fmt::format("{} is no file, and an archive of columns needs one", model::quote(path)),
                  "name a file, or write the table as .csv");
    try {
      emit::ZipWriter archive(::fdopen(::fcntl(file.descriptor(), F_DUPFD_CLOEXEC, 3), "wb"), path);
      start(archive, {"sweep", bytes_type(key_.size()), key_.size(), 1}, "");
      archive.write(key_);
      for (std::size_t first = 0; first < columns_.size();) first = write_columns(archive, first);
      archive.finish();
      file.finish();
    } catch (...) {
      file.discard();
      throw;
    }
  }

 private:
  static void start(emit::ZipWriter& archive, const Column& column, const std::string& shape) {
    const std::string header = npy_header(column.type, shape);
    archive.start(column.name + ".npy", header.size() + column.width * column.count);
    archive.write(header);
  }

  /// Writes columns that fit into memory together, at least one, in one pass over the rows. Returns the next column.
  std::size_t write_columns(emit::ZipWriter& archive, std::size_t first) const {
    constexpr std::size_t most = 1 << 26, enough = 1 << 20;  // bytes in memory; bytes at a time of a single column
    std::size_t last = first;
    for (std::size_t held = 0; last < columns_.size(); ++last) {
      held += columns_[last].width * columns_[last].count;
      if (held > most && last > first) break;
    }
    const auto begin = [&](std::size_t k) { start(archive, columns_[k], fmt::format("{},", columns_[k].count)); };
    std::vector<std::string> texts(last - first);
    const bool is_single = last == first + 1;
    if (is_single) begin(first);
    rows_.for_each(0, rows_.size(), [&](std::size_t run, std::string_view line) {
      const std::vector<std::string_view> fields = fields_of(line, names_.size());
      for (std::size_t k = first; k < last; ++k) append_entry(texts[k - first], k, run, fields);
      if (!is_single || texts[0].size() < enough) return;
      archive.write(texts[0]);
      texts[0].clear();
    });
    for (std::size_t k = first; k < last; ++k) {
      if (!is_single) begin(k);
      archive.write(texts[k - first]);
    }
    return last;
  }

  void append_entry(std::string& text, std::size_t k, std::size_t run,
                    const std::vector<std::string_view>& fields) const {
    const bool is_detail = k + 1 >= names_.size();
    if (is_detail && fields.back().empty()) return;
    const Column& column = columns_[k];
    if (column.type == "<i8") return append(text, static_cast<std::uint64_t>(run));
    if (column.type == "<f8") return append(text, value_of(fields[k]));
    const std::string bytes = is_detail ? unquoted(fields.back()) : std::string(fields[k]);
    text.append(bytes).append(column.width - bytes.size(), '\0');
  }

  const Rows& rows_;
  std::string key_;
  std::vector<std::string> names_;
  std::vector<Column> columns_;
};

}  // namespace

bool is_npz(const std::string& path) { return path.ends_with(".npz"); }

void write_npz(const std::string& path, const std::string& key, const std::string& header, const Rows& rows) {
  ColumnArchive(key, header, rows).write(path);
}

}  // namespace eomgen::cli
