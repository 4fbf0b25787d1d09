// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/formulas.hpp"

#include <cln/rational_io.h>
#include <fmt/format.h>

#include <sstream>

#include "analysis/equations.hpp"
#include "analysis/examination.hpp"
#include "analysis/latex_document.hpp"
#include "derive/formulations/lagrange.hpp"
#include "eomgen/call.hpp"
#include "eomgen/model.hpp"
#include "lists.hpp"
#include "symbolic/op_names.hpp"

namespace eomgen {
namespace {

std::string symbol_name(const model::Model& model, const symbolic::Symbol& s) {
  using symbolic::SymbolKind;
  switch (s.kind) {
    case SymbolKind::time: return "t";
    case SymbolKind::coordinate:
      return model.coordinates[s.index].name + (s.order == 0 ? "" : s.order == 1 ? "_dot" : "_ddot");
    case SymbolKind::parameter: return model.parameters[s.index].name;
    case SymbolKind::input: return model.inputs[s.index].name;
    case SymbolKind::function: return model.functions[s.index].name + std::string(s.order, '\'');
    case SymbolKind::integral:
    case SymbolKind::state: return model.states[s.index].name;
    case SymbolKind::friction: return fmt::format("friction.{}", s.index + 1);
    default: return fmt::format("mode.{}.{}", s.index + 1, s.order);
  }
}

/// Converts the part of the graph that `roots` depend on to Nodes, operands first.
class Writer {
 public:
  Writer(const model::Model& model, const symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots) {
    for (const symbolic::Ref r : dag.reachable(roots)) {
      const symbolic::Node& from = dag[r];
      Node node;
      node.op = symbolic::op_name(from.op);
      if (from.op == symbolic::Op::symbol) node.text = symbol_name(model, dag.symbol_of(r));
      if (from.op == symbolic::Op::power) node.text = fmt::format("{}", from.payload);
      if (from.op == symbolic::Op::constant) {
        std::ostringstream number;
        number << dag.value(r);
        node.text = number.str();
      }
      node.arity = from.arity;
      for (std::size_t i = 0; i < from.arity; ++i) node.args[i] = place_[from.args[i].id];
      place_[r.id] = static_cast<std::uint32_t>(nodes.size());
      nodes.push_back(std::move(node));
    }
  }
  std::uint32_t operator()(symbolic::Ref r) const { return place_.at(r.id); }
  std::vector<std::uint32_t> operator()(const std::vector<symbolic::Ref>& list) const {
    return mapped(list, [&](symbolic::Ref r) { return (*this)(r); });
  }

  std::vector<Node> nodes;

 private:
  std::map<std::uint32_t, std::uint32_t> place_;
};

}  // namespace

Examination Model::examine(const CallControl& control) const {
  return with_lock(control, [&](CallListener&) {
    const analysis::Examination found = analysis::examine(read_);
    Examination result;
    for (const auto& c : found.coordinates) {
      result.coordinates.push_back(c.name);
      result.coordinate_units.push_back({c.name, c.unit, ""});
      if (c.eliminated) result.eliminated.push_back(c.name);
    }
    result.parameters = found.parameters;
    result.inputs = found.inputs;
    result.degrees_of_freedom = found.degrees_of_freedom;
    result.constraints = found.constraints;
    result.forces = found.forces;
    for (const auto& c : found.conserved)
      result.conserved.push_back({c.name, c.title, c.expression, c.certainty != "numerical", c.where_zero});
    for (const auto& s : found.singular) result.singular.push_back(s.set);
    result.left_out = found.left_out;
    return result;
  });
}

Equations Model::equations(const EquationsOptions& options, const CallControl& control) const {
  return with_lock(control, [&](CallListener& call) {
    const analysis::Equations found = analysis::equations(read_, {approach_choice(options.approach), options.show, {}});
    for (const std::string& note : found.notes) call.on_warning(note);
    Equations result;
    result.approach = system::name(found.approach);
    for (const print::PrintedFormula& item : found.items) {
      if (item.left_out.empty()) result.formulas.push_back(item);
    }
    result.left_out = found.left_out;
    result.multipliers = found.multipliers;
    result.interrupted = found.interrupted;
    return result;
  });
}

Derivation Model::derivation(Approach approach, const CallControl& control) const {
  return with_lock(control, [&](CallListener&) {
    const work::Stage stage("deriving the equations");
    mechanics::Mechanics mechanics = mechanics::build_mechanics(read_);
    const system::EquationSystem system =
        derive::lagrange(mechanics, approach == Approach::one ? system::Approach::one : system::Approach::two);
    std::vector<symbolic::Ref> roots{system.kinetic, system.potential};
    for (const auto* list : {&system.M, &system.f, &system.A, &system.gamma})
      roots.insert(roots.end(), list->begin(), list->end());
    Writer write(*read_, *system.dag, roots);
    Derivation result;
    result.approach = system::name(system.approach);
    result.formulation = system.formulation;
    for (const std::uint32_t q : system.free) result.coordinates.push_back(read_->coordinates[q].name);
    for (const std::uint32_t k : system.active) result.constraints.push_back(mechanics.constraints[k].label);
    result.M = write(system.M);
    result.f = write(system.f);
    result.A = write(system.A);
    result.gamma = write(system.gamma);
    result.kinetic = write(system.kinetic);
    result.potential = write(system.potential);
    result.nodes = std::move(write.nodes);
    return result;
  });
}

std::string Model::latex_document(const CallControl& control, std::uint64_t seed) const {
  return with_lock(control, [&](CallListener&) { return analysis::latex_document(read_, seed); });
}

}  // namespace eomgen
