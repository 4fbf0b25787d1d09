// SPDX-License-Identifier: GPL-3.0-or-later
// What a page draws of a model. In: the model and its mechanics. Out: outputs that the code is to have (positions, axes
// of bodies, ends of springs, points of joints and contacts), and where each part of the drawing finds its numbers
// among them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::cli {

class Drawing {
 public:
  /// Adds the outputs that the model has not got by itself to every candidate.
  explicit Drawing(pipeline::Derived& derived);

  /// In the order of the array that the page draws from.
  const std::vector<std::string>& outputs() const { return outputs_; }
  /// Sizes that depend on parameters only: masses and inertias of bodies, lengths of shapes. What depends on more is a
  /// negative number: unknown.
  const std::vector<symbolic::Ref>& sizes() const { return sizes_; }
  /// The parts: places, bodies, springs, dampers, joints, contacts, by indices into the outputs and the sizes.
  const Json& parts() const { return parts_; }

 private:
  std::size_t vector_of(const std::string& base);  // of outputs that are there: base1 .. base3
  std::size_t vector(pipeline::Derived& derived, const symbolic::Vec3& value);  // of new ones
  std::size_t size(pipeline::Derived& derived, model::NodeId value);
  void places(const model::Model& model);
  void bodies(pipeline::Derived& derived);
  void forces(pipeline::Derived& derived);
  void joints(pipeline::Derived& derived);
  void contacts(pipeline::Derived& derived);
  void shapes(pipeline::Derived& derived);

  std::vector<std::string> outputs_;
  std::vector<symbolic::Ref> sizes_;
  Json parts_;
};

/// The direction in which things fall, where gravity is uniform; nothing where there is none.
std::optional<std::array<double, 3>> falling(pipeline::Derived& derived, const std::vector<double>& parameters);

/// Whether parameters are all that an expression depends on.
bool is_of_parameters(const symbolic::Dag& dag, symbolic::Ref expression);

}  // namespace eomgen::cli
