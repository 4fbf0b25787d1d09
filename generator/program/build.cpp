// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "abi/functions.hpp"
#include "error.hpp"
#include "program/abi_functions.hpp"
#include "program/array_program.hpp"
#include "program/derivative_systems.hpp"
#include "program/from_dag.hpp"
#include "program/hoist.hpp"
#include "program/inertias.hpp"
#include "program/taylor.hpp"
#include "system/contact_set.hpp"
#include "system/expressions.hpp"

namespace eomgen::program {
namespace {

// The function `frames` of the ABI.

/// Poses, Jacobians d(velocity)/d(qdot) of the free coordinates, and biases. `fix`: values that replace parameters.
FunctionExpressions frame_function(Dag& dag, const std::vector<system::Frame>& frames,
                                   const std::vector<std::uint32_t>& free,
                                   const std::map<std::uint32_t, symbolic::Rational>& fix) {
  FunctionExpressions function = empty_function("frames");
  std::map<symbolic::Symbol, Ref> values;
  for (const auto& [index, value] : fix) values[{symbolic::SymbolKind::parameter, index, 0}] = dag.constant(value);
  symbolic::Substitution fixed(dag, std::move(values));
  const auto append = [&](std::size_t result, const auto& entries) {
    for (const Ref r : entries) function.results[result].entries.push_back(fixed(r));
  };
  std::vector<symbolic::Derivation> by_rate;
  for (const std::uint32_t i : free)
    by_rate.push_back(symbolic::partial_derivative(dag, {symbolic::SymbolKind::coordinate, i, 1}));
  for (const system::Frame& frame : frames) {
    append(0, frame.position);
    append(0, frame.rotation);
    for (symbolic::Derivation& slope : by_rate) {
      std::array<Ref, 6> column;
      for (std::size_t c = 0; c < 6; ++c) column[c] = slope(frame.velocity[c]);
      append(1, column);
    }
    append(2, frame.bias);
  }
  return function;
}

constexpr double max_cost_ratio = 1.5;  // times the cheapest raw cost

// Longer straight-line code of `jac` exceeds the caches of instructions, so that loops may take less time.
constexpr std::size_t smallest_looped = 5000;  // flops

struct Candidate {
  std::size_t index = 0;  // index of the candidate
  std::unique_ptr<AbiFunctions> functions;
  FunctionExpressions rhs;
  PolynomialGraph raw;                  // as derived
  std::vector<PolynomialGraph> starts;  // for cheap candidates: flattened; expanded
  PolynomialGraph best;
  Operations operations;  // before, then after optimisation
  std::size_t raw_cost = 0;
};

PolynomialGraph tested(PolynomialGraph graph) {
  reduce_pivots(graph);
  return flatten(graph, false);
}

/// Optimises the graph. Afterwards common factors of a pivot and its scale that only optimisation reveals are
/// cancelled.
PolynomialGraph optimised(const std::vector<PolynomialGraph>& graphs) {
  PolynomialGraph best = optimise(graphs);
  while (true) {
    PolynomialGraph again = tested(best);
    if (count_operations(again).cost() >= count_operations(best).cost()) return best;
    best = std::move(again);
  }
}

PolynomialGraph as_derived(const AbiFunctions& functions, const FunctionExpressions& wanted) {
  const system::EquationSystem& system = functions.system();
  return from_dag(*system.dag, wanted, system.free, system.state_symbols());
}

/// The function as derived, which `flat` is tested, and the function with small products expanded.
std::vector<PolynomialGraph> starts(const PolynomialGraph& graph, PolynomialGraph flat) {
  constexpr std::size_t max_expanded_nodes = 3000;  // nodes; larger systems do not benefit
  std::vector<PolynomialGraph> result;
  result.push_back(std::move(flat));
  if (graph.size() < max_expanded_nodes) result.push_back(tested(flatten(expand(graph), false)));
  return result;
}

std::vector<ResultShape> shape(const FunctionExpressions& wanted) {
  std::vector<ResultShape> shape;
  for (const ResultExpressions& result : wanted.results)
    shape.push_back({result.name, result.entries.size(), result.code});
  return shape;
}

Function finished(const PolynomialGraph& graph, const FunctionExpressions& wanted) {
  return schedule(graph, wanted.name, shape(wanted));
}

void add_prepared(const Candidate& chosen, Program& program) {
  constexpr std::size_t max_searched_flops = 1500;  // flops; larger programs are split without a search
  std::vector<PolynomialGraph> graphs{chosen.best};
  if (chosen.operations.flops() < max_searched_flops) {
    graphs.insert(graphs.begin(), chosen.starts.begin(), chosen.starts.end());
  }
  std::optional<Hoisted> hoisted = hoist(graphs, chosen.operations, "rhs_prepared", shape(chosen.rhs));
  if (!hoisted) return;
  program.functions.push_back(std::move(hoisted->prepare));
  program.functions.push_back(std::move(hoisted->rest));
}

/// The candidates as derived: every formulation with both orders of elimination.
std::vector<Candidate> raw_candidates(const std::vector<system::EquationSystem>& systems, const Request& request) {
  const bool hold = holds_branches(request);
  std::vector<Candidate> result;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    for (const Ties ties : {Ties::ascending, Ties::descending}) {
      // A formulation that is already solved has no order of elimination.
      if (ties == Ties::descending && (systems[i].solution || systems[i].free.size() + systems[i].active.size() < 2))
        continue;
      Candidate candidate;
      candidate.index = i;
      candidate.functions = std::make_unique<AbiFunctions>(systems[i], request.fix, ties, hold);
      candidate.rhs = candidate.functions->rhs();
      candidate.raw = as_derived(*candidate.functions, candidate.rhs);
      candidate.best = tested(flatten(candidate.raw, false));
      candidate.operations = count_operations(candidate.best);
      candidate.raw_cost = candidate.operations.cost();
      result.push_back(std::move(candidate));
    }
  }
  return result;
}

/// Optimises the cheap candidates, each graph once, and returns the index of the best.
std::size_t choose(std::vector<Candidate>& candidates) {
  std::size_t cheapest = candidates[0].raw_cost;
  for (const Candidate& candidate : candidates) cheapest = std::min(cheapest, candidate.raw_cost);
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Candidate& candidate = candidates[i];
    if (static_cast<double>(candidate.raw_cost) > max_cost_ratio * static_cast<double>(cheapest)) continue;
    candidate.starts = starts(candidate.raw, std::move(candidate.best));
    const auto here = candidates.begin() + static_cast<std::ptrdiff_t>(i);
    const auto same =
        std::find_if(candidates.begin(), here, [&](const Candidate& c) { return c.starts == candidate.starts; });
    candidate.best = same == here ? optimised(candidate.starts) : same->best;
    candidate.operations = count_operations(candidate.best);
    if (!best || candidate.operations.cost() < candidates[*best].operations.cost()) best = i;
  }
  return *best;
}

// One entry per system, for its cheaper order of elimination.
std::vector<CandidateCost> candidate_costs(const std::vector<Candidate>& candidates,
                                           const std::vector<system::EquationSystem>& systems) {
  std::vector<CandidateCost> result;
  std::optional<std::size_t> last;
  for (const Candidate& candidate : candidates) {
    const system::EquationSystem& system = systems[candidate.index];
    if (last != candidate.index) {
      result.push_back({system.formulation, system.approach, system.form, candidate.operations});
    } else if (candidate.operations.cost() < result.back().operations.cost()) {
      result.back().operations = candidate.operations;
    }
    last = candidate.index;
  }
  return result;
}

std::size_t symbol_count(const system::EquationSystem& system, symbolic::SymbolKind kind) {
  std::size_t count = 0;
  std::vector<symbolic::Ref> roots;
  system::for_each_expression(system, [&roots](symbolic::Ref r, system::ExpressionRole part) {
    if (part != system::ExpressionRole::output) roots.push_back(r);
  });
  for (const symbolic::Symbol& symbol : system.dag->symbols(roots)) {
    if (symbol.kind == kind) count = std::max<std::size_t>(count, symbol.index + 1);
  }
  return count;
}

/// How derivatives are taken.
struct Way {
  Differentiate by = Differentiate::equations;
  Sweep sweep = Sweep::columns;
};

/// Columns of a derivative by parameters or inputs.
std::size_t column_count(const AbiFunctions& functions, const std::string& name, const Request& request) {
  const bool by_parameters = name.ends_with("_p");
  const std::size_t in_model = by_parameters ? request.parameters : request.inputs;
  if (in_model > 0) return in_model;
  return symbol_count(functions.system(),
                      by_parameters ? symbolic::SymbolKind::parameter : symbolic::SymbolKind::input);
}

FunctionExpressions function_expressions(AbiFunctions& functions, const std::string& name, const Request& request,
                                         const Way& way = {}) {
  static const std::map<std::string_view, FunctionExpressions (AbiFunctions::*)()> formulas{
      {"jac", &AbiFunctions::jac},
      {"inverse", &AbiFunctions::inverse},
      {"coriolis", &AbiFunctions::coriolis},
      {"gravity", &AbiFunctions::gravity},
      {"mass", &AbiFunctions::mass},
      {"momenta", &AbiFunctions::momenta},
      {"energy_gradients", &AbiFunctions::energy_gradients},
      {"constraints", &AbiFunctions::constraints},
      {"reactions", &AbiFunctions::reactions},
      {"events", &AbiFunctions::events},
      {"contact_rows", &AbiFunctions::contact_rows},
      {"rhs_open", &AbiFunctions::rhs_open},
      {"power", &AbiFunctions::power},
      {"resets", &AbiFunctions::resets}};
  if (const auto found = formulas.find(name); found != formulas.end()) return (functions.*found->second)();
  const auto count = [&](std::size_t in_model, symbolic::SymbolKind kind) {
    return in_model > 0 ? in_model : symbol_count(functions.system(), kind);
  };
  const auto frames = [&] { return request.frames ? request.frames() : std::vector<system::Frame>{}; };
  symbolic::Dag& dag = *functions.system().dag;
  if (name == "frames") return frame_function(dag, frames(), functions.system().free, request.fix);
  if (name == "regressor" || name == "momentum") {
    const InertiaFunctions of(dag, frames(), request.inertias ? request.inertias() : system::Inertias{},
                              functions.system().free, request.fix);
    return name == "regressor" ? of.regressor() : of.momentum();
  }
  if (is_value_jacobian(name))
    return functions.value_jacobian(name, request.outputs, column_count(functions, name, request), way.sweep);
  if (name == "jac_p") return functions.jac_p(count(request.parameters, symbolic::SymbolKind::parameter));
  if (name == "jac_u") return functions.jac_u(count(request.inputs, symbolic::SymbolKind::input));
  if (name == "jvp") return functions.jvp(way.by);
  if (name == "vjp") return functions.vjp(way.by);
  if (name == "hvp") return functions.hvp(way.by);
  if (name == "adjoint")
    return functions.adjoint(way.by, count(request.parameters, symbolic::SymbolKind::parameter),
                             count(request.inputs, symbolic::SymbolKind::input));
  throw Error("program", {}, fmt::format("there is no function `{}`", name),
              fmt::format("available functions: {}", fmt::join(abi::optional_functions(), ", ")));
}

/// Derivatives times a vector, which have a second way: through the solved accelerations.
bool is_product(const std::string& name) {
  return name == "jvp" || name == "vjp" || name == "adjoint" || name == "hvp";
}

/// Functions that other formulations than that of the right-hand side may give cheaper.
bool has_other_ways(const std::string& name) {
  return name == "jac" || name == "jac_p" || name == "jac_u" || name == "inverse" || is_product(name) ||
         is_value_jacobian(name);
}

/// Whether a derivative may be made with the internal forces of a tree. The others use M and f, or the solution.
bool uses_forces(const std::string& name) { return name.starts_with("jac") || is_value_jacobian(name); }

/// The ways to a derivative. A Jacobian matrix with far fewer rows than columns is made by rows, one with fewer columns
/// by columns; between them both are compared.
std::vector<Way> ways_to(const std::string& name, const AbiFunctions& functions, const Request& request) {
  constexpr std::size_t cost_of_row = 4;  // columns, about
  if (is_product(name)) return {{Differentiate::equations}, {Differentiate::solution}};
  if (!is_value_jacobian(name)) return {{}};
  const bool of_outputs = name.starts_with("outputs");
  if (of_outputs && !functions.has_outputs(request.outputs)) return {};
  const system::EquationSystem& system = functions.system();
  const std::size_t rows = of_outputs                      ? request.outputs.size()
                           : name.starts_with("reactions") ? system.reactions.size()
                                                           : 2 * system.free.size(),
                    columns = name.ends_with("_jac") ? 2 * system.free.size() + system.states.size() + 1
                                                     : column_count(functions, name, request);
  std::vector<Way> ways;
  if (cost_of_row * rows > columns) ways.push_back({Differentiate::equations, Sweep::columns});
  if (rows < columns) ways.push_back({Differentiate::equations, Sweep::rows});
  return ways.empty() ? std::vector<Way>{{}} : ways;
}

/// The functions with `reactions` and `momenta` before their derivatives, which are compared with their differences.
std::vector<std::string> with_values(const std::vector<std::string>& with) {
  std::vector<std::string> result = with;
  for (const char* const values : {"reactions", "momenta"}) {
    const auto derivative = std::find_if(result.begin(), result.end(), [values](const std::string& name) {
      return is_value_jacobian(name) && name.starts_with(values);
    });
    if (derivative != result.end() && std::find(result.begin(), result.end(), values) == result.end())
      result.insert(derivative, values);
  }
  return result;
}

/// The cheapest of several ways to the same derivatives, which need not be that of the right-hand side.
class Derivatives {
 public:
  Derivatives(const std::vector<system::EquationSystem>& systems, const Request& request, AbiFunctions& chosen)
      : systems_(systems), request_(request), chosen_(chosen) {}

  Function cheapest(const std::string& name) {
    if (ways_.empty()) {
      others_ = with_residual(systems_, request_);
      if (auto by_forces = with_forces(systems_, request_)) others_.push_back(std::move(by_forces));
      ways_.push_back(&chosen_);
      for (const std::unique_ptr<AbiFunctions>& other : others_) ways_.push_back(other.get());
    }
    std::vector<FunctionExpressions> wanted;
    std::vector<PolynomialGraph> raw, flat;
    std::vector<std::size_t> costs;
    const auto add = [&](AbiFunctions& functions, const Way& way) {
      wanted.push_back(function_expressions(functions, name, request_, way));
      raw.push_back(as_derived(functions, wanted.back()));
      flat.push_back(tested(flatten(raw.back(), false)));
      costs.push_back(count_operations(flat.back()).cost());
    };
    for (AbiFunctions* functions : ways_) {
      if (functions->has_forces() && !uses_forces(name)) continue;
      for (const Way& way : ways_to(name, *functions, request_)) add(*functions, way);
    }
    const std::size_t least = *std::min_element(costs.begin(), costs.end());
    // These have twice as many ways, whose costs are in the order of those after optimisation: only the cheapest is
    // optimised.
    const bool has_many = is_product(name) || is_value_jacobian(name);
    const double largest = (has_many ? 1 : max_cost_ratio) * static_cast<double>(least);
    std::optional<PolynomialGraph> best;
    std::vector<std::vector<PolynomialGraph>> tried;
    std::size_t best_cost = 0, which = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (static_cast<double>(costs[i]) > largest) continue;
      std::vector<PolynomialGraph> graphs = starts(raw[i], std::move(flat[i]));
      if (std::find(tried.begin(), tried.end(), graphs) != tried.end()) continue;
      tried.push_back(std::move(graphs));
      PolynomialGraph graph = optimised(tried.back());
      const std::size_t cost = count_operations(graph).cost();
      if (best && cost >= best_cost) continue;
      best = std::move(graph);
      best_cost = cost;
      which = i;
    }
    Function result = finished(*best, wanted[which]);
    if (name == "jac" && result.operations.flops() >= smallest_looped) {
      std::shared_ptr<const ArrayProgram> in_loops = loops();
      if (in_loops && in_loops->cost() < result.operations.cost()) result.loops = std::move(in_loops);
    }
    return result;
  }

 private:
  /// The cheapest form of `jac` with loops, or null.
  std::shared_ptr<const ArrayProgram> loops() {
    const MakeFunction make = [this](const FunctionExpressions& expressions) {
      const PolynomialGraph raw = as_derived(chosen_, expressions);
      return finished(optimised(starts(raw, tested(flatten(raw, false)))), expressions);
    };
    std::shared_ptr<const ArrayProgram> result;
    for (AbiFunctions* functions : ways_) {
      std::shared_ptr<const ArrayProgram> other = functions->jac_loops(make);
      if (other && (!result || other->cost() < result->cost())) result = std::move(other);
    }
    return result;
  }

  const std::vector<system::EquationSystem>& systems_;
  const Request& request_;
  AbiFunctions& chosen_;
  std::vector<std::unique_ptr<AbiFunctions>> others_;
  std::vector<AbiFunctions*> ways_;
};

}  // namespace

Program build_program(std::vector<system::EquationSystem>& systems, const Request& request) {
  if (systems.empty()) {
    throw Error("program", {}, "no formulation derives this model", "choose another approach or form");
  }
  std::vector<Candidate> candidates = raw_candidates(systems, request);
  std::size_t best = 0;
  if (request.optimise) best = choose(candidates);
  Candidate& chosen = candidates[best];
  const system::EquationSystem& system = systems[chosen.index];

  Program program;
  program.free = system.free;
  program.states = system.state_symbols();
  program.discrete = system.discrete;
  program.formulation = system.formulation;
  program.approach = system.approach;
  program.form = system.form;
  program.candidates = candidate_costs(candidates, systems);
  program.active_constraints = system.active.size();
  for (const system::Contact& contact : system.contacts) {
    program.contacts.push_back({contact.shape(), contact.name});
  }
  program.contact_set = system::contact_set(chosen.functions->system());
  program.holonomic = system.holonomic;
  program.functions.push_back(finished(chosen.best, chosen.rhs));
  const auto add = [&](const FunctionExpressions& wanted) {
    const PolynomialGraph raw = as_derived(*chosen.functions, wanted);
    PolynomialGraph flat = tested(flatten(raw, false));
    program.functions.push_back(finished(request.optimise ? optimised(starts(raw, std::move(flat))) : flat, wanted));
  };
  Derivatives derivatives(systems, request, *chosen.functions);
  for (const std::string& name : with_values(request.with)) {
    if (name == "outputs" || name == "rhs") continue;  // outputs: by requested names; rhs: always built
    if (name == "taylor") {
      program.taylor = taylor_series(program.functions.front());
      continue;
    }
    if (request.optimise && has_other_ways(name))
      program.functions.push_back(derivatives.cheapest(name));
    else
      add(function_expressions(*chosen.functions, name, request));
    if (name == "events") {
      for (const system::Event& event : system.events) program.events.push_back(event.name);
      for (const Kink& kink : chosen.functions->kinks()) program.kinks.emplace_back(program::name(kink));
    }
    if (name == "reactions") {
      for (const auto& reaction : system.reactions) program.reactions.push_back(reaction.label);
    }
  }
  if (!request.outputs.empty()) {
    add(chosen.functions->outputs(request.outputs));
    program.outputs = request.outputs;
  }
  if (request.optimise) add_prepared(chosen, program);
  return program;
}

}  // namespace eomgen::program
