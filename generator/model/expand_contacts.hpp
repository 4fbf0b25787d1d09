// SPDX-License-Identifier: GPL-3.0-or-later
// [[contact]]: several contacts of the same kind in one table. In: the tree of a file. Out: the same tree with a
// [[constraint]] for each contact in place of the tables. Kinds: points or corners of a body on a plane, spheres among
// one another, limits of coordinates.
#pragma once

#include <vector>

#include "model/document.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_contacts_of_tables = 3000;

/// Throws Error{stage "model"} for a table that is not well formed. Returns the lengths of shapes as expressions: they
/// must not be negative.
std::vector<Value> expand_contacts(const Source& source, Value& root);

}  // namespace eomgen::model
