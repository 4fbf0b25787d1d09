// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/start_description.hpp"

#include <algorithm>
#include <map>

#include "mechanics/imposition.hpp"
#include "program/from_dag.hpp"
#include "run/start_rows.hpp"

namespace eomgen::pipeline {
namespace {

using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

constexpr int none = -1;

class Description {
 public:
  Description(DerivedModel& derived, const model::Scene& scene)
      : model_(derived.model),
        m_(derived.mechanics),
        system_(derived.candidates.front()),
        scene_(scene),
        dag_(*m_.dag),
        written_(mechanics::time_function_substitution(m_)),
        begins_(dag_, integrals_at_start()) {}

  std::shared_ptr<const emit::StartDescription> operator()() {
    times();
    parameters();
    initial_values();
    guesses();
    initial_parameters();
    fixed_coordinates();
    find_time_kinks();
    states_of_first_order();
    ranges();
    if (!rows()) return nullptr;
    result_->values = function("start_values", {{"v", values_}});
    return result_;
  }

 private:
  std::map<Symbol, Ref> integrals_at_start() const {
    std::map<Symbol, Ref> zero;
    for (std::uint32_t i = 0; i < model_.states.size(); ++i) {
      if (model_.states[i].integral) zero[{SymbolKind::integral, i, 0}] = dag_.zero();
    }
    return zero;
  }
  Ref at_start(Ref expression) { return begins_(written_(expression)); }
  /// An expression of the scene; coordinates that are not in the state stand for the values that the scene gives them.
  Ref formula(model::NodeId id) {
    return symbolic::Substitution(dag_, eliminated_)(at_start(mechanics::lower_scalar(m_, id)));
  }
  int add(Ref value) {
    values_.push_back(value);
    return static_cast<int>(values_.size()) - 1;
  }
  /// The entry of x, or none for an eliminated coordinate.
  int state(std::uint32_t coordinate, std::uint8_t order) const {
    const auto found = std::find(system_.free.begin(), system_.free.end(), coordinate);
    if (found == system_.free.end()) return none;
    return static_cast<int>(found - system_.free.begin()) + (order == 0 ? 0 : static_cast<int>(system_.free.size()));
  }
  Ref time() { return dag_.symbol({SymbolKind::time, 0, 0}); }

  void times() {
    add(scene_.t0 == model::no_node ? dag_.zero() : formula(scene_.t0));
    add(scene_.t1 == model::no_node ? dag_.add(time(), dag_.constant(10)) : formula(scene_.t1));
  }

  void parameters() {
    for (std::uint32_t i = 0; i < model_.parameters.size(); ++i) {
      const auto index = static_cast<int>(i);
      if (model_.start_time == i) {
        const int begin = add(time());
        result_->dependent.insert(result_->dependent.end(), {index, begin});
        result_->early.insert(result_->early.end(), {index, begin});
        continue;
      }
      const bool set =
          std::any_of(scene_.parameters.begin(), scene_.parameters.end(), [i](const auto& p) { return p.first == i; });
      if (set || model_.parameters[i].initial_value_of || dag_.symbols({m_.parameter_value[i]}).empty()) continue;
      result_->dependent.insert(result_->dependent.end(), {index, add(m_.parameter_value[i])});
    }
  }

  void initial_values() {
    for (const model::InitialValue& initial : scene_.initial) {
      const Ref value = formula(initial.value);
      const int at = state(initial.coordinate, initial.order);
      if (at == none)
        eliminated_[{SymbolKind::coordinate, initial.coordinate, initial.order}] = value;
      else
        result_->stated.insert(result_->stated.end(), {at, add(value)});
    }
  }

  void guesses() {
    result_->guess.assign(2 * system_.free.size(), none);
    for (const model::InitialValue& guess : scene_.guess) {
      const int at = state(guess.coordinate, guess.order);
      if (at != none) result_->guess[static_cast<std::size_t>(at)] = add(formula(guess.value));
    }
  }

  void initial_parameters() {
    for (std::uint32_t i = 0; i < model_.parameters.size(); ++i) {
      const auto& of = model_.parameters[i].initial_value_of;
      if (!of) continue;
      const auto index = static_cast<int>(i);
      if (const int at = state(*of, 0); at != none) {
        result_->initial.insert(result_->initial.end(), {index, at, result_->guess[static_cast<std::size_t>(at)]});
        continue;
      }
      const auto given = eliminated_.find({SymbolKind::coordinate, *of, 0});
      const auto guess = std::find_if(scene_.guess.begin(), scene_.guess.end(),
                                      [&](const auto& g) { return g.coordinate == *of && g.order == 0; });
      const Ref before = given != eliminated_.end()    ? given->second
                         : guess != scene_.guess.end() ? formula(guess->value)
                                                       : dag_.zero();
      result_->early.insert(result_->early.end(), {index, add(before)});
      for (const mechanics::FixedCoordinate& fixed : m_.fixed) {
        if (fixed.coordinate == *of) result_->late.insert(result_->late.end(), {index, add(at_start(fixed.value))});
      }
    }
  }

  void fixed_coordinates() {
    for (const mechanics::FixedCoordinate& fixed : m_.fixed) {
      for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
        const auto given = eliminated_.find({SymbolKind::coordinate, fixed.coordinate, order});
        if (given == eliminated_.end() || is_movable(fixed.coordinate, order)) continue;
        result_->fixed.insert(result_->fixed.end(),
                              {add(given->second), add(at_start(order == 0 ? fixed.value : fixed.rate))});
      }
    }
  }

  void find_time_kinks() {
    std::vector<Ref> roots;
    for (const mechanics::Constraint& c : m_.constraints) {
      roots.push_back(written_(c.holonomic() ? c.psi : m_.velocity_form(c)));
    }
    const std::vector<Symbol> symbols = dag_.symbols(roots);
    const bool moves = std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) {
      return s.kind == SymbolKind::time || s.kind == SymbolKind::input;
    });
    const std::vector<Ref> parts = dag_.reachable(roots);
    const bool bends = std::any_of(parts.begin(), parts.end(), [this](Ref r) { return symbolic::is_kink(dag_[r].op); });
    result_->has_time_kinks = moves && bends;
  }

  /// Their values may use coordinates and velocities after the solution.
  void states_of_first_order() {
    std::map<Symbol, Ref> solved;
    for (const mechanics::FixedCoordinate& fixed : m_.fixed) {
      solved[{SymbolKind::coordinate, fixed.coordinate, 0}] = at_start(fixed.value);
      solved[{SymbolKind::coordinate, fixed.coordinate, 1}] = at_start(fixed.rate);
    }
    symbolic::Substitution after(dag_, solved);
    for (std::size_t k = 0; k < system_.states.size(); ++k) {
      const std::uint32_t index = system_.states[k].symbol.index;
      const model::State& state = model_.states[index];
      if (state.integral) continue;
      const auto given =
          std::find_if(scene_.states.begin(), scene_.states.end(), [index](const auto& s) { return s.state == index; });
      const model::NodeId start = given != scene_.states.end() ? given->value : state.initial;
      const Ref value = start == model::no_node ? dag_.zero() : after(at_start(mechanics::lower_scalar(m_, start)));
      result_->first_order.insert(result_->first_order.end(),
                                  {static_cast<int>(system_.layout().first_order_begin() + k), add(value)});
    }
  }

  void ranges() {
    for (std::uint32_t i = 0; i < model_.coordinates.size(); ++i) {
      const model::Coordinate& c = model_.coordinates[i];
      Ref value = dag_.symbol({SymbolKind::coordinate, i, 0});
      for (const mechanics::FixedCoordinate& fixed : m_.fixed) {
        if (fixed.coordinate == i) value = at_start(fixed.value);
      }
      if (c.lower != model::no_node) result_->inside.push_back(add(dag_.sub(value, formula(c.lower))));
      if (c.upper != model::no_node) result_->inside.push_back(add(dag_.sub(formula(c.upper), value)));
    }
  }

  bool is_movable(std::uint32_t coordinate, std::uint8_t order) const {
    return std::find(scene_.solve.begin(), scene_.solve.end(), std::pair{coordinate, order}) != scene_.solve.end();
  }

  bool rows() {
    std::vector<double> unused(model_.parameters.size(), 0);
    run::StartProblem problem{m_, system_, scene_, 0, unused, {}, {}, {}, {}, {}};
    for (const model::InitialAngularVelocity& given : scene_.rotations)
      problem.angular_velocities.push_back({given.frame, {}, given.span});
    run::StartRows rows(problem);
    problem.open.resize(rows.contacts().size(), false);
    rows.add_rolling();
    const std::size_t count = rows.b().size(), n = system_.free.size();
    if (count == 0) return true;
    if (count * std::max(count, n) > emit::max_start_entries) return false;
    result_->taken.assign(2 * count, 0);
    for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
      for (const std::size_t row : rows.of_order(order)) result_->taken[count * order + row] = 1;
    }
    result_->target.assign(count, none);
    result_->rolls.assign(count, none);
    std::size_t row = rows.first_angular_velocity_row();
    for (const model::InitialAngularVelocity& given : scene_.rotations) {
      for (const model::NodeId value : given.value) result_->target[row++] = add(formula(value));
    }
    for (const std::size_t contact : rows.rolling_contacts()) {
      result_->taken[count + row] = 0;  // only while it rolls
      result_->rolls[row++] = static_cast<int>(contact);
    }
    for (const run::StartRows::Contact& contact : rows.contacts())
      result_->contacts.push_back(contact.unilateral ? static_cast<int>(*contact.row) : none);
    std::vector<Ref> A, psi, b;
    for (const Ref r : rows.A()) A.push_back(begins_(r));
    for (const Ref r : rows.psi()) psi.push_back(begins_(r));
    for (const Ref r : rows.b()) b.push_back(begins_(r));
    result_->rows = function("start_rows", {{"A", A}, {"psi", psi}, {"b", b}});
    held_angles();
    return true;
  }

  void held_angles() {
    const std::size_t moved = system_.layout().first_order_begin();
    result_->movable.assign(moved, 0);
    result_->angle.assign(moved, 0);
    result_->unit.assign(moved, none);
    for (const auto& [coordinate, order] : scene_.solve) {
      if (const int at = state(coordinate, order); at != none) result_->movable[static_cast<std::size_t>(at)] = 1;
    }
    result_->holds_angles = std::any_of(model_.constraints.begin(), model_.constraints.end(),
                                        [](const model::Constraint& c) { return c.contact.has_value(); });
    result_->tries_angles = !model_.joints.empty();
    for (std::uint32_t f = 1; f < model_.frames.size(); ++f) hold_angles(f);
  }

  void hold_angles(std::uint32_t f) {
    const model::Frame& frame = model_.frames[f];
    const bool turns = std::any_of(scene_.rotations.begin(), scene_.rotations.end(),
                                   [f](const auto& given) { return given.frame == f; });
    const bool unit = frame.rotation == "euler_parameters";
    std::vector<int> states;
    for (const model::NodeId entry : frame.entries) {
      const model::Node& node = model_.arena[entry];
      states.push_back(node.op == model::Op::coordinate ? state(node.index, 0) : none);
    }
    for (const model::NodeId entry : frame.entries) {
      const model::Node& node = model_.arena[entry];
      if (node.op != model::Op::coordinate || state(node.index, 0) == none) continue;
      const auto at = static_cast<std::size_t>(state(node.index, 0)), rate = at + system_.free.size();
      if (!is_guessed(node.index, 0)) {
        result_->angle[at] = 1;
        if (unit) result_->unit[at] = static_cast<int>(result_->quadruple.size() / 4);
      }
      if (!turns && !is_guessed(node.index, 1)) result_->angle[rate] = 1;
    }
    if (unit) result_->quadruple.insert(result_->quadruple.end(), states.begin(), states.end());
  }

  bool is_guessed(std::uint32_t coordinate, std::uint8_t order) const {
    return std::any_of(scene_.guess.begin(), scene_.guess.end(),
                       [&](const auto& g) { return g.coordinate == coordinate && g.order == order; });
  }

  program::Function function(const std::string& name, const std::vector<program::ResultExpressions>& results) {
    program::FunctionExpressions wanted;
    wanted.name = name;
    wanted.results = results;
    std::vector<program::ResultShape> shape;
    for (const program::ResultExpressions& result : results) shape.push_back({result.name, result.entries.size(), 0});
    return program::schedule(program::flatten(program::from_dag(dag_, wanted, system_.free), false), name, shape);
  }

  const model::Model& model_;
  mechanics::Mechanics& m_;
  const system::EquationSystem& system_;
  const model::Scene& scene_;
  symbolic::Dag& dag_;
  symbolic::Substitution written_, begins_;
  std::map<Symbol, Ref> eliminated_;  // the values that the scene gives to eliminated coordinates and their rates
  std::vector<Ref> values_;
  std::shared_ptr<emit::StartDescription> result_ = std::make_shared<emit::StartDescription>();
};

}  // namespace

std::shared_ptr<const emit::StartDescription> describe_start(DerivedModel& derived, const model::Scene& scene) {
  return Description(derived, scene)();
}

}  // namespace eomgen::pipeline
