// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/compliance_loops.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "derive/trees/link_compliance.hpp"

namespace eomgen::derive {
namespace {

using system::ArrayEntry;
using system::ArrayStep;

// Passes are padded to a multiple, so that loops have no rest for vectors of processors.
constexpr std::size_t padding = 8;
constexpr std::size_t acceleration_rows = 6, column_rows = 9;  // an acceleration; and an angular velocity
// Rows of the result are written together, so that the entries of a column are adjacent.
constexpr std::size_t rows_together = 16;

std::size_t padded(std::size_t count) { return (count + padding - 1) / padding * padding; }

/// Part of the working memory: rows of equal width. A row that is zero in all passes is neither written nor read.
struct LaneRows {
  std::size_t first = 0, width = 0;
  std::vector<bool> nonzero;

  std::size_t entry(std::size_t row, std::size_t lane) const { return first + row * width + lane; }
};

/// A range of lanes.
struct Range {
  std::size_t from = 0, to = 0;
};

class ComplianceLoops {
 public:
  ComplianceLoops(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                  const std::vector<LinkDynamics>& dynamics)
      : dag_(dag), tree_(tree), n_(tree.Q.size()), links_(dag, tree, motion, dynamics) {
    children_.resize(tree_.links.size());
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      if (tree_.links[l].parent >= 0) children_[link_number(tree_.links[l].parent)].push_back(l);
    }
  }

  system::AccelerationSlopes run() {
    for (std::size_t l = 0; l < tree_.links.size(); ++l) {
      if (tree_.links[l].parent >= 0) continue;
      measure(l);
      next_ = 0;  // trees use the same memory
      free_.clear();
      reach_buffer_ = take_rows(2 * most_freedoms_, reach_width_);
      spread_buffer_ = take_rows(std::max(rows_together, most_freedoms_), column_width_);
      std::vector<std::size_t> path;
      reach(l, take_rows(acceleration_rows, reach_width_), path);
      spread(l, take_rows(column_rows, column_width_));
      write_rows();
    }
    return std::move(result_);
  }

 private:
  /// The lanes of the columns of a tree: links depth first, for each freedom the coordinate, then its rate.
  void measure(std::size_t root) {
    first_.assign(tree_.links.size(), 0);
    end_.assign(tree_.links.size(), 0);
    lanes_.clear();
    most_freedoms_ = 0;
    std::size_t deepest = 0;
    const std::function<void(std::size_t, std::size_t)> number = [&](std::size_t l, std::size_t depth) {
      first_[l] = lanes_.size();
      for (const Freedom& freedom : tree_.links[l].freedoms) {
        lanes_.push_back(freedom.index);
        lanes_.push_back(n_ + freedom.index);
      }
      most_freedoms_ = std::max(most_freedoms_, tree_.links[l].freedoms.size());
      deepest = std::max(deepest, depth + tree_.links[l].freedoms.size());
      for (const std::size_t child : children_[l]) number(child, depth + tree_.links[l].freedoms.size());
      end_[l] = lanes_.size();
    };
    number(root, 0);
    reach_width_ = padded(deepest);
    column_width_ = padded(lanes_.size());
  }

  LaneRows take_rows(std::size_t rows, std::size_t width) {
    LaneRows result{next_, width, std::vector<bool>(rows, false)};
    for (auto free = free_.begin(); free != free_.end(); ++free) {
      if (free->nonzero.size() != rows || free->width != width) continue;
      result.first = free->first;
      free_.erase(free);
      return result;
    }
    next_ += rows * width;
    result_.work = std::max(result_.work, next_);
    return result;
  }

  ArrayEntry entry(std::size_t coordinate, std::size_t column) const { return {true, column * n_ + coordinate}; }
  std::size_t column(std::size_t l, std::size_t f, std::size_t order) const {
    return order * n_ + tree_.links[l].freedoms[f].index;
  }

  /// Symbols for the inputs of the loop of a step.
  class LoopSymbols {
   public:
    LoopSymbols(Dag& dag, ArrayStep& step) : dag_(dag), step_(step) {}
    Ref operator()(std::size_t input) {
      step_.loop.inputs.push_back(input);
      return dag_.symbol({SymbolKind::vector, static_cast<std::uint32_t>(step_.loop.inputs.size() - 1), 0});
    }
    /// A vector of three or six rows, at lane 0.
    template <class Vector>
    Vector rows(const LaneRows& from, std::size_t first_row) {
      Vector result;
      for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = from.nonzero[first_row + i] ? (*this)(from.entry(first_row + i, 0)) : dag_.zero();
      return result;
    }

   private:
    Dag& dag_;
    ArrayStep& step_;
  };

  /// Marks the rows in which a vector is not zero.
  template <class Vector>
  void mark(const Vector& values, LaneRows& rows, std::size_t first_row) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!dag_.is_zero(values[i])) rows.nonzero[first_row + i] = true;
    }
  }
  /// Adds the values of marked rows to a loop, or to the stores of one lane.
  template <class Vector>
  void put(ArrayStep& step, const Vector& values, const LaneRows& to, std::size_t first_row) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!to.nonzero[first_row + i]) continue;
      step.loop.values.push_back(values[i]);
      step.loop.outputs.push_back(to.entry(first_row + i, 0));
    }
  }
  template <class Vector>
  void store(ArrayStep& step, const Vector& values, const LaneRows& to, std::size_t first_row, std::size_t lane) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (to.nonzero[first_row + i]) step.stores.push_back({values[i], {false, to.entry(first_row + i, lane)}});
    }
  }

  /// LaneRows of a link: those of the parent, unless other children of the parent still need them.
  LaneRows rows_of(std::size_t l, const LaneRows& from) {
    const int parent = tree_.links[l].parent;
    LaneRows to = from;
    if (parent >= 0 && children_[link_number(parent)].back() != l) to = take_rows(from.nonzero.size(), from.width);
    to.nonzero.assign(to.nonzero.size(), false);
    return to;
  }

  /// Accelerations of a link due to the forces on the coordinates of `path`, further in, and the accelerations of these
  /// coordinates due to disturbances that start at the link (Reach; the symmetry of M^-1). `from`: those of the parent.
  void reach(std::size_t l, const LaneRows& from, std::vector<std::size_t>& path) {
    const std::vector<JointResponse>& joints = links_.joints(l);
    const std::vector<Reach>& own = links_.own_reaches(l);
    LaneRows to = rows_of(l, from);
    ArrayStep step;
    step.loop.count = padded(path.size());
    LoopSymbols symbols(dag_, step);
    Vec6 A = zero_vector6(dag_);
    if (!path.empty()) A = acceleration_at(dag_, tree_.links[l], symbols.rows<Vec6>(from, 0));
    for (std::size_t f = 0; f < joints.size() && !path.empty(); ++f) {
      for (std::size_t order = 0; order < 2; ++order) {
        const std::size_t row = 2 * f + order;
        step.loop.values.push_back(dag_.neg(dot6(dag_, A, response(l, f, order).p)));
        step.loop.outputs.push_back(reach_buffer_.entry(row, 0));
        for (std::size_t lane = 0; lane < path.size(); ++lane)
          step.after.push_back({{false, reach_buffer_.entry(row, lane)}, entry(path[lane], column(l, f, order))});
      }
    }
    for (std::size_t f = joints.size(); f-- > 0;) take_freedom(dag_, joints[f], dag_.zero(), A);
    if (!children_[l].empty()) {
      mark(A, to, 0);
      for (const Reach& reach : own) mark(reach.A, to, 0);
      put(step, A, to, 0);
    }
    if (!path.empty()) result_.steps.push_back(std::move(step));
    const std::size_t depth = path.size();
    ArrayStep stores;
    for (const Reach& reach : own) {
      if (!children_[l].empty()) store(stores, reach.A, to, 0, path.size());
      path.push_back(reach.index);
    }
    result_.steps.push_back(std::move(stores));
    for (const std::size_t child : children_[l]) reach(child, to, path);
    path.resize(depth);
    if (to.first != from.first || tree_.links[l].parent < 0) free_.push_back(to);
  }

  SourceResponse& response(std::size_t l, std::size_t f, std::size_t order) {
    const auto [found, added] = responses_.try_emplace({l, f, order});
    if (!added) return found->second.second;
    DisturbanceSource source = order == 0 ? links_.by_coordinate(l, f) : links_.by_rate(l, f);
    const std::vector<Freedom>& freedoms = tree_.links[l].freedoms;
    for (std::size_t k = 0; k < freedoms.size(); ++k) {
      if (dag_.is_zero(tree_.Q[freedoms[k].index])) continue;
      const Symbol slope{SymbolKind::vector, static_cast<std::uint32_t>(result_.forces.size()), 1};
      result_.forces.push_back({slope, freedoms[k].index, column(l, f, order)});
      source.force[k] = dag_.add(source.force[k], dag_.symbol(slope));
    }
    found->second = {source, links_.respond(source)};
    return found->second.second;
  }

  /// Whether the accelerations of a link due to disturbances beyond it are needed, for other branches.
  bool is_passed_inwards(std::size_t l) const {
    return children_[l].size() > 1 || std::any_of(children_[l].begin(), children_[l].end(),
                                                  [this](std::size_t child) { return is_passed_inwards(child); });
  }

  /// Accelerations of a link due to disturbances of all links of the tree, as far as links beyond it need them, and
  /// those of its coordinates. `from`: those of the parent.
  void spread(std::size_t l, const LaneRows& from) {
    const BodyLink& link = tree_.links[l];
    const std::size_t own_end = first_[l] + 2 * link.freedoms.size();
    const bool inwards = is_passed_inwards(l) && own_end < end_[l], passed = !children_[l].empty();
    LaneRows to = rows_of(l, from);
    if (written_.size() + link.freedoms.size() > spread_buffer_.nonzero.size()) write_rows();
    const Transported transported = transport(l, from);
    Transported inner;
    if (inwards) inner = pass_inwards(l, from);
    mark(transported.A, to, 0);
    mark(transported.omega, to, acceleration_rows);
    mark(inner.A, to, 0);
    for (std::size_t f = 0; f < link.freedoms.size(); ++f) {
      for (std::size_t order = 0; order < 2; ++order) {
        mark(response(l, f, order).A, to, 0);
        mark(responses_.at({l, f, order}).first.omega, to, acceleration_rows);
      }
    }
    for (const Range range : {Range{0, first_[l]}, Range{end_[l], lanes_.size()}}) {
      if (range.from == range.to || link.parent < 0) continue;
      ArrayStep step = transported.step;
      step.loop.count = range.to - range.from;
      // Padding may write to lanes of links beyond, which follow, but not to those of other branches.
      const std::size_t limit = range.from == 0 && end_[l] < lanes_.size() ? end_[l] : column_width_;
      if (!inwards) step.loop.count = std::min(padded(step.loop.count), limit - range.from);
      finish(passed, transported, to, range, std::move(step));
    }
    if (inwards) {
      ArrayStep step = inner.step;
      const Range range{own_end, end_[l]};
      step.loop.count = range.to - range.from;
      for (std::size_t f = 0; f < link.freedoms.size(); ++f) read_row(l, f, range, step);
      finish(passed, inner, to, range, std::move(step));
    }
    store_own(l, to, passed);
    for (const JointResponse& joint : links_.joints(l)) written_.push_back({joint.index, l});
    for (const std::size_t child : children_[l]) spread(child, to);
    if (to.first != from.first || link.parent < 0) free_.push_back(to);
  }

  /// The motion of a link due to one disturbance, and the loop for it at lane 0.
  struct Transported {
    Vec6 A;
    Vec3 omega;
    ArrayStep step;
  };

  /// The row of the buffer for a freedom of the present link.
  std::size_t row(std::size_t f) const { return written_.size() + f; }

  /// Copies a row of the result to the buffer.
  void read_row(std::size_t l, std::size_t f, const Range& range, ArrayStep& step) const {
    for (const std::size_t order : {std::size_t{0}, std::size_t{1}}) {
      for (std::size_t lane = range.from + order; lane < range.to; lane += 2)
        step.before.push_back(
            {entry(links_.joints(l)[f].index, lanes_[lane]), {false, spread_buffer_.entry(row(f), lane)}});
    }
  }

  /// Copies the rows of the buffer to the result, column by column.
  void write_rows() {
    ArrayStep step;
    for (const std::size_t order : {std::size_t{0}, std::size_t{1}}) {
      for (std::size_t lane = order; lane < lanes_.size(); lane += 2) {
        for (std::size_t i = 0; i < written_.size(); ++i) {
          const auto [coordinate, l] = written_[i];
          if (tree_.links[l].parent >= 0 && (lane < first_[l] || lane >= end_[l]))
            step.after.push_back({{false, spread_buffer_.entry(i, lane)}, entry(coordinate, lanes_[lane])});
        }
      }
    }
    result_.steps.push_back(std::move(step));
    written_.clear();
  }

  /// Adds the loop for the lanes of `range`.
  void finish(bool passed, const Transported& motion, const LaneRows& to, const Range& range, ArrayStep step) {
    if (passed) {
      put(step, motion.A, to, 0);
      put(step, motion.omega, to, acceleration_rows);
    }
    for (std::vector<std::size_t>* entries : {&step.loop.inputs, &step.loop.outputs}) {
      for (std::size_t& entry : *entries) entry += range.from;
    }
    result_.steps.push_back(std::move(step));
  }

  /// The step of disturbances of links that are not beyond link l.
  Transported transport(std::size_t l, const LaneRows& from) {
    const BodyLink& link = tree_.links[l];
    const std::vector<JointResponse>& joints = links_.joints(l);
    Transported result{zero_vector6(dag_), symbolic::zero_vector(dag_), {}};
    if (link.parent < 0) return result;
    LoopSymbols symbols(dag_, result.step);
    result.A = acceleration_at(dag_, link, symbols.rows<Vec6>(from, 0));
    result.omega = link.rotation.to_own_axes(dag_, symbols.rows<Vec3>(from, acceleration_rows));
    for (std::size_t f = joints.size(); f-- > 0;) {
      const Ref u = dag_.neg(dot(dag_, joints[f].rotation, result.omega));
      result.step.loop.values.push_back(take_freedom(dag_, joints[f], u, result.A));
      result.step.loop.outputs.push_back(spread_buffer_.entry(row(f), 0));
    }
    return result;
  }

  /// The accelerations of link l due to disturbances beyond it, from those of its coordinates.
  Transported pass_inwards(std::size_t l, const LaneRows& from) {
    const BodyLink& link = tree_.links[l];
    const std::vector<JointResponse>& joints = links_.joints(l);
    Transported result{zero_vector6(dag_), symbolic::zero_vector(dag_), {}};
    LoopSymbols symbols(dag_, result.step);
    if (link.parent >= 0) result.A = acceleration_at(dag_, link, symbols.rows<Vec6>(from, 0));
    for (std::size_t f = 0; f < joints.size(); ++f)
      result.A = sum(dag_, result.A, scaled(dag_, symbols(spread_buffer_.entry(row(f), 0)), joints[f].s));
    return result;
  }

  /// Disturbances that start at link l.
  void store_own(std::size_t l, const LaneRows& to, bool passed) {
    ArrayStep step;
    for (std::size_t f = 0; f < tree_.links[l].freedoms.size(); ++f) {
      for (std::size_t order = 0; order < 2; ++order) {
        const SourceResponse& reaction = response(l, f, order);
        for (std::size_t k = 0; k < reaction.qddot.size(); ++k)
          step.stores.push_back({reaction.qddot[k], entry(links_.joints(l)[k].index, column(l, f, order))});
        if (!passed) continue;
        const std::size_t lane = first_[l] + 2 * f + order;
        store(step, reaction.A, to, 0, lane);
        store(step, responses_.at({l, f, order}).first.omega, to, acceleration_rows, lane);
      }
    }
    result_.steps.push_back(std::move(step));
  }

  Dag& dag_;
  const BodyTree& tree_;
  std::size_t n_;
  LinkCompliance links_;
  system::AccelerationSlopes result_;
  std::vector<std::vector<std::size_t>> children_;
  // Of one tree: lanes of the columns of a link and of those beyond it; the column of each lane.
  std::vector<std::size_t> first_, end_, lanes_;
  std::size_t most_freedoms_ = 0, reach_width_ = 0, column_width_ = 0, next_ = 0;
  std::vector<LaneRows> free_;
  LaneRows reach_buffer_, spread_buffer_;
  std::vector<std::pair<std::size_t, std::size_t>> written_;  // rows of spread_buffer_: coordinate, link
  std::map<std::array<std::size_t, 3>, std::pair<DisturbanceSource, SourceResponse>> responses_;
};

}  // namespace

system::AccelerationSlopes compliance_loops(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                            const std::vector<LinkDynamics>& dynamics) {
  return ComplianceLoops(dag, tree, motion, dynamics).run();
}

}  // namespace eomgen::derive
