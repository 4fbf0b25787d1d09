// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/sum_memo.hpp"

namespace eomgen::reading {

// Owners are compared, since another Dag may get the address of one that no longer exists.
bool SumMemo::is_of(const std::shared_ptr<symbolic::Dag>& dag) const {
  return !dag_.owner_before(dag) && !dag.owner_before(dag_);
}

std::optional<Sum> SumMemo::find(const std::shared_ptr<symbolic::Dag>& dag, symbolic::Ref expression) {
  const std::lock_guard lock(mutex_);
  if (!is_of(dag)) return std::nullopt;
  const auto found = sums_.find(expression);
  return found == sums_.end() ? std::nullopt : std::optional(found->second);
}

void SumMemo::store(const std::shared_ptr<symbolic::Dag>& dag, symbolic::Ref expression, const Sum& sum) {
  const std::lock_guard lock(mutex_);
  if (!is_of(dag)) {
    sums_.clear();
    dag_ = dag;
  }
  sums_.emplace(expression, sum);
}

}  // namespace eomgen::reading
