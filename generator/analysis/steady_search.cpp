// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/steady_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <optional>

#include "derive/imposition.hpp"
#include "model/names.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/calculus.hpp"
#include "work.hpp"

namespace eomgen::analysis {
namespace {

using linear::Precise;
using linear::Quantity;
using symbolic::SymbolKind;

const char* const command = "equilibria";

bool is_energy(const conservation::ConservedQuantity& c) {
  using system::OutputKind;
  return c.kind == OutputKind::energy || c.kind == OutputKind::jacobi || c.kind == OutputKind::applied_energy;
}
bool is_leaf(const conservation::ConservedQuantity& c) { return c.kind == system::OutputKind::integral; }

struct Neighbour {
  linear::State<Precise> z;
  linear::Setting<Precise> setting;
  linear::Field<Precise> field;
};

/// Points near the start, one per seed; nullopt if none is found.
std::vector<Neighbour> neighbours(const SteadyProblem& p, std::initializer_list<std::uint64_t> seeds) {
  std::vector<Neighbour> result;
  for (const std::uint64_t seed : seeds) {
    linear::Setting<Precise> setting = p.setting;
    const auto z = linear::nearby_state(*p.flow, p.z, setting, seed);
    if (!z) return {};
    linear::Field<Precise> field = p.flow->at(*z, setting);
    result.push_back({*z, std::move(setting), std::move(field)});
  }
  return result;
}

/// Conserved at these parameters: the rate vanishes in multiple precision at points near the start.
bool is_conserved(const SteadyProblem& p, const std::vector<Neighbour>& neighbours, const Quantity& quantity) {
  const linear::Tape tape = p.flow->tape({quantity.expression});
  for (const auto& [z, setting, field] : neighbours) {
    linear::ValueAndJacobian<Precise> s;
    try {
      s = p.flow->value_and_jacobian(tape, z, setting);
    } catch (const std::domain_error&) {
      return false;  // undefined somewhere, so not an invariant
    }
    Precise rate = s.jacobian(0, z.size() - 1), size(0);
    for (std::size_t i = 0; i < field.X.rows; ++i) {
      if (linear::is_zero(s.jacobian(0, i))) continue;
      rate = rate + s.jacobian(0, i) * field.X(i, 0);
      size = size + linear::magnitude(s.jacobian(0, i) * field.X(i, 0));
    }
    if (linear::magnitude(rate) > linear::tiny<Precise>(50) * (Precise(1) + size)) return false;
  }
  return !neighbours.empty();
}

/// Energies and momenta that may be conserved at these parameters only: for example, a torque of size 0 conserves a
/// momentum.
std::vector<Quantity> candidates(const SteadyProblem& p, bool energies) {
  const system::EquationSystem& s = p.system();
  const mechanics::Mechanics& m = p.derived->mechanics;
  symbolic::Dag& dag = *m.dag;
  std::vector<Quantity> result, momenta;
  symbolic::Ref jacobi = dag.sub(s.potential, s.kinetic);
  for (const std::uint32_t i : s.free) {
    const symbolic::Ref momentum = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 1})(s.kinetic);
    momenta.push_back({"momentum." + p.derived->model.coordinates[i].name, momentum});
    jacobi = dag.add(jacobi, dag.mul(momentum, m.qdot[i]));
  }
  if (energies)
    result = {{"energy", s.energy}, {"jacobi", jacobi}};
  else
    result = momenta;
  for (const conservation::ConservedQuantity& c : p.derived->conserved) {
    if (is_leaf(c) || is_energy(c) != energies) continue;
    const auto named = [&c](const Quantity& q) { return q.name == c.name; };
    if (std::none_of(result.begin(), result.end(), named)) result.push_back({c.name, c.expression});
  }
  return result;
}

struct ConservedQuantities {
  std::vector<Quantity> energies, momenta;
};

ConservedQuantities conserved_quantities(const SteadyProblem& p) {
  ConservedQuantities kept{candidates(p, true), candidates(p, false)};
  const std::vector<Neighbour> beside = neighbours(p, {21, 22, 23});
  for (auto* list : {&kept.energies, &kept.momenta})
    std::erase_if(*list, [&](const Quantity& q) { return !is_conserved(p, beside, q); });
  return kept;
}

/// Index in z of a coordinate of the model; nullopt if it is eliminated.
std::optional<std::size_t> place_of(const SteadyProblem& p, std::uint32_t coordinate) {
  const auto& free = p.system().free;
  const auto found = std::find(free.begin(), free.end(), coordinate);
  return found == free.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - free.begin()));
}

/// Coordinates of a rotation, if each of its entries is a coordinate.
template <std::size_t size>
std::optional<std::array<std::size_t, size>> places_of(const SteadyProblem& p, const model::Frame& frame) {
  if (frame.entries.size() != size) return std::nullopt;
  std::array<std::size_t, size> result{};
  for (std::size_t k = 0; k < size; ++k) {
    const model::Node& node = p.derived->model.arena[frame.entries[k]];
    if (node.op != model::Op::coordinate) return std::nullopt;
    const auto place = place_of(p, node.index);
    if (!place) return std::nullopt;
    result[k] = *place;
  }
  return result;
}

void name_attitudes(SteadyProblem& p, linear::SearchRequest& search) {
  const model::Model& model = p.derived->model;
  symbolic::Substitution imposed = derive::constraint_substitution(p.derived->mechanics),
                         written = derive::time_function_substitution(p.derived->mechanics);
  for (std::size_t f = 1; f < model.frames.size(); ++f) {
    const model::Frame& frame = model.frames[f];
    if (frame.rotation == "euler_parameters") {
      if (const auto places = places_of<4>(p, frame)) search.euler_parameters.push_back(*places);
    } else if (frame.singularity != model::no_node) {
      const symbolic::Ref regular = written(imposed(mechanics::lower_scalar(p.derived->mechanics, frame.singularity)));
      if (const auto places = places_of<3>(p, frame)) search.euler_angles.push_back({*places, regular});
    }
  }
}

/// Whether a conserved quantity is constant along the symmetry directions that are not retained, so it can be held with
/// the others. One that the constraints fix is not held: its value at the start is that of rounding.
bool can_be_held(const SteadyProblem& p, const std::vector<Neighbour>& neighbours, const linear::Symmetry& symmetry,
                 const Quantity& quantity) {
  const linear::Tape tape = p.flow->tape({quantity.expression});
  bool varies = false;
  for (const auto& [z, setting, field] : neighbours) {
    const linear::Matrix<Precise> jacobian = p.flow->value_and_jacobian(tape, z, setting).jacobian;
    const linear::Matrix<Precise> along = jacobian * linear::tangent(field, symmetry.chart);
    for (std::size_t k = 0; k < along.cols; ++k) {
      if (linear::magnitude(along(0, k)) <= linear::tiny<Precise>(50)) continue;
      varies = true;
      if (k >= symmetry.retained.size() || !symmetry.retained[k]) return false;
    }
  }
  return varies;
}

/// The initial state, or a state near it if the equations are not differentiable there; the search is the same.
linear::State<Precise> place_with_field(const SteadyProblem& p) {
  try {
    p.flow->at(p.z, p.setting);
    return p.z;
  } catch (const std::domain_error&) {
    linear::Setting<Precise> setting = p.setting;
    for (std::uint64_t seed = 500; seed < 510; ++seed) {
      if (auto z = linear::nearby_state(*p.flow, p.z, setting, seed)) return *z;
    }
    throw;
  }
}

[[noreturn]] void refuse_hold(const std::string& name, const std::string& why) {
  throw Error(command, {}, fmt::format("--hold: {} cannot be held: {}", model::quote(name), why),
              "hold a coordinate, a rate, a momentum or another output that depends on them alone");
}

Quantity output_named(const SteadyProblem& p, const std::string& name) {
  std::vector<std::string> names;
  for (const system::Output& output : p.system().outputs) {
    if (output.name == name) {
      for (const symbolic::Symbol& s : p.derived->mechanics.dag->symbols({output.value})) {
        if (s.kind == SymbolKind::time) refuse_hold(name, "it depends on t");
        const bool of_state = (s.kind == SymbolKind::coordinate && s.order < 2) || s.kind == SymbolKind::parameter ||
                              s.kind == SymbolKind::input || s.kind == SymbolKind::state;
        if (!of_state) refuse_hold(name, "it depends on accelerations or constraint forces");
      }
      return {name, output.value};
    }
    names.push_back(output.name);
  }
  const std::string hint = model::did_you_mean(name, names);
  throw Error(command, {}, fmt::format("--hold: there is no output {}", model::quote(name)),
              hint.empty() ? "eomgen run --output shows the outputs of a model" : hint);
}

void hold(SteadyMotions& result, const SteadyRequest& request, const std::vector<Quantity>& momenta,
          linear::SearchRequest& search) {
  SteadyProblem& p = result.problem;
  const auto add = [&](const Quantity& quantity, const Precise& value, const char* why) {
    search.held.push_back(quantity);
    search.targets.push_back(value);
    result.held.push_back({quantity.name, linear::to_double(value), why});
  };
  for (const auto& [name, value] : request.hold)
    add(output_named(p, name), linear::number<Precise>(Precise(value)), "as asked for");
  if (!request.hold.empty()) return;
  if (momenta.empty()) return;
  const linear::Symmetry symmetry = linear::find_symmetry(*p.flow, place_with_field(p), p.setting, 1);
  const std::vector<Neighbour> beside = neighbours(p, {31, 32});
  for (const Quantity& momentum : momenta) {
    if (!can_be_held(p, beside, symmetry, momentum)) continue;
    add(momentum, p.flow->tape({momentum.expression}).values<Precise>(p.flow->lookup(p.z, p.setting))[0],
        "conserved: its value at the start");
  }
}

void require_not_ignored(const SteadyMotions& result, const SteadyRequest& request) {
  const linear::Symmetry& s = result.search.symmetry;
  for (std::size_t k = 0; k < s.chart.independent.size(); ++k) {
    const std::string& name = result.problem.flow->names()[s.chart.independent[k]];
    if (!s.retained[k] && request.hold.contains(name))
      refuse_hold(name, "it is ignorable, and it advances in a steady motion");
  }
}

/// Notes a chart that is singular where a start ended.
void note_singular_chart(SteadyMotions& result, const linear::State<Precise>& z) {
  if (!result.singular) result.singular = find_singular_chart(result.problem, z);
}

/// For a search without result: throws Error if the equations are undefined where its starts ended, by a singular
/// chart, by a term of the model, or otherwise for more than `most` starts.
void require_ends(const SteadyMotions& result, std::size_t most) {
  const linear::SearchResult& search = result.search;
  if (search.failed_starts == 0) return;
  const SteadyProblem& p = result.problem;
  linear::State<Precise> z;
  for (const double x : search.failure_point) z.push_back(linear::number<Precise>(numeric::exact(x)));
  if (result.singular) {
    throw Error(command, p.derived->model.where(p.derived->model.scene(p.scene.name).span),
                fmt::format("no equilibrium and no steady motion found: {} of the starts end where {}",
                            search.failed_starts, result.singular.what),
                result.singular.remedy);
  }
  const NonsmoothTerm source = find_nonsmooth_term(p, z);
  if (!source.is_single && search.failed_starts <= most) return;
  throw Error(command, source.where,
              fmt::format("no equilibrium and no steady motion found: {} of the starts end where {} no slope ({})",
                          search.failed_starts, source.what, search.reason),
              "take coordinates that are regular there, put a smooth law in place of the one that has a kink or a root "
              "there, or begin the search at another start");
}

constexpr std::chrono::milliseconds most_after_interrupt{50};

void classify_stability(SteadyMotions& result, const SteadyRequest& request, const ConservedQuantities& kept) {
  SteadyProblem& p = result.problem;
  const linear::StabilityTest test(*p.flow, *p.derived->mechanics.dag, kept.energies, kept.momenta);
  if (result.search.failed_starts > 0) {
    linear::State<Precise> z;
    for (const double x : result.search.failure_point) z.push_back(linear::number<Precise>(numeric::exact(x)));
    note_singular_chart(result, z);
  }
  const auto begin = std::chrono::steady_clock::now();
  for (const linear::FoundPoint& point : result.search.points) {
    // After Ctrl-C the points that were found are shown, as many as can be classified at once.
    if (result.search.interrupted && std::chrono::steady_clock::now() - begin > most_after_interrupt) break;
    if (!leaves_contacts_open(p, point.z)) {
      ++result.in_contact;
      continue;
    }
    if (const model::SingularChart chart = find_singular_chart(p, point.z)) {
      note_singular_chart(result, point.z);
      result.search.record_failure(chart.what, point.z);
      continue;
    }
    try {
      SteadyMotion motion{linear::linearise(*p.flow, point.z, p.setting, p.neighbours, request.seed), point.family, {}};
      if (motion.l.kind == linear::MotionKind::motion) continue;  // not steady in the coordinates of that point
      motion.verdict = test(motion.l);
      result.points.push_back(std::move(motion));
    } catch (const std::domain_error& error) {  // the coordinates are singular there
      result.search.record_failure(error.what(), point.z);
    }
  }
}

}  // namespace

SteadyMotions steady_motions(const SteadyRequest& request) {
  SteadyMotions result{
      steady_problem(command, request.model, request.scene, request.overrides, {}, request.seed, Contacts::open),
      {},
      {},
      {},
      {}};
  SteadyProblem& p = result.problem;
  const model::Model& model = p.derived->model;
  try {
    linear::SearchRequest search{*p.flow,        p.z,          p.setting,       {}, {}, {}, {}, {},
                                 request.starts, request.seed, request.progress};
    for (const std::uint32_t i : p.system().free) search.ranges.push_back({p.scene.lower[i], p.scene.upper[i]});
    name_attitudes(p, search);
    const ConservedQuantities quantities = conserved_quantities(p);
    hold(result, request, quantities.momenta, search);
    {
      const work::Stage stage("looking for equilibria and steady motions");
      result.search = linear::find_steady_motions(search);
    }
    // Small models: classify and show what was found so far.
    constexpr std::size_t small = 8;  // coordinates
    std::optional<work::DeferInterrupt> kept;
    if (result.search.interrupted) {
      if (p.flow->coordinates() > small || result.search.points.empty()) throw work::Interrupted{};
      kept.emplace();
    }
    require_not_ignored(result, request);
    const bool none = result.search.points.empty();
    bool found_beyond = false;
    if (request.second_charts && !result.search.interrupted) {
      result.second_charts = search_second_charts(result, request);
      found_beyond = std::any_of(result.second_charts.begin(), result.second_charts.end(),
                                 [](const auto& beyond) { return beyond.found && !beyond.found->points.empty(); });
    }
    if (none && !found_beyond)
      require_ends(result, request.starts / 2);  // the others met no obstacle: there was nothing to find
    if (!result.search.symmetry.autonomous) {
      throw Error(command, SourceLocation{model.file, 0, 0, 1, ""},
                  "the accelerations depend on t: no motion stays what it is",
                  "eomgen linearize gives A(t) along a motion");
    }
    for (const std::size_t i : result.search.held) {
      const std::string why = result.search.held_in_vain
                                  ? "a family leaves it open; with its value at the start there is none"
                                  : "a family leaves it open: its value at the start";
      result.held.push_back({p.flow->names()[i], linear::to_double(p.z[i]), why});
    }
    const work::Stage stage("judging stability");
    classify_stability(result, request, quantities);
    if (result.points.empty() && !none && !found_beyond && result.in_contact == 0) require_ends(result, 0);
  } catch (const std::domain_error& error) {
    const NonsmoothTerm source = find_nonsmooth_term(p, p.z);
    throw Error(command, source.where,
                fmt::format("{} no slope at the start of this scene: {}", source.what, error.what()),
                "begin the search at another start");
  }
  return result;
}

}  // namespace eomgen::analysis
