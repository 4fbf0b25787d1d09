// SPDX-License-Identifier: GPL-3.0-or-later
// Directions of slip that constraints block: always, as a rail on a rough floor does, or while a contact is closed, as
// a stop at the end of a rough guide does. The motion does not determine the friction along them. If no other direction
// is left, the constraints prescribe the slip. A prescribed slip that vanishes identically leaves friction without a
// meaning, which is rejected. Otherwise friction acts against the slip and the contact never sticks: it gets the law of
// a contact with a width, whose width is 0.
#include <algorithm>
#include <map>
#include <optional>

#include "mechanics/pfaffian.hpp"
#include "mechanics/stages.hpp"
#include "numeric/elimination.hpp"
#include "symbolic/arithmetic.hpp"

namespace eomgen::mechanics {
namespace {

using DirectionRow = std::vector<Ref>;  // by the free coordinates
using Real = cln::cl_R;

bool has_friction(const Contact& contact) { return contact.dimensions() > 0; }
bool sticks(const Contact& contact) { return has_friction(contact) && !contact.width; }

/// A subset of the unilateral contacts that are closed.
using ClosedContacts = std::vector<bool>;

std::size_t sticking_directions(const Contact& contact, std::size_t index, const ClosedContacts& closed) {
  if (!sticks(contact) || (contact.unilateral && !closed[index])) return 0;
  const auto held =
      std::count_if(contact.blocked.begin(), contact.blocked.end(),
                    [&](const BlockedDirection& direction) { return direction.by == index || closed[direction.by]; });
  return contact.dimensions() - std::min(contact.dimensions(), static_cast<std::size_t>(held));
}

class Search {
 public:
  explicit Search(Mechanics& m, OneFormSpace::SampleSet where) : m_(m), space_(m, where) {
    for (const std::uint32_t k : m.active) {
      const auto leavable = std::find_if(m.contacts.begin(), m.contacts.end(), [k](const Contact& contact) {
        return contact.unilateral && contact.constraints[0] == k;
      });
      if (leavable == m.contacts.end()) always_.push_back(row(m.constraints[k].gradient));
    }
    for (const Contact& contact : m.contacts) {
      if (has_friction(contact)) require_directions(contact);
    }
  }

  bool has_sample_points() const { return space_.points() > 0; }

  /// If more directions can stick than there are degrees of freedom, the motion does not determine the static friction.
  /// False if contacts with one that can open could hold more directions than are free.
  bool is_determinate(const ClosedContacts& closed) {
    std::size_t freedom = m_.free.size() - m_.active.size(), directions = 0, open_contacts = 0;
    bool any_touches = false;
    base_ = always_;
    for (std::size_t j = 0; j < m_.contacts.size(); ++j) {
      if (!m_.contacts[j].unilateral) continue;
      open_contacts += closed[j] ? 0 : 1;
      any_touches = any_touches || closed[j];
      if (closed[j]) base_.push_back(row(m_.constraints[m_.contacts[j].constraints[0]].gradient));
    }
    freedom += open_contacts;
    tangents_.clear();
    for (std::size_t j = 0; j < m_.contacts.size(); ++j) {
      const Contact& contact = m_.contacts[j];
      const std::size_t own = sticking_directions(contact, j, closed);
      if (own == 0) continue;
      directions += own;
      for (const std::vector<Ref>& tangent : contact.tangents) tangents_.push_back(row(tangent));
      const std::size_t free = has_sample_points() ? free_directions(base_) : directions;
      if (directions <= freedom && directions <= free) continue;
      if (can_any_open()) return false;
      const std::string where = !any_touches         ? ""
                                : open_contacts == 0 ? " while all contacts are closed"
                                                     : " while some contacts touch";
      const std::string left =
          directions > freedom ? " directions, and the system has " + std::to_string(freedom) +
                                     (freedom == 1 ? " degree" : " degrees") + " of freedom"
                               : " directions, of which the constraints leave " + std::to_string(free) + " to move in";
      throw Error(
          "mechanics", m_.model->where(friction_law_of(m_, contact).span),
          "with '" + contact.name + "' friction can hold " + std::to_string(directions) + left + where +
              ": where all stick, the forces are not determined",
          "give fewer contacts friction, or this one the smooth law (law = \"smooth\"), under which nothing sticks");
    }
    return true;
  }

  void examine_contact(std::uint32_t index) {
    Contact& contact = m_.contacts[index];
    tangents_.clear();
    for (const std::vector<Ref>& tangent : contact.tangents) tangents_.push_back(row(tangent));
    base_ = always_;
    if (contact.unilateral) base_.push_back(row(m_.constraints[contact.constraints[0]].gradient));
    const std::size_t free = free_directions(base_);
    if (free == 0) {
      if (is_at_rest(contact)) refuse(contact);
      contact.width = m_.dag->zero();
      return;
    }
    if (free < tangents_.size()) {
      std::optional<std::vector<Ref>> along = always_held(contact);
      if (!along) return;  // too many directions; is_determinate finds it
      contact.blocked.push_back({index, std::move(*along)});
    }
    for (std::uint32_t c = 0; c < m_.contacts.size(); ++c) {
      if (c == index || !m_.contacts[c].unilateral) continue;
      const DirectionRow g = row(m_.constraints[m_.contacts[c].constraints[0]].gradient);
      std::vector<DirectionRow> rows = base_;
      rows.push_back(g);
      if (free_directions(rows) == free) continue;
      // One remaining direction may have any length.
      std::optional<std::vector<Ref>> along =
          free == 1 ? std::vector<Ref>(tangents_.size(), m_.dag->one()) : tangent_components(g, contact);
      if (along) contact.blocked.push_back({c, std::move(*along)});
    }
  }

 private:
  /// Keeps the sample points at which the directions of slip have values. Throws Error if they have none at any, as on
  /// the axis of polar coordinates, along which the gradient of a constraint on the angle has no length.
  void require_directions(const Contact& contact) {
    if (!has_sample_points()) return;
    std::vector<Ref> needed = contact.gram;
    for (const std::vector<Ref>& tangent : contact.tangents)
      needed.insert(needed.end(), tangent.begin(), tangent.end());
    needed.insert(needed.end(), contact.slip.begin(), contact.slip.end());
    for (Ref& r : needed) r = space_.impose_and_expand(r);
    const std::string reason = space_.keep_points_with_values(needed);
    if (has_sample_points() || reason != symbolic::division_by_zero) return;
    throw Error(
        "mechanics", m_.model->where(friction_law_of(m_, contact).span),
        "the friction of '" + contact.name +
            "' has no direction where the constraints hold: the coordinates of its particle are singular there",
        "describe the position by coordinates that are regular where the constraints hold, as x, y, z on an axis");
  }
  bool can_any_open() const {
    return std::any_of(m_.contacts.begin(), m_.contacts.end(),
                       [](const Contact& contact) { return contact.unilateral; });
  }
  DirectionRow row(const std::vector<Ref>& by_coordinate) {
    DirectionRow result;
    for (const std::uint32_t i : m_.free) result.push_back(space_.impose_and_expand(by_coordinate[i]));
    return result;
  }

  std::size_t rank(const std::vector<DirectionRow>& rows, std::size_t point) const {
    numeric::Matrix<Real> matrix(rows.size(), rows.empty() ? 0 : rows[0].size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::vector<Real> values = space_.values(rows[i], point);
      for (std::size_t j = 0; j < values.size(); ++j) matrix(i, j) = values[j];
    }
    const Real small = cln::expt(symbolic::Rational(1) / 10, 30);
    return numeric::Elimination<Real>(std::move(matrix), small, numeric::Pivoting::complete).rank();
  }

  /// The number of directions of slip left under these rows: the maximum over the sample points.
  std::size_t free_directions(const std::vector<DirectionRow>& rows) const {
    std::vector<DirectionRow> all = rows;
    all.insert(all.end(), tangents_.begin(), tangents_.end());
    std::size_t most = 0;
    for (std::size_t point = 0; point < space_.points(); ++point)
      most = std::max(most, rank(all, point) - rank(rows, point));
    return most;
  }

  /// Whether the slip that the constraints prescribe vanishes: then its equations, with the parts that do not depend on
  /// the free rates, follow from those of the constraints.
  bool is_at_rest(const Contact& contact) {
    Dag& dag = *m_.dag;
    std::vector<DirectionRow> rows;
    for (const std::uint32_t k : m_.active) {
      const bool can_open = std::any_of(m_.contacts.begin(), m_.contacts.end(), [&](const Contact& other) {
        return other.unilateral && other.constraints[0] == k && &other != &contact;
      });
      if (!can_open) rows.push_back(space_.one_form(m_.constraints[k]));
    }
    std::map<symbolic::Symbol, Ref> no_rates;
    for (const std::uint32_t i : m_.free) no_rates[{symbolic::SymbolKind::coordinate, i, 1}] = dag.zero();
    symbolic::Substitution at_no_rates(dag, std::move(no_rates));
    std::vector<DirectionRow> with_slip = rows;
    for (std::size_t a = 0; a < contact.dimensions(); ++a) {
      with_slip.push_back(row(contact.tangents[a]));
      with_slip.back().push_back(space_.impose_and_expand(at_no_rates(contact.slip[a])));
    }
    for (std::size_t point = 0; point < space_.points(); ++point)
      if (rank(with_slip, point) > rank(rows, point)) return false;
    return true;
  }

  /// The direction, of two, that one permanent constraint blocks; empty if it takes several constraints.
  std::optional<std::vector<Ref>> always_held(const Contact& contact) {
    std::vector<DirectionRow> rows;
    if (contact.constraints.size() == 1) rows.push_back(row(m_.constraints[contact.constraints[0]].gradient));
    for (const DirectionRow& g : always_) {
      rows.push_back(g);
      const bool holds = free_directions(rows) < tangents_.size();
      rows.pop_back();
      std::optional<std::vector<Ref>> along = holds ? tangent_components(g, contact) : std::nullopt;
      if (along) return along;
    }
    return std::nullopt;
  }

  /// h with g = h_1 t_1 + h_2 t_2, up to a factor and the contact's own normal: minors of these rows. Empty if other
  /// constraints are involved.
  std::optional<std::vector<Ref>> tangent_components(const DirectionRow& g, const Contact& contact) {
    std::vector<DirectionRow> rows = tangents_;
    if (contact.constraints.size() == 1) {
      const DirectionRow normal = row(m_.constraints[contact.constraints[0]].gradient);
      if (rank({normal}, 0) > 0) rows.push_back(normal);  // otherwise it fixes a coordinate
    }
    const std::size_t n = rows.size();
    if (n > m_.free.size()) return std::nullopt;
    // The first columns in which the rows are independent.
    std::vector<std::size_t> columns;
    for (std::size_t j = 0; j < m_.free.size() && columns.size() < n; ++j) {
      columns.push_back(j);
      if (rank(of(rows, columns), 0) < columns.size()) columns.pop_back();
    }
    if (columns.size() < n) return std::nullopt;
    std::vector<Ref> share;
    for (std::size_t a = 0; a < 2; ++a) {
      std::vector<DirectionRow> replaced = rows;
      replaced[a] = g;
      share.push_back(symbolic::expand_if_shorter(*m_.dag, determinant(of(replaced, columns)), 60));
    }
    // The rest of g is a part of the normal.
    const Ref whole = determinant(of(rows, columns));
    DirectionRow rest;
    for (std::size_t j = 0; j < g.size(); ++j) {
      Ref sum = m_.dag->mul(whole, g[j]);
      for (std::size_t a = 0; a < 2; ++a) sum = m_.dag->sub(sum, m_.dag->mul(share[a], rows[a][j]));
      rest.push_back(sum);
    }
    std::vector<DirectionRow> normal(rows.begin() + 2, rows.end());
    const std::size_t before = normal.empty() ? 0 : 1;
    normal.push_back(rest);
    for (std::size_t point = 0; point < space_.points(); ++point)
      if (rank(normal, point) > before) return std::nullopt;
    return share;
  }
  static std::vector<DirectionRow> of(const std::vector<DirectionRow>& rows, const std::vector<std::size_t>& columns) {
    std::vector<DirectionRow> result;
    for (const DirectionRow& r : rows) {
      result.emplace_back();
      for (const std::size_t j : columns) result.back().push_back(r[j]);
    }
    return result;
  }
  Ref determinant(const std::vector<DirectionRow>& a) const {
    Dag& dag = *m_.dag;
    const auto minor = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
      return dag.sub(dag.mul(a[i][k], a[j][l]), dag.mul(a[i][l], a[j][k]));
    };
    if (a.size() == 2) return minor(0, 1, 0, 1);
    return dag.add(dag.sub(dag.mul(a[0][0], minor(1, 2, 1, 2)), dag.mul(a[0][1], minor(1, 2, 0, 2))),
                   dag.mul(a[0][2], minor(1, 2, 0, 1)));
  }

  [[noreturn]] void refuse(const Contact& contact) const {
    throw Error("mechanics", m_.model->where(friction_law_of(m_, contact).span),
                "the friction of '" + contact.name +
                    "' acts along directions that constraints block: it changes no equation of motion",
                "remove the friction, or free the direction along which it is to act");
  }

  Mechanics& m_;
  OneFormSpace space_;
  std::vector<DirectionRow> always_, base_, tangents_;
};

}  // namespace

bool find_blocked_directions(Mechanics& m) {
  if (std::none_of(m.contacts.begin(), m.contacts.end(), has_friction)) return true;
  if (m.free.empty()) return true;  // the motion is prescribed, and friction acts against it
  const auto unilateral = static_cast<std::size_t>(
      std::count_if(m.contacts.begin(), m.contacts.end(), [](const Contact& contact) { return contact.unilateral; }));
  if (m.free.size() + unilateral < m.active.size()) return true;  // reported elsewhere
  if (m.free.size() < m.active.size()) return false;              // not all contacts can be closed, as two stops
  // Sample points on the constraints, if any are found: some directions are blocked only there.
  std::optional<Search> search;
  search.emplace(m, OneFormSpace::SampleSet::on_constraints);
  if (!search->has_sample_points()) search.emplace(m, OneFormSpace::SampleSet::unrestricted);
  if (std::none_of(m.contacts.begin(), m.contacts.end(), sticks)) return true;
  if (search->has_sample_points()) {
    for (std::uint32_t j = 0; j < m.contacts.size(); ++j)
      if (sticks(m.contacts[j])) search->examine_contact(j);
  }
  std::vector<std::size_t> leavable;
  for (std::size_t j = 0; j < m.contacts.size(); ++j)
    if (m.contacts[j].unilateral) leavable.push_back(j);
  // From all contacts to none.
  for (std::size_t choice = std::size_t{1} << leavable.size(); choice-- > 0;) {
    ClosedContacts closed(m.contacts.size(), false);
    for (std::size_t i = 0; i < leavable.size(); ++i) closed[leavable[i]] = ((choice >> i) & 1) != 0;
    if (!search->is_determinate(closed)) return false;
  }
  return true;
}

}  // namespace eomgen::mechanics
