// SPDX-License-Identifier: GPL-3.0-or-later
// Equations by named parts. Every letter is defined, and with the definitions the equations are the equations of
// motion. The printed formulas are evaluated, with finite differences for time derivatives and partial derivatives.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "derive/formulations/lagrange.hpp"
#include "print/formulas.hpp"
#include "print/render.hpp"
#include "support/folders.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using print::Statement;
using reading::FormulaKind;
using symbolic::Symbol;
using symbolic::SymbolKind;

namespace {

constexpr double step = 1e-4;     // of differences; for rates the error is its square
constexpr double allowed = 1e-5;  // relative to the terms, with third and fourth derivatives

struct Value {
  bool vector = false;
  std::array<double, 3> x{};  // a scalar uses the first entry
};
Value number(double x) { return {false, {x, 0, 0}}; }
Value combined(const Value& a, const Value& b, double factor) {
  Value result{a.vector || b.vector, {}};
  for (std::size_t k = 0; k < 3; ++k) result.x[k] = a.x[k] + factor * b.x[k];
  return result;
}
Value times(const Value& a, const Value& b) {
  const double factor = a.vector ? b.x[0] : a.x[0];
  Value result = a.vector ? a : b;
  for (double& x : result.x) x *= factor;
  return result;
}

std::string key(const reading::Formula& f) {
  std::string text = f.kind == FormulaKind::dot ? "dot " + key(f.args[0]) : f.word;
  for (const reading::Formula& lower : f.lower)
    text += lower.kind == FormulaKind::number ? " " + std::to_string(cln::double_approx(lower.number))
                                              : " q" + std::to_string(lower.symbol.index);
  return text;
}

/// Evaluates the statements along a motion with constant accelerations.
class Reader {
 public:
  Reader(const std::vector<Statement>& statements, std::vector<double> q, std::vector<double> v, std::vector<double> a,
         std::vector<double> parameters)
      : q_(std::move(q)), v_(std::move(v)), a_(std::move(a)), parameters_(std::move(parameters)) {
    for (const Statement& s : statements) {
      if (s.key == "parts") definitions_[key(s.formula.args[0])] = s.formula.args[1];
    }
  }

  Value operator()(const reading::Formula& f) {
    switch (f.kind) {
      case FormulaKind::number: return number(cln::double_approx(f.number));
      case FormulaKind::symbol: return number(symbol(f.symbol));
      case FormulaKind::mark: return mark(f);
      case FormulaKind::negative: return combined(number(0), (*this)(f.args[0]), -1);
      case FormulaKind::fraction: return times((*this)(f.args[0]), number(1 / (*this)(f.args[1]).x[0]));
      case FormulaKind::power: return number(std::pow((*this)(f.args[0]).x[0], (*this)(f.args[1]).x[0]));
      case FormulaKind::call: return call(f);
      case FormulaKind::product: {
        Value result = number(1);
        for (const reading::Formula& factor : f.args) {
          if (result.x == std::array<double, 3>{}) return result;  // 0 times an undefined vector
          result = times(result, (*this)(factor));
        }
        return result;
      }
      case FormulaKind::sum: {
        Value result = number(0);
        for (const reading::Formula& term : f.args) result = combined(result, (*this)(term), 1);
        return result;
      }
      case FormulaKind::dot_product: {
        const Value a = (*this)(f.args[0]), b = (*this)(f.args[1]);
        return number(a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2]);
      }
      case FormulaKind::dot: return dotted(f);
      case FormulaKind::rate: return over_time([&] { return (*this)(f.args[0]); }, 1);
      case FormulaKind::partial: return partial(f.args[0], f.args[1].symbol);
      default: FAIL("a form that no part has"); return {};
    }
  }

 private:
  double symbol(const Symbol& s) const {
    if (s.kind == SymbolKind::parameter) return parameters_[s.index];
    if (s.kind == SymbolKind::time) return t_;
    if (s.kind == SymbolKind::multiplier || s.kind == SymbolKind::friction) return 0;
    REQUIRE(s.kind == SymbolKind::coordinate);
    if (shift_ && shift_->first == s) return at(s) + shift_->second;
    return at(s);
  }
  double at(const Symbol& s) const {
    return s.order == 0 ? q_[s.index] + t_ * (v_[s.index] + t_ * a_[s.index] / 2) : v_[s.index] + t_ * a_[s.index];
  }
  Value mark(const reading::Formula& f) {
    if (f.word == "E") {
      Value unit{true, {}};
      unit.x[static_cast<std::size_t>(cln::double_approx(f.lower[0].number)) - 1] = 1;
      return unit;
    }
    const auto found = definitions_.find(key(f));
    INFO(key(f));
    REQUIRE(found != definitions_.end());
    return (*this)(found->second);
  }
  Value call(const reading::Formula& f) {
    const double x = (*this)(f.args[0]).x[0];
    switch (f.op) {
      case symbolic::Op::sin: return number(std::sin(x));
      case symbolic::Op::cos: return number(std::cos(x));
      case symbolic::Op::tan: return number(std::tan(x));
      case symbolic::Op::sqrt: return number(std::sqrt(x));
      case symbolic::Op::abs: return number(std::abs(x));
      case symbolic::Op::exp: return number(std::exp(x));
      case symbolic::Op::atan2: return number(std::atan2(x, (*this)(f.args[1]).x[0]));
      default: FAIL("a function that is not evaluated here"); return {};
    }
  }
  Value dotted(const reading::Formula& f) {
    if (const auto found = definitions_.find(key(f)); found != definitions_.end() && f.order == 1)
      return (*this)(found->second);
    return over_time([&] { return (*this)(f.args[0]); }, f.order);
  }
  template <class Evaluate>
  Value over_time(Evaluate&& evaluate, int order) {
    const double t = t_;
    const Value now = evaluate();
    t_ = t + step;
    const Value later = evaluate();
    t_ = t - step;
    const Value before = evaluate();
    t_ = t;
    if (order == 1) return times(combined(later, before, -1), number(1 / (2 * step)));
    return times(combined(combined(later, before, 1), now, -2), number(1 / (step * step)));
  }
  Value partial(const reading::Formula& of, const Symbol& by) {
    shift_ = {by, step};
    const Value above = (*this)(of);
    shift_ = {by, -step};
    const Value below = (*this)(of);
    shift_.reset();
    return times(combined(above, below, -1), number(1 / (2 * step)));
  }

  std::vector<double> q_, v_, a_, parameters_;
  std::map<std::string, reading::Formula> definitions_;
  double t_ = 0;
  std::optional<std::pair<Symbol, double>> shift_;
};

bool is_plain(const model::Model& model) {
  return model.functions.empty() && model.inputs.empty() && model.states.empty() && !model.bodies.empty();
}

}  // namespace

TEST_CASE("named parts: with their definitions the equations are the equations of motion") {
  int models = 0, with_axes_of_their_own = 0, by_forces = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() + "/models")) {
    if (entry.path().extension() != ".toml") continue;
    const model::Model model = model::read_model(entry.path().string());
    if (!is_plain(model)) continue;
    INFO(model.id);
    mechanics::Mechanics m = mechanics::build_mechanics(model);
    const reading::DisplayForm form = reading::derive_display_form(m, system::Approach::two);
    std::vector<Statement> statements;
    print::add_equations_by_parts(m, form, statements);
    if (std::any_of(statements.begin(), statements.end(), [](const Statement& s) { return !s.left_out.empty(); }))
      continue;
    std::vector<double> parameters(model.parameters.size()), q, v, a;
    for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i] = 0.7 + 0.3 * std::sin(static_cast<double>(i));
    for (std::size_t i = 0; i < m.q.size(); ++i) {
      const auto x = static_cast<double>(i);
      q.push_back(0.4 + 0.3 * std::cos(1.7 * x));
      v.push_back(0.5 * std::sin(2.3 * x + 1));
      a.push_back(0.6 * std::cos(3.1 * x + 2));
    }
    const system::EquationSystem s = derive::lagrange(m, system::Approach::two);
    // constraints of coordinates, imposed by the display form only
    if (s.free.size() != form.equations.size()) continue;
    std::vector<symbolic::Ref> rows = s.M;
    rows.insert(rows.end(), s.f.begin(), s.f.end());
    const std::vector<double> values = symbolic::evaluate(*s.dag, rows, [&](const Symbol& symbol) -> double {
      if (symbol.kind == SymbolKind::parameter) return parameters[symbol.index];
      if (symbol.kind == SymbolKind::coordinate) return (symbol.order == 0 ? q : v)[symbol.index];
      return 0;  // the time; multipliers and friction, as in Reader
    });
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) continue;
    Reader reader(statements, q, v, a, parameters);
    const std::size_t n = s.free.size();
    for (const Statement& statement : statements) {
      if (statement.key != "equations") continue;
      INFO(statement.coordinate);
      const auto at = std::find_if(s.free.begin(), s.free.end(),
                                   [&](std::uint32_t i) { return model.coordinates[i].name == statement.coordinate; });
      REQUIRE(at != s.free.end());
      const auto i = static_cast<std::size_t>(at - s.free.begin());
      double expected = -values[n * n + i], size = 1 + std::abs(expected);
      for (std::size_t k = 0; k < n; ++k) {
        expected += values[i * n + k] * a[s.free[k]];
        size += std::abs(values[i * n + k] * a[s.free[k]]);
      }
      const double found = reader(statement.formula.args[0]).x[0] - reader(statement.formula.args[1]).x[0];
      CHECK(std::abs(found - expected) < allowed * size);
    }
    ++models;
    by_forces +=
        std::any_of(statements.begin(), statements.end(), [](const Statement& part) { return part.role == "force"; });
    for (const mechanics::BodyRotation& spin : m.body_rotations)
      with_axes_of_their_own += spin.axes_angular_velocity != spin.w ? 1 : 0;
  }
  CHECK(models > 15);
  CHECK(with_axes_of_their_own > 2);  // models with axes that rotate differently from their bodies
  CHECK(by_forces > 0);               // models with long generalised forces
}

TEST_CASE("named parts: long forms use them, also for the constraint forces of approach I") {
  const model::Model model = model::read_model(test::source_folder() + "/models/R4_turntable.toml");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
    const reading::DisplayForm form = reading::derive_display_form(m, approach);
    REQUIRE(form.is_unexpanded);
    std::vector<Statement> statements;
    print::add_statements(m, form, {"equations"}, statements);
    const auto count = [&](const char* role) {
      return std::count_if(statements.begin(), statements.end(), [role](const Statement& s) { return s.role == role; });
    };
    CHECK(count("motion") == 6);
    CHECK(count("constraint force") == (approach == system::Approach::one ? 1 : 0));
    CHECK(count("position") == 1);
    CHECK(count("axes") == 3);
    CHECK(count("angular velocity") == 4);
    CHECK(count("rate of the angular momentum") == 1);
  }
}

TEST_CASE("named parts: equations and constraints use the same letters for constraints") {
  const std::regex letter(R"(d((?:psi|Psi)(?:_[0-9]+)?(?:_dot)?)/d)");
  std::set<std::string> seen;
  for (const char* name :
       {"R1_free_body_euler_parameters", "R3_sphere_on_incline", "R4_turntable", "R5_chaplygin_sphere"}) {
    const std::string model = name;
    CAPTURE(model);
    const mechanics::Mechanics m =
        mechanics::build_mechanics(model::read_model(test::source_folder() + "/models/" + model + ".toml"));
    const reading::DisplayForm form = reading::derive_display_form(m, system::Approach::two);
    REQUIRE(form.is_unexpanded);
    const std::vector<print::PrintedFormula> constraints = print::render(m, form, {"constraints"});
    for (const print::PrintedFormula& item : print::render(m, form, {"equations"})) {
      for (std::sregex_iterator match(item.text.begin(), item.text.end(), letter), end; match != end; ++match) {
        const std::string given = (*match)[1].str() + " = ";
        CAPTURE(given);
        seen.insert(given);
        CHECK(std::any_of(constraints.begin(), constraints.end(),
                          [&](const print::PrintedFormula& c) { return c.text.starts_with(given); }));
      }
    }
  }
  CHECK(seen.contains("psi = "));        // a single constraint
  CHECK(seen.contains("psi_1_dot = "));  // a velocity constraint
  CHECK(seen.contains("psi_4 = "));
}

// A damper, a force, a force with a moment and a spring, all attached to a body with a Rodrigues vector.
TEST_CASE("named parts: long generalised forces are written with named forces and moments") {
  const std::string text = R"toml(format = 1
[parameters]
m = "1 kg"
c = "2 N*s/m"
k = "3 N/m"
f = "4 N"
[[body]]
name = "B"
mass = "m"
inertia = { principal = ["0.3 kg*m^2", "0.4 kg*m^2", "0.5 kg*m^2"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { rodrigues = ["l1", "l2", "l3"] }
[[point]]
name = "A"
on = "B"
at = [0.1, 0.2, 0.3]
[[point]]
name = "G"
position = "0.5*E1 - 2*E3"
[[force]]
damper = { between = ["A", "G"], coefficient = "c" }
[[force]]
name = "thrust"
on = "A"
force = "f*(B.e1 + 2*B.e3)"
[[force]]
spring = { between = ["A", "G"], stiffness = "k" }
)toml";
  const model::Model model = model::read_model_text(text, "forces.toml");
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  const reading::DisplayForm form = reading::derive_display_form(m, system::Approach::two);
  std::vector<Statement> statements;
  print::add_equations_by_parts(m, form, statements);
  std::set<std::string> roles;
  for (const Statement& s : statements) {
    CHECK(s.left_out.empty());
    roles.insert(s.role + " " + s.name);
  }
  for (const char* role :
       {"position A", "position G", "line force 1", "line force 3", "force force 1", "point thrust", "force thrust"}) {
    CAPTURE(std::string(role));
    CHECK(roles.contains(role));
  }
}
