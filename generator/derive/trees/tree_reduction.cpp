// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/tree_reduction.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace eomgen::derive {
namespace {

using symbolic::Op;

std::size_t place(int link) { return static_cast<std::size_t>(link); }

bool is_constant(const Dag& dag, const Vec3& v) {
  const std::vector<symbolic::Symbol> symbols = dag.symbols({v[0], v[1], v[2]});
  return std::all_of(symbols.begin(), symbols.end(),
                     [](const symbolic::Symbol& s) { return s.kind == symbolic::SymbolKind::parameter; });
}

Mat3 identity(const Dag& dag) {
  Mat3 result = zero_matrix(dag);
  for (std::size_t k = 0; k < 3; ++k) result[k][k] = dag.one();
  return result;
}

bool is_constant(const Dag& dag, const RotationStep& step) {
  return is_zero(dag, step.w) && is_zero(dag, step.w_bias) &&
         std::all_of(step.R.begin(), step.R.end(), [&](const Vec3& row) { return is_constant(dag, row); });
}

/// The axis of a link that one coordinate rotates about an axis of its own in the last step, after constant ones;
/// otherwise 3.
std::size_t pin_axis(const Dag& dag, const BodyLink& link) {
  const std::vector<RotationStep>& steps = link.rotation.steps;
  if (!link.is_carried_by_parent() || link.freedoms.size() != 1 || steps.empty()) return 3;
  const Freedom& freedom = link.freedoms[0];
  const std::size_t i = axis_of(dag, steps.back().R);
  if (i == 3 || !is_zero(dag, freedom.linear) || !is_zero(dag, steps.back().w_bias) || !is_constant(dag, link.offset))
    return 3;
  const bool along =
      dag.is_zero(freedom.angular[(i + 1) % 3]) && dag.is_zero(freedom.angular[(i + 2) % 3]) &&
      dag.is_zero(steps.back().w[(i + 1) % 3]) && dag.is_zero(steps.back().w[(i + 2) % 3]) &&
      std::all_of(steps.begin(), steps.end() - 1, [&](const RotationStep& s) { return is_constant(dag, s); });
  return along ? i : 3;
}

/// The constant rotation before the last step.
RotationSequence before_last(const RotationSequence& rotation) {
  RotationSequence result = rotation;
  result.steps.pop_back();
  return result;
}

bool is_fixed(const Dag& dag, const BodyLink& link) {
  const std::vector<RotationStep>& steps = link.rotation.steps;
  return link.parent >= 0 && link.is_carried_by_parent() && link.freedoms.empty() && is_constant(dag, link.offset) &&
         std::all_of(steps.begin(), steps.end(), [&](const RotationStep& s) { return is_constant(dag, s); });
}

/// The angle of a step about axis i; empty if its cosine and sine are not written as such.
std::optional<Ref> angle_of(Dag& dag, const Mat3& R, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  if (dag[R[j][j]].op != Op::cos) return std::nullopt;
  const Ref angle = dag[R[j][j]].args[0];
  const Ref sine = dag.call(Op::sin, angle);
  if (R[j][k] == sine) return angle;
  if (R[k][j] == sine) return dag.neg(angle);
  return std::nullopt;
}

Mat3 rotation_about(Dag& dag, std::size_t i, Ref angle) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  Mat3 R = zero_matrix(dag);
  R[i][i] = dag.one();
  R[j][j] = R[k][k] = dag.call(Op::cos, angle);
  R[j][k] = dag.call(Op::sin, angle);
  R[k][j] = dag.neg(R[j][k]);
  return R;
}

/// The coordinates along E1, E2, E3 of a link that they shift and that only carries one other; otherwise empty.
std::optional<std::array<std::size_t, 3>> cartesian_coordinates(const Dag& dag, const BodyTree& tree, std::size_t l) {
  const BodyLink& link = tree.links[l];
  const auto children = std::count_if(tree.links.begin(), tree.links.end(),
                                      [&](const BodyLink& other) { return other.parent == static_cast<int>(l); });
  const bool plain = link.parent < 0 && link.frame == 0 && link.rotation.steps.empty() && is_zero(dag, link.moment);
  if (!plain || children != 1 || link.freedoms.size() != 3 || !is_zero(dag, link.offset_bias)) return std::nullopt;
  std::array<std::size_t, 3> result{};
  std::array<bool, 3> found{};
  for (const Freedom& f : link.freedoms) {
    if (!is_zero(dag, f.angular) || !dag.is_zero(tree.armature[f.index])) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!dag.is_one(f.linear[k]) || !dag.is_zero(f.linear[(k + 1) % 3]) || !dag.is_zero(f.linear[(k + 2) % 3]))
        continue;
      result[k] = f.index;
      found[k] = true;
    }
  }
  if (!found[0] || !found[1] || !found[2]) return std::nullopt;
  return result;
}

/// m (d.d 1 - d d^T) + 2 d.h 1 - d h^T - h d^T: the inertia at a distance d of a mass with first moment h.
Mat3 moved_inertia(Dag& dag, Ref mass, const Vec3& h, const Vec3& d) {
  const Vec3 md = symbolic::scale(dag, mass, d);
  const Ref trace = dag.add(dot(dag, md, d), dag.mul(dag.integer(2), dot(dag, d, h)));
  Mat3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Ref outer = dag.add(dag.mul(md[i], d[k]), dag.add(dag.mul(d[i], h[k]), dag.mul(h[i], d[k])));
      result[i][k] = i == k ? dag.sub(trace, outer) : dag.neg(outer);
    }
  }
  return result;
}

/// Which links get the axes of their parents: those whose children all do, about the same axis.
class AxesOfParents {
 public:
  AxesOfParents(Dag& dag, BodyTree& tree) : dag_(dag), tree_(tree), axis_(tree.links.size(), 3) { choose(); }

  bool is_empty() const { return shared_.empty(); }

  /// With `tips`, also the links at the ends.
  void operator()(bool tips) {
    std::vector<bool> at_end(tree_.links.size(), true);
    for (const BodyLink& link : tree_.links)
      if (link.parent >= 0) at_end[place(link.parent)] = false;
    for (const std::size_t l : shared_) share(l, tips || !at_end[l]);
  }

 private:
  void choose() {
    std::vector<bool> fits(tree_.links.size(), true);
    for (std::size_t l = tree_.links.size(); l-- > 0;) {
      const BodyLink& link = tree_.links[l];
      const std::size_t axis = pin_axis(dag_, link);
      if (fits[l] && axis < 3 && (axis_[l] == 3 || axis_[l] == axis) &&
          angle_of(dag_, link.rotation.steps.back().R, axis)) {
        axis_[l] = axis;
        shared_.insert(shared_.begin(), l);
      } else {
        axis_[l] = 3;
      }
      if (link.parent < 0) continue;
      const std::size_t parent = place(link.parent);
      const bool follows =
          axis_[l] < 3 && link.rotation.steps.size() == 1 && (axis_[parent] == 3 || axis_[parent] == axis_[l]);
      fits[parent] = fits[parent] && follows;
      if (follows) axis_[parent] = axis_[l];
    }
  }

  void share(std::size_t l, bool constants) {
    BodyLink& link = tree_.links[l];
    RotationStep& step = link.rotation.steps.back();
    Ref angle = *angle_of(dag_, step.R, axis_[l]);
    if (link.parent >= 0 && turned_.contains(place(link.parent))) {
      const Mat3& outer = turned_.at(place(link.parent));
      angle = dag_.add(*angle_of(dag_, outer, axis_[l]), angle);
      link.offset = times(dag_, transposed(outer), link.offset);
    }
    step.R = rotation_about(dag_, axis_[l], angle);
    if (!constants) return;
    turned_.emplace(l, step.R);
    const RotationSequence last{{step}};
    link.moment = last.to_parent(dag_, link.moment);
    link.inertia = last.to_parent(dag_, link.inertia, true);
    step.R = identity(dag_);
  }

  Dag& dag_;
  BodyTree& tree_;
  std::vector<std::size_t> axis_;    // of a link with the axes of its parent, or of its children with its axes; or 3
  std::vector<std::size_t> shared_;  // links, parents first
  std::map<std::size_t, Mat3> turned_;
};

/// Adds a mass, its moments about the origin of a link and its inertia, along the axes of the link's parent, to the
/// parent.
void add_to_parent(Dag& dag, BodyTree& tree, const BodyLink& link, Ref mass, const Vec3& moment, const Mat3& inertia) {
  BodyLink& to = tree.links[place(link.parent)];
  to.mass = dag.add(to.mass, mass);
  to.moment = symbolic::add(dag, to.moment, symbolic::add(dag, symbolic::scale(dag, mass, link.offset), moment));
  to.inertia = add(dag, to.inertia, add(dag, inertia, moved_inertia(dag, mass, moment, link.offset)));
}

/// Joins links that do not move relative to their parents with these.
void join_fixed_links(Dag& dag, BodyTree& tree) {
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    BodyLink& link = tree.links[l];
    if (!is_fixed(dag, link)) continue;
    for (BodyLink& child : tree.links) {
      if (child.parent != static_cast<int>(l) || !child.relative) continue;
      child.parent = link.parent;
      const RotationSequence& own = child.rotation;
      child.offset = symbolic::add(dag, link.offset, link.rotation.to_parent(dag, child.offset));
      child.offset_rate = link.rotation.to_parent(dag, child.offset_rate);
      child.offset_bias = link.rotation.to_parent(dag, child.offset_bias);
      RotationSequence both = link.rotation;
      both.steps.insert(both.steps.end(), own.steps.begin(), own.steps.end());
      child.rotation = both;
    }
    add_to_parent(dag, tree, link, link.mass, link.rotation.to_parent(dag, link.moment),
                  link.rotation.to_parent(dag, link.inertia, true));
    link.mass = dag.zero();
    link.moment = symbolic::zero_vector(dag);
    link.inertia = zero_matrix(dag);
  }
}

void regroup_inertias(Dag& dag, BodyTree& tree) {
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    BodyLink& link = tree.links[l];
    const std::size_t i = pin_axis(dag, link), j = (i + 1) % 3, k = (i + 2) % 3;
    if (i == 3) continue;
    Vec3 along = symbolic::zero_vector(dag);
    along[i] = link.moment[i];
    // The second moment along the axis, sum m r_i^2.
    const Ref second =
        dag.div(dag.sub(dag.add(link.inertia[j][j], link.inertia[k][k]), link.inertia[i][i]), dag.integer(2));
    if (link.parent >= 0) {
      Mat3 across = zero_matrix(dag);
      across[j][j] = across[k][k] = second;
      const RotationSequence constant = before_last(link.rotation);
      add_to_parent(dag, tree, link, link.mass, constant.to_parent(dag, along), constant.to_parent(dag, across, true));
    }
    link.mass = link.moment[i] = dag.zero();
    link.inertia[k][k] = dag.sub(link.inertia[k][k], second);
    link.inertia[j][j] = dag.sub(link.inertia[j][j], second);
  }
}

void move_origins_along_axes(Dag& dag, BodyTree& tree) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    BodyLink& link = tree.links[l];
    const std::size_t i = pin_axis(dag, link);
    if (i == 3) continue;
    const RotationSequence constant = before_last(link.rotation);
    Vec3 axis = symbolic::zero_vector(dag), d = axis;
    axis[i] = dag.one();
    axis = constant.to_parent(dag, axis);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_axis = dag.is_zero(axis[(k + 1) % 3]) && dag.is_zero(axis[(k + 2) % 3]);
      if (!is_axis || dag.is_zero(link.offset[k])) continue;
      d[i] = dag.mul(axis[k], link.offset[k]);
      link.offset[k] = dag.zero();
    }
    if (dag.is_zero(d[i])) continue;
    link.inertia = add(dag, link.inertia, moved_inertia(dag, link.mass, link.moment, d));
    link.moment = symbolic::add(dag, link.moment, symbolic::scale(dag, link.mass, d));
    for (BodyLink& child : tree.links)
      if (child.parent == static_cast<int>(l)) child.offset = symbolic::add(dag, child.offset, d);
  }
}

}  // namespace

BodyTree with_regrouped_inertias(Dag& dag, BodyTree tree) {
  join_fixed_links(dag, tree);
  regroup_inertias(dag, tree);
  move_origins_along_axes(dag, tree);
  return tree;
}

std::vector<BodyTree> equivalent_trees(Dag& dag, const BodyTree& tree) {
  std::vector<BodyTree> result{tree, with_regrouped_inertias(dag, tree)};
  for (const bool tips : {false, true}) {
    BodyTree shared = result[1];
    AxesOfParents axes(dag, shared);
    if (axes.is_empty()) break;
    axes(tips);
    result.push_back(std::move(shared));
  }
  return result;
}

std::optional<BodyTree> along_own_axes_of_free_bodies(Dag& dag, BodyTree tree) {
  bool any = false;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    BodyLink& link = tree.links[l];
    if (!link.absolute || !link.relative || link.parent < 0 || !is_zero(dag, link.offset)) continue;
    BodyLink& origin = tree.links[place(link.parent)];
    const std::optional<std::array<std::size_t, 3>> indices = cartesian_coordinates(dag, tree, place(link.parent));
    if (!indices) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      Freedom freedom{(*indices)[k], symbolic::zero_vector(dag), symbolic::zero_vector(dag)};
      freedom.linear[k] = dag.one();
      link.freedoms.push_back(freedom);
    }
    link.mass = dag.add(link.mass, origin.mass);
    origin.mass = dag.zero();
    origin.freedoms.clear();
    link.parent = -1;
    link.free = any = true;
  }
  if (!any) return std::nullopt;
  return tree;
}

std::size_t count_operations(const Dag& dag, const std::vector<Ref>& roots) {
  const std::vector<Ref> nodes = dag.reachable(roots);
  return static_cast<std::size_t>(std::count_if(nodes.begin(), nodes.end(), [&](Ref r) {
    const Op op = dag[r].op;
    return op == Op::add || op == Op::sub || op == Op::mul || op == Op::div;
  }));
}

}  // namespace eomgen::derive
