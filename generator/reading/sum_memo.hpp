// SPDX-License-Identifier: GPL-3.0-or-later
// Sums that were converted from nodes of the Dag used last. Documents show the same generalised forces in several
// forms, and each conversion of a long force takes a fraction of a second.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Safe to use from several threads, which then may replace each other's Dag.
class SumMemo {
 public:
  std::optional<Sum> find(const std::shared_ptr<symbolic::Dag>& dag, symbolic::Ref expression);
  void store(const std::shared_ptr<symbolic::Dag>& dag, symbolic::Ref expression, const Sum& sum);

 private:
  bool is_of(const std::shared_ptr<symbolic::Dag>& dag) const;

  std::mutex mutex_;
  std::weak_ptr<symbolic::Dag> dag_;
  std::map<symbolic::Ref, Sum> sums_;
};

}  // namespace eomgen::reading
