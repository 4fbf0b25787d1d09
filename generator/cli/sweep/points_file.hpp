// SPDX-License-Identifier: GPL-3.0-or-later
// Values of parameters that a file gives: a CSV table whose first line names them, each further line a point. In: its
// path. Out: points.
#pragma once

#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::cli {

class PointsFile {
 public:
  /// Lines that are empty or begin with # are left out. Throws Error with the number of the line for what is no such
  /// table.
  explicit PointsFile(const std::string& path);

  const std::vector<std::string>& names() const { return names_; }
  std::size_t size() const { return values_.size() / names_.size(); }
  /// In the order of the names.
  std::vector<symbolic::Rational> point(std::size_t index) const;
  /// Of its bytes.
  const std::string& content_hash() const { return hash_; }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  std::string hash_;
};

}  // namespace eomgen::cli
