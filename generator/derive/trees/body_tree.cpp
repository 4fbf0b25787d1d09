// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_tree.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "derive/trees/tree_forces.hpp"
#include "mechanics/place_decomposition.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::derive {

Mat3 zero_matrix(const Dag& dag) {
  const Vec3 none = symbolic::zero_vector(dag);
  return {none, none, none};
}

Mat3 transposed(const Mat3& a) {
  Mat3 result = a;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = a[k][i];
  }
  return result;
}

Vec3 times(Dag& dag, const Mat3& a, const Vec3& v) { return {dot(dag, a[0], v), dot(dag, a[1], v), dot(dag, a[2], v)}; }

Mat3 product(Dag& dag, const Mat3& a, const Mat3& b) {
  const Mat3 columns = transposed(b);
  Mat3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = dot(dag, a[i], columns[k]);
  }
  return result;
}

Mat3 add(Dag& dag, const Mat3& a, const Mat3& b) {
  return {symbolic::add(dag, a[0], b[0]), symbolic::add(dag, a[1], b[1]), symbolic::add(dag, a[2], b[2])};
}

Mat3 cross_matrix(Dag& dag, const Vec3& d) {
  const Ref o = dag.zero();
  return {Vec3{o, dag.neg(d[2]), d[1]}, Vec3{d[2], o, dag.neg(d[0])}, Vec3{dag.neg(d[1]), d[0], o}};
}

std::size_t axis_of(const Dag& dag, const Mat3& R) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const bool about = dag.is_one(R[i][i]) && dag.is_zero(R[i][j]) && dag.is_zero(R[i][k]) && dag.is_zero(R[j][i]) &&
                       dag.is_zero(R[k][i]);
    if (about) return i;
  }
  return 3;
}

namespace {

using mechanics::decompose_place;
using mechanics::PlaceDecomposition;

/// R^T A R with A symmetric and R about axis i; the double angle gives one auxiliary quantity in place of four products
/// each.
Mat3 about_axis_to_parent(Dag& dag, const Mat3& R, const Mat3& a, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const Ref c = R[j][j], s = R[j][k];
  const Ref h = a[j][k];
  const Ref w = dag.add(dag.mul(s, dag.sub(a[k][k], a[j][j])), dag.mul(dag.neg(c), dag.add(h, h)));
  Mat3 result = a;
  result[j][j] = dag.add(a[j][j], dag.mul(s, w));
  result[k][k] = dag.sub(a[k][k], dag.mul(s, w));
  result[j][k] = result[k][j] = dag.neg(dag.add(dag.mul(c, w), h));
  const Ref x = a[i][j], y = a[i][k];
  result[i][j] = result[j][i] = dag.sub(dag.mul(c, x), dag.mul(s, y));
  result[i][k] = result[k][i] = dag.add(dag.mul(s, x), dag.mul(c, y));
  return result;
}

/// R^T A R of any matrix, with the double angle likewise.
Mat3 any_about_axis_to_parent(Dag& dag, const Mat3& R, const Mat3& a, std::size_t i) {
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const Ref c = R[j][j], s = R[j][k];
  const Ref sum = dag.add(a[j][k], a[k][j]);
  const Ref w = dag.sub(dag.mul(s, dag.sub(a[k][k], a[j][j])), dag.mul(c, sum));
  Mat3 result = a;
  result[j][j] = dag.add(a[j][j], dag.mul(s, w));
  result[k][k] = dag.sub(a[k][k], dag.mul(s, w));
  result[j][k] = dag.neg(dag.add(dag.mul(c, w), a[k][j]));
  result[k][j] = dag.neg(dag.add(dag.mul(c, w), a[j][k]));
  result[i][j] = dag.sub(dag.mul(c, a[i][j]), dag.mul(s, a[i][k]));
  result[i][k] = dag.add(dag.mul(s, a[i][j]), dag.mul(c, a[i][k]));
  result[j][i] = dag.sub(dag.mul(c, a[j][i]), dag.mul(s, a[k][i]));
  result[k][i] = dag.add(dag.mul(s, a[j][i]), dag.mul(c, a[k][i]));
  return result;
}

}  // namespace

Vec3 RotationSequence::to_own_axes(Dag& dag, Vec3 v) const {
  for (const RotationStep& step : steps) v = times(dag, step.R, v);
  return v;
}

Vec3 RotationSequence::to_parent(Dag& dag, Vec3 v) const {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) v = times(dag, transposed(step->R), v);
  return v;
}

Mat3 RotationSequence::to_parent(Dag& dag, Mat3 a, bool symmetric) const {
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    const std::size_t axis = axis_of(dag, step->R);
    if (axis < 3 && dag.is_one(step->R[(axis + 1) % 3][(axis + 1) % 3])) continue;  // the same axes
    if (axis < 3 && !dag.is_constant(step->R[(axis + 1) % 3][(axis + 1) % 3])) {
      a = symmetric ? about_axis_to_parent(dag, step->R, a, axis) : any_about_axis_to_parent(dag, step->R, a, axis);
      continue;
    }
    a = product(dag, product(dag, transposed(step->R), a), step->R);
    if (!symmetric) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < i; ++k) a[i][k] = a[k][i];
    }
  }
  return a;
}

RotationSequence RotationSequence::reversed() const {
  RotationSequence result;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) result.steps.push_back({transposed(step->R), {}, {}});
  return result;
}

namespace {

/// A point that is fixed in a link; link -1: the ground.
struct Anchor {
  int link = -1;
  Vec3 offset;  // from the link's origin, along its axes
};

class Builder {
 public:
  Builder(Mechanics& m, const std::vector<std::uint32_t>& of, bool imposed)
      : m_(m),
        dag_(*m.dag),
        of_(of),
        lower_(m),
        expanded_(m, imposed),
        bias_(symbolic::total_time_derivative(dag_, m.q.size(), 0, true)) {}

  std::optional<BodyTree> build() {
    for (const mechanics::PointMass& mass : m_.masses) {
      if (!add_mass(mass)) return std::nullopt;
    }
    for (const Spinning& body : spinning_) {
      if (!add_spinning(body)) return std::nullopt;
    }
    if (!covers_coordinates() || !add_armatures()) return std::nullopt;
    Ref potential;
    tree_.gravity = extract_gravity(m_, expanded_, potential);
    tree_.Q = non_gravity_forces(m_, of_, expanded_, potential);
    return std::move(tree_);
  }

 private:
  /// A body that rotates about its centre of mass without effect on its position.
  struct Spinning {
    const model::Body* body;
    Anchor at;
  };

  bool add_mass(const mechanics::PointMass& mass) {
    const Ref m = expanded_(mass.mass);
    if (!is_constant(m)) return false;
    const model::Body* body = nullptr;
    for (const model::Body& b : m_.model->bodies) body = b.place == mass.place ? &b : body;
    const std::optional<Anchor> at = anchor(mass.place);
    if (!at) return false;
    const bool fixed = body != nullptr && frame_of(at->link) == body->frame;
    if (body != nullptr && !fixed) spinning_.push_back({body, *at});
    if (at->link < 0) return true;  // at rest
    BodyLink& link = tree_.links[place(at->link)];
    const Vec3 mr = symbolic::scale(dag_, m, at->offset);
    link.mass = dag_.add(link.mass, m);
    link.moment = symbolic::add(dag_, link.moment, mr);
    if (fixed) add_inertia(link, *body);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        link.inertia[i][k] = dag_.sub(link.inertia[i][k], dag_.mul(mr[i], at->offset[k]));
      link.inertia[i][i] = dag_.add(link.inertia[i][i], dot(dag_, mr, at->offset));
    }
    return true;
  }

  void add_inertia(BodyLink& link, const model::Body& body) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        link.inertia[i][k] = dag_.add(link.inertia[i][k], expanded_(lower_.scalar(body.inertia[i][k])));
    }
  }

  /// Its inertia belongs to the link with its axes, wherever that is.
  bool add_spinning(const Spinning& spinning) {
    Anchor from = spinning.at;
    for (std::uint32_t frame = spinning.body->frame; frame != 0; frame = m_.model->frames[frame].parent) {
      const auto link =
          std::find_if(tree_.links.begin(), tree_.links.end(), [&](const BodyLink& l) { return l.frame == frame; });
      if (link == tree_.links.end()) continue;
      from = {static_cast<int>(link - tree_.links.begin()), symbolic::zero_vector(dag_)};
      break;
    }
    const std::optional<Anchor> own = attached(from, spinning.body->frame);
    if (own) add_inertia(tree_.links[place(own->link)], *spinning.body);
    return own.has_value();
  }

  /// The place in the tree. Empty if its position does not have the form of a tree.
  std::optional<Anchor> anchor(std::uint32_t place) {
    if (const auto found = anchors_.find(place); found != anchors_.end()) return found->second;
    const std::optional<PlaceDecomposition> written = decompose_place(m_, lower_, place);
    std::optional<Anchor> at = Anchor{-1, symbolic::zero_vector(dag_)};
    if (!written) at.reset();
    if (at && written->from) at = anchor(*written->from);
    if (at) at = moved(*at, written->components);
    anchors_.emplace(place, at);
    return at;
  }

  /// Components along the axes in which the point is fixed first, then from the inner axes to the outer.
  std::optional<Anchor> moved(Anchor at, const std::map<std::uint32_t, Vec3>& components) {
    std::vector<std::uint32_t> frames;
    for (const auto& [frame, v] : components) frames.push_back(frame);
    const std::uint32_t here = frame_of(at.link);
    std::stable_sort(frames.begin(), frames.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::make_pair(a != here, depth(a)) < std::make_pair(b != here, depth(b));
    });
    for (const std::uint32_t frame : frames) {
      const Vec3 v = expanded_(components.at(frame));
      if (is_zero(dag_, v)) continue;
      const std::optional<Anchor> next = attached(at, frame);
      if (!next) return std::nullopt;
      at = *next;
      at.offset = symbolic::add(dag_, at.offset, v);
      if (!is_constant(v[0]) || !is_constant(v[1]) || !is_constant(v[2])) at = shifted(at);
    }
    return at;
  }

  /// The point as one that is fixed in the axes of `frame`; inserts links where it is not.
  std::optional<Anchor> attached(const Anchor& at, std::uint32_t frame) {
    if (frame_of(at.link) == frame) return at;
    if (frame == 0) return link_at(at, 0, false);
    const std::uint32_t parent = m_.model->frames[frame].parent;
    std::uint32_t inner = parent;
    while (inner != 0 && inner != frame_of(at.link)) inner = m_.model->frames[inner].parent;
    // Ground axes are inserted if the frame does not rotate relative to the axes of the point.
    const std::optional<Anchor> from =
        inner == frame_of(at.link) ? attached(at, parent) : attached(*attached(at, 0), parent);
    return from ? link_at(*from, frame, true) : from;
  }

  Anchor link_at(const Anchor& at, std::uint32_t frame, bool relative) {
    const auto key = std::make_tuple(at.link, at.offset, frame);
    const auto found = known_.find(key);
    if (found != known_.end()) return {found->second, symbolic::zero_vector(dag_)};
    BodyLink link = massless(at.link, frame);
    link.offset = at.offset;
    link.relative = relative;
    link.rotation = relative ? rotation_of(frame) : RotationSequence{};
    for (std::uint32_t f = frame_of(at.link); !relative && f != 0; f = m_.model->frames[f].parent) {
      const RotationSequence back = rotation_of(f).reversed();
      link.rotation.steps.insert(link.rotation.steps.end(), back.steps.begin(), back.steps.end());
    }
    if (relative) add_turning(link);
    const int index = append(std::move(link));
    known_.emplace(key, index);
    return {index, symbolic::zero_vector(dag_)};
  }

  /// A link with the same axes whose origin is the moving point.
  Anchor shifted(const Anchor& at) {
    BodyLink link = massless(at.link, frame_of(at.link));
    link.offset = at.offset;
    for (std::size_t k = 0; k < 3; ++k) link.offset_rate[k] = bias_(at.offset[k]);
    for (std::size_t k = 0; k < 3; ++k) link.offset_bias[k] = bias_(link.offset_rate[k]);
    for (std::size_t i = 0; i < of_.size(); ++i) {
      symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, of_[i], 0});
      const Vec3 J{by(at.offset[0]), by(at.offset[1]), by(at.offset[2])};
      if (!is_zero(dag_, J)) link.freedoms.push_back({i, symbolic::zero_vector(dag_), J});
    }
    return {append(std::move(link)), symbolic::zero_vector(dag_)};
  }

  BodyLink massless(int parent, std::uint32_t frame) const {
    const Vec3 none = symbolic::zero_vector(dag_);
    BodyLink link;
    link.parent = parent;
    link.frame = frame;
    link.offset = link.offset_rate = link.offset_bias = link.moment = none;
    link.inertia = zero_matrix(dag_);
    link.mass = dag_.zero();
    return link;
  }

  int append(BodyLink link) {
    tree_.links.push_back(std::move(link));
    return static_cast<int>(tree_.links.size()) - 1;
  }

  RotationSequence rotation_of(std::uint32_t frame) {
    RotationSequence rotation;
    for (const model::RotationStage& stage : m_.model->frames[frame].stages) {
      RotationStep step;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) step.R[k][j] = expanded_(lower_.scalar(stage.R[k][j]));
        step.w[k] = expanded_(lower_.scalar(stage.w[k]));
        step.w_bias[k] = bias_(step.w[k]);
      }
      rotation.steps.push_back(step);
    }
    return rotation;
  }

  void add_turning(BodyLink& link) {
    for (std::size_t i = 0; i < of_.size(); ++i) {
      symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, of_[i], 1});
      Vec3 s = symbolic::zero_vector(dag_);
      for (const RotationStep& step : link.rotation.steps) {
        s = symbolic::add(dag_, times(dag_, step.R, s), {by(step.w[0]), by(step.w[1]), by(step.w[2])});
      }
      if (!is_zero(dag_, s)) link.freedoms.push_back({i, s, symbolic::zero_vector(dag_)});
    }
    if (m_.model->frames[link.frame].rotation == "euler_parameters") add_parameters(link);
  }

  /// The freedoms in the order of the four parameters, if all of them are free.
  void add_parameters(BodyLink& link) {
    std::vector<Freedom> sorted;
    std::vector<Ref> rates;
    for (const model::NodeId entry : m_.model->frames[link.frame].entries) {
      const std::uint32_t i = m_.model->arena[entry].index;
      for (const Freedom& f : link.freedoms) {
        if (of_[f.index] == i) sorted.push_back(f);
      }
      link.parameters.push_back(m_.q[i]);
      rates.push_back(m_.qdot[i]);
    }
    link.parameters.insert(link.parameters.end(), rates.begin(), rates.end());
    if (sorted.size() == 4)
      link.freedoms = sorted;
    else
      link.parameters.clear();
  }

  bool covers_coordinates() const {
    std::vector<int> joints(of_.size(), 0);
    for (const BodyLink& link : tree_.links) {
      for (const Freedom& freedom : link.freedoms) ++joints[freedom.index];
    }
    return std::all_of(joints.begin(), joints.end(), [](int count) { return count == 1; });
  }

  /// Whether the given kinetic energy is a sum of a qdot^2/2 with constants a.
  bool add_armatures() {
    tree_.armature.assign(of_.size(), dag_.zero());
    Ref rest = m_.kinetic_given;
    for (std::uint32_t i = 0; i < m_.q.size() && !dag_.is_zero(rest); ++i) {
      symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1});
      const Ref a = by(by(m_.kinetic_given));
      if (dag_.is_zero(a)) continue;
      if (!is_constant(a)) return false;
      const Ref twice = dag_.mul(a, dag_.mul(m_.qdot[i], m_.qdot[i]));
      rest = dag_.sub(rest, dag_.div(twice, dag_.integer(2)));
      const auto free = std::find(of_.begin(), of_.end(), i);
      if (free != of_.end()) tree_.armature[static_cast<std::size_t>(free - of_.begin())] = a;
    }
    return !mechanics::is_somewhere_nonzero(dag_, rest);
  }

  bool is_constant(Ref r) const {
    const std::vector<Symbol> symbols = dag_.symbols({r});
    return std::all_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind == SymbolKind::parameter; });
  }
  static std::size_t place(int link) { return static_cast<std::size_t>(link); }
  std::uint32_t frame_of(int link) const { return link < 0 ? 0 : tree_.links[place(link)].frame; }
  int depth(std::uint32_t frame) const {
    int count = 0;
    for (std::uint32_t f = frame; f != 0; f = m_.model->frames[f].parent) ++count;
    return count;
  }

  Mechanics& m_;
  Dag& dag_;
  const std::vector<std::uint32_t>& of_;
  mechanics::Lowering lower_;
  ImposedExpansion expanded_;
  symbolic::Derivation bias_;
  BodyTree tree_;
  std::vector<Spinning> spinning_;
  std::map<std::uint32_t, std::optional<Anchor>> anchors_;
  std::map<std::tuple<int, Vec3, std::uint32_t>, int> known_;
};

}  // namespace

std::optional<BodyTree> body_tree(Mechanics& m, const std::vector<std::uint32_t>& of, bool imposed) {
  if (m.body_rotations.empty() || of.empty()) return std::nullopt;
  return Builder(m, of, imposed).build();
}

void use_angular_velocities(Dag& dag, BodyTree& tree) {
  for (BodyLink& link : tree.links) {
    const bool turns = std::all_of(link.freedoms.begin(), link.freedoms.end(), [&](const Freedom& f) {
      return is_zero(dag, f.linear) && dag.is_zero(tree.armature[f.index]);  // an armature belongs to its own rate
    });
    link.absolute = turns && (link.freedoms.size() == 3 || (link.freedoms.size() == 4 && !link.parameters.empty()));
    if (!link.absolute) continue;
    link.angles = link.freedoms;
    link.freedoms.resize(3);
    for (RotationStep& step : link.rotation.steps) {  // w of unit parameters is constant at e_ddot = 0
      if (!link.parameters.empty()) step.w_bias = symbolic::zero_vector(dag);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      link.freedoms[k].angular = symbolic::zero_vector(dag);
      link.freedoms[k].angular[k] = dag.one();
    }
  }
}

}  // namespace eomgen::derive
