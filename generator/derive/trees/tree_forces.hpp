// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on a tree of particles or bodies: uniform gravity as an acceleration of the whole tree, the rest as
// generalised forces. Shared by the tree formulations.
#pragma once

#include <vector>

#include "derive/imposition.hpp"

namespace eomgen::derive {

/// Expands functions of time, and imposes the constraints if `imposed`.
class ImposedExpansion {
 public:
  ImposedExpansion(Mechanics& m, bool imposed)
      : imposed_(imposed), impose_(constraint_substitution(m)), write_(time_function_substitution(m)) {}
  Ref operator()(Ref r) { return write_(imposed_ ? impose_(r) : r); }
  Vec3 operator()(const Vec3& v) { return {(*this)(v[0]), (*this)(v[1]), (*this)(v[2])}; }

 private:
  bool imposed_;
  symbolic::Substitution impose_, write_;
};

/// Splits off uniform gravity as an acceleration. `non_gravity_potential` receives the potential of everything else.
Vec3 extract_gravity(Mechanics& m, ImposedExpansion& expanded, Ref& non_gravity_potential);

/// Q_i - d(potential)/dq_i of the coordinates `of`.
std::vector<Ref> non_gravity_forces(Mechanics& m, const std::vector<std::uint32_t>& of, ImposedExpansion& expanded,
                                    Ref potential);

}  // namespace eomgen::derive
