// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/certificate_cache.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "emit/shared_library/cache_folder.hpp"
#include "error.hpp"
#include "model/content_hash.hpp"

namespace eomgen::pipeline {
namespace {

using nlohmann::json;

constexpr std::uintmax_t most_bytes = 4 << 20;

/// Nothing if there is no folder that can be trusted. Emission needs none; commands that run code report it.
std::optional<std::filesystem::path> folder_of_certificates() {
  try {
    const emit::CacheFolder folder = emit::cache_folder();
    if (folder.scratch) return std::nullopt;
    return folder.path;
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::filesystem::path place_of(const std::filesystem::path& folder, const std::string& key) {
  return folder / ("certificate-" + model::content_hash(key) + ".json");
}

json to_json(const verify::Certificate& c) {
  json comparisons = json::array(), left_out = json::array();
  for (const verify::Comparison& row : c.comparisons)
    comparisons.push_back(
        {row.a, row.b, row.shares_code, row.max_relative_difference, row.tolerance, row.digits_agreed});
  for (const work::LeftOut& l : c.left_out) left_out.push_back({l.what, l.why, l.over_budget});
  return {{"points", c.points}, {"rejected", c.rejected}, {"comparisons", comparisons}, {"left_out", left_out}};
}

verify::Certificate from_json(const json& document) {
  verify::Certificate c;
  c.points = document.at("points").get<std::size_t>();
  c.rejected = document.at("rejected").get<std::map<std::string, std::size_t>>();
  for (const json& row : document.at("comparisons")) {
    c.comparisons.push_back({row.at(0).get<std::string>(), row.at(1).get<std::string>(), row.at(2).get<bool>(),
                             row.at(3).get<double>(), row.at(4).get<double>(), row.at(5).get<int>(), true});
  }
  for (const json& l : document.at("left_out"))
    c.left_out.push_back({l.at(0).get<std::string>(), l.at(1).get<std::string>(), l.at(2).get<bool>()});
  c.pass = !c.comparisons.empty();
  return c;
}

}  // namespace

std::string program_identity() {
  const auto of_file = [](const char* path) -> std::string {
    struct stat own {};
    if (path == nullptr || ::stat(path, &own) != 0) return "";
    return fmt::format("{} {} {} {}.{:09}", own.st_dev, own.st_ino, own.st_size, own.st_mtim.tv_sec,
                       own.st_mtim.tv_nsec);
  };
  const std::string program = of_file("/proc/self/exe");
  if (program.empty()) return "";
  // If this code is part of a library, that file too.
  Dl_info library{};
  const bool known = ::dladdr(reinterpret_cast<const void*>(&program_identity), &library) != 0;
  return program + (known ? " " + of_file(library.dli_fname) : "");
}

std::optional<verify::Certificate> load_certificate(const std::string& key) {
  const std::optional<std::filesystem::path> folder = folder_of_certificates();
  if (!folder) return std::nullopt;
  try {
    const std::filesystem::path path = place_of(*folder, key);
    if (!emit::is_own_file(path) || std::filesystem::file_size(path) > most_bytes) return std::nullopt;
    std::ifstream in(path);
    const json document = json::parse(in);
    if (document.at("key") != model::content_hash("certificate of " + key)) return std::nullopt;
    verify::Certificate certificate = from_json(document);
    return certificate.pass ? std::optional(std::move(certificate)) : std::nullopt;
  } catch (const json::exception&) {
    return std::nullopt;  // truncated or of another version: verify again
  } catch (const std::filesystem::filesystem_error&) {
    return std::nullopt;
  }
}

void store_certificate(const std::string& key, const verify::Certificate& certificate) {
  if (!certificate.pass || certificate.interrupted) return;
  const std::optional<std::filesystem::path> folder = folder_of_certificates();
  if (!folder) return;
  try {
    json document = to_json(certificate);
    document["key"] = model::content_hash("certificate of " + key);
    const emit::ScratchFolder workplace(*folder, emit::scratch_prefix);
    const std::filesystem::path written = workplace.path() / "certificate";
    std::ofstream out(written);
    out << document.dump() << '\n';
    out.close();
    if (out) std::filesystem::rename(written, place_of(*folder, key));
  } catch (const std::system_error&) {
    return;  // for example a full disk: the next command verifies again
  }
}

}  // namespace eomgen::pipeline
