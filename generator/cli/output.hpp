// SPDX-License-Identifier: GPL-3.0-or-later
// Where results go: documents to standard output, files to paths from the command line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "emit/targets.hpp"

namespace eomgen::cli {

/// Of a result: 0 has no sign.
inline double unsigned_zero(double value) { return value == 0 ? 0 : value; }

/// To standard output. Bytes that are no UTF-8 (of a path, say) are replaced, numbers that are not finite are null, -0 is 0.
void print_document(nlohmann::ordered_json document);

/// emit::write_files for a folder that the user named: what is wrong with it is wrong input.
std::vector<std::string> write_results(const std::string& folder, const std::vector<emit::EmittedFile>& files);

/// Throws Error unless a file can be made or replaced at `path`. Called before the work whose result goes there.
void require_writable(const std::string& option, const std::string& path);

/// The shortest decimal that reads back as the same binary64.
std::string shortest(double value);

}  // namespace eomgen::cli
