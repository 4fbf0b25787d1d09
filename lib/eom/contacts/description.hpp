// SPDX-License-Identifier: MIT
// Contacts whose forces are inputs of compiled code: where the function NAME_contact_rows writes what a run needs to
// solve for these forces, and which inputs take them (docs/abi.md, "Contacts"). Data only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace eom::contacts {

/// A velocity that a contact restricts, linear in the rates of the free coordinates. In the array c: the velocity at
/// `first`, then its acceleration at qddot = 0, then its derivative with respect to the rate of each of `columns`.
struct Row {
  std::size_t first = 0;
  std::vector<std::size_t> columns = {};

  /// Index of the velocity.
  std::size_t rate() const { return first; }
  /// Index of the acceleration at qddot = 0.
  std::size_t bias() const { return first + 1; }
  /// Index of the derivative with respect to the rate of columns[k].
  std::size_t slope(std::size_t k) const { return first + 2 + k; }
  /// Index behind the row.
  std::size_t end() const { return first + 2 + columns.size(); }
};

inline constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Event functions of each contact.
inline constexpr std::size_t values_per_contact = 3;

/// Indices are those of values in the array c, and of inputs in the array u.
struct Description {
  std::string name;
  bool unilateral = false;          // it can open
  bool sticks = false;              // Coulomb's law; false: no friction, or the regularised law
  bool rolls = false;               // sticking is rolling
  std::size_t gap = none;           // psi of its constraint, >= 0 for a unilateral contact; none: no constraint
  Row normal = {};                  // the velocity of the gap
  std::size_t normal_scale = none;  // |normal force| = scale |lambda|
  std::size_t given_normal = none;  // the normal force; where there is no constraint
  std::vector<Row> slip = {};       // per tangent, at most two
  std::size_t static_coefficient = none, dynamic_coefficient = none;  // of friction
  std::size_t width = none;                                           // of the regularised law
  std::size_t restitution = none;                                     // of a unilateral contact
  std::size_t friction_input = none;                                  // of the first tangent; the others follow
  std::size_t force_input = none;                                     // of lambda
  std::size_t mode_input = none;                                      // of the mode as a number

  /// Whether the normal force is the multiplier of a constraint.
  bool has_constraint() const { return gap != none; }
};

/// The law of impacts.
enum class ImpactLaw { newton, poisson, moreau, stronge };
/// How contacts that meet at the same time take their impulses.
enum class ImpactOrder { simultaneous, sequence };

/// All contacts of a model.
struct Set {
  std::vector<Description> contacts = {};
  std::size_t values = 0;  // length of the array c
  ImpactLaw law = ImpactLaw::newton;
  ImpactOrder order = ImpactOrder::simultaneous;

  /// Whether there are no contacts.
  bool empty() const { return contacts.empty(); }
  /// Whether a contact can open, so that there are impacts.
  bool can_open() const {
    return std::any_of(contacts.begin(), contacts.end(), [](const Description& at) { return at.unilateral; });
  }
};

}  // namespace eom::contacts
