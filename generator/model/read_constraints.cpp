// SPDX-License-Identifier: GPL-3.0-or-later
// [[constraint]], [energy] and [impacts].
#include "model/read_constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "couplings/coupling.hpp"
#include "model/read_contacts.hpp"
#include "model/read_friction.hpp"

namespace eomgen::model {
namespace {

std::string form(std::string_view kind) {
  return fmt::format(
      "write {0} = {{ bodies = [\"A\", \"B\"], axes = [\"A.e3\", \"B.e3\"], ratio = \"-2\" }}, or {0} = {{ angles = "
      "[\"phi\", \"psi\"], ratio = \"-2\" }}; a ratio is the first speed over the second",
      kind);
}

/// Reader of gear = { .. } of a [[constraint]] and of the other couplings of couplings/: constraints on the velocities
/// of two rotations.
class CouplingsReader : private SectionReader {
 public:
  explicit CouplingsReader(ReaderContext& context) : SectionReader(context) {}
  /// The entry of the coupling in a [[constraint]]; nullptr if there is none.
  const Entry* find_coupling(const Value& table) const {
    for (const Entry& entry : table.entries) {
      if (couplings::find(entry.key) != nullptr) return &entry;
    }
    return nullptr;
  }

  void read(Constraint& constraint, const Entry& entry) {
    const couplings::Coupling& kind = *couplings::find(entry.key);
    const std::string what = fmt::format("the {} '{}'", kind.name, constraint.name);
    const Value& table = require_kind(Value::Kind::table, entry.value, what, form(kind.name));
    check_keys(table, {what, {"bodies", "axes", "carrier", "angles", "ratio"}});
    const Value *bodies = table.find("bodies"), *angles = table.find("angles");
    if (bodies == nullptr && angles == nullptr)
      source_.fail(table.span, fmt::format("{} has neither bodies nor angles", what), form(kind.name));
    for (const char* other : {"bodies", "axes", "carrier"}) {
      if (angles == nullptr || table.find(other) == nullptr) continue;
      source_.fail(key_span(table, other), fmt::format("{} has both angles and {}", what, other),
                   "keep the angles, or bodies and axes");
    }
    std::map<std::string, TypedNode> local;
    if (bodies != nullptr) constraint.coupled = between_bodies(table, what, local);
    if (angles != nullptr) {
      const std::string remedy = "write angles = [\"phi\", \"psi\"], two expressions of coordinates";
      require_kind(Value::Kind::array, *angles, fmt::format("'angles' of {}", what), remedy);
      if (angles->items.size() != 2)
        source_.fail(angles->span, fmt::format("{} is between {} angles", what, angles->items.size()), remedy);
      for (std::size_t k = 0; k < 2; ++k) {
        const Context angle{fmt::format("an angle of {}", what), on_motion, Shape::scalar, dimension_of("rad"),
                            "an angle is made of coordinates, functions of time, parameters and t"};
        local[fmt::format("angle{}", k + 1)] = resolver_.value(angles->items[k], angle);
      }
    }
    const Value& ratio = require_value(table, "ratio", what,
                                       "add ratio = \"-2\", the first speed over the second; of a belt it is positive");
    const Context number{fmt::format("the ratio of {}", what), on_motion, Shape::scalar, dimension_of("1"),
                         "a ratio is made of numbers, parameters, coordinates and t"};
    local["ratio"] = resolver_.value(ratio, number);
    if (constraint.coupled) constraint.coupled->ratio = local["ratio"].node;
    const auto& constant = local["ratio"].constant;
    if (constant && cln::zerop(*constant))
      resolver_.refuse_value(local["ratio"], ratio.span, number.what,
                             "is 0, which holds the first and leaves the second free", "give a ratio that is not 0");
    const TypedNode psi = resolver_.text(bodies != nullptr ? kind.body_equation : kind.angle_equation, local,
                                         table.span, {what, on_anything, Shape::scalar, std::nullopt, ""});
    if ((psi.dependencies & on_velocity) == 0 && resolver_.coordinates_in(psi.node).empty())
      source_.fail(table.span, fmt::format("{} binds nothing that moves", what), form(kind.name));
    constraint.velocity = true;
    constraint.psi.push_back(psi.node);
  }

 private:
  RotationCoupling between_bodies(const Value& table, const std::string& what,
                                  std::map<std::string, TypedNode>& local) {
    const Value& bodies = *table.find("bodies");
    const std::string remedy = "write bodies = [\"A\", \"B\"]; one of them may be \"ground\"";
    require_kind(Value::Kind::array, bodies, fmt::format("'bodies' of {}", what), remedy);
    if (bodies.items.size() != 2)
      source_.fail(bodies.span, fmt::format("{} is between {} bodies", what, bodies.items.size()), remedy);
    RotationCoupling coupled;
    std::array<std::uint32_t, 3>& frames = coupled.frames;  // A, B, carrier
    for (std::size_t k = 0; k < 2; ++k) frames[k] = require_frame(bodies.items[k], fmt::format("'bodies' of {}", what));
    const Value* carrier = table.find("carrier");
    if (carrier != nullptr) frames[2] = require_frame(*carrier, fmt::format("'carrier' of {}", what));
    if (frames[0] == frames[1])
      source_.fail(bodies.span, fmt::format("{} is between '{}' and itself", what, bodies.items[0].text), remedy);
    for (std::size_t k = 0; k < 2; ++k) {
      if (frames[k] != frames[2]) continue;
      source_.fail(carrier != nullptr ? carrier->span : bodies.items[k].span,
                   fmt::format("'{}' does not turn against the carrier of {}", bodies.items[k].text, what),
                   carrier != nullptr
                       ? "the carrier is a third body, or the ground, on which both turn"
                       : "add carrier = \"C\", the body on which both turn; it is the ground if left out");
    }
    const Value& axes =
        require_value(table, "axes", what, "add axes = [\"A.e3\", \"B.e3\"], the axes about which they turn");
    const bool two = axes.is(Value::Kind::array) && axes.items.size() == 2;
    if (axes.is(Value::Kind::array) && !two && axes.items.size() != 3)
      source_.fail(axes.span, fmt::format("'axes' of {} has {} entries", what, axes.items.size()),
                   "write axes = [\"axis of A\", \"axis of B\"], or one vector for both");
    const Context direction{fmt::format("an axis of {}", what), on_motion, Shape::vector, std::nullopt,
                            "it is made of axes of bodies, E1, E2, E3 and parameters"};
    const Span span = table.span;
    for (std::size_t k = 0; k < 2; ++k) {
      const Value& axis = two ? axes.items[k] : axes;
      local[k == 0 ? "a" : "b"] = resolver_.unit_of_vector(resolver_.value(axis, direction), axis.span);
      const std::map<std::string, TypedNode> speeds{{"w", relative_angular_velocity(frames[k], span)},
                                                    {"c", relative_angular_velocity(frames[2], span)}};
      local[k == 0 ? "wA" : "wB"] =
          resolver_.text("w - c", speeds, span, {what, on_anything, Shape::vector, std::nullopt, ""});
      coupled.axes[k] = local[k == 0 ? "a" : "b"].node;
    }
    return coupled;
  }

  TypedNode relative_angular_velocity(std::uint32_t frame, Span span) {
    if (frame > 0) return resolver_.angular_velocity(frame, span);
    return resolver_.check_context(resolver_.number(0, span), span, {"the ground", 0, Shape::vector, std::nullopt, ""});
  }
};

}  // namespace

void ConstraintsReader::declare() {
  for (const Value* table : sections("constraint")) {
    Keys keys{"[[constraint]]",
              {"name", "holonomic", "velocity", "rolling", "sliding", "holds", "restitution", "friction"}};
    for (const couplings::Coupling& coupling : couplings::registry()) keys.known.push_back(coupling.name);
    check_keys(*table, keys);
    const std::string name = text_of_key(*table, "name", "this [[constraint]]");
    Symbol& symbol = scope_.declare(SymbolKind::constraint, name, table->find("name")->span);
    symbol.index = static_cast<std::uint32_t>(model_.constraints.size());
    Constraint constraint;
    constraint.name = name;
    constraint.span = table->find("name")->span;
    model_.constraints.push_back(std::move(constraint));
  }
}

void ConstraintsReader::read() {
  std::size_t index = 0;
  for (const Value* table : sections("constraint")) {
    Constraint& constraint = model_.constraints[index++];
    const std::string what = fmt::format("the constraint '{}'", constraint.name);
    const Value* velocity = table->find("velocity");
    if (read_contact(constraint, *table) || read_coupling(constraint, *table)) continue;
    if (velocity != nullptr && table->find("holonomic") != nullptr) {
      source_.fail(velocity->span, fmt::format("{} is both 'holonomic' and 'velocity'", what),
                   "write one [[constraint]] for each; the velocities of a holonomic one follow");
    }
    constraint.velocity = velocity != nullptr;
    read_equations(
        constraint,
        velocity != nullptr
            ? *velocity
            : require_value(
                  *table, "holonomic", what,
                  "add holonomic = \"psi\", the expression that is 0, or velocity = \"..\" for one of velocities"));
    read_unilateral(constraint, *table);
    if (const Value* friction = table->find("friction"))
      FrictionReader(context_).read_constraint_friction(constraint, *friction);
  }
  for (const Value& text : context_.contact_lengths) {
    const TypedNode length =
        resolver_.value(text, {"a length of a shape in contact", 0, Shape::scalar, dimension_of("m"), ""});
    if (length.constant && cln::minusp(*length.constant))
      resolver_.refuse_value(length, text.span, "a length of a shape in contact", "is negative",
                             "a radius or an edge is 0 or more");
  }
}

// Reads rolling = { .. } or sliding = { .. }; returns false for any other constraint.
bool ConstraintsReader::read_contact(Constraint& constraint, const Value& table) {
  const Entry *rolling = table.entry("rolling"), *sliding = table.entry("sliding");
  if (rolling == nullptr && sliding == nullptr) return false;
  const Entry& kind = rolling != nullptr ? *rolling : *sliding;
  for (const char* other : {"holonomic", "velocity", "sliding"}) {
    if (table.find(other) == nullptr || other == kind.key) continue;
    source_.fail(key_span(table, other),
                 fmt::format("the constraint '{}' is both '{}' and '{}'", constraint.name, kind.key, other),
                 "write one [[constraint]] for each");
  }
  ContactsReader(context_).read(constraint, kind.value, rolling != nullptr, table.find("friction") != nullptr);
  read_unilateral(constraint, table);
  if (const Value* friction = table.find("friction"))
    FrictionReader(context_).read_constraint_friction(constraint, *friction);
  return true;
}

// Reads gear = { .. } or another coupling; returns false for any other constraint.
bool ConstraintsReader::read_coupling(Constraint& constraint, const Value& table) {
  CouplingsReader couplings(context_);
  const Entry* coupling = couplings.find_coupling(table);
  if (coupling == nullptr) return false;
  for (const Entry& other : table.entries) {
    if (other.key == "name" || &other == coupling) continue;
    source_.fail(other.span, fmt::format("'{}' does not belong to '{}'", other.key, coupling->key),
                 "write one [[constraint]] for each; a coupling holds, without friction, in both directions");
  }
  couplings.read(constraint, *coupling);
  return true;
}

// Reads holds = "unilateral": psi >= 0, with a coefficient of restitution.
void ConstraintsReader::read_unilateral(Constraint& constraint, const Value& table) {
  const std::string what = fmt::format("the constraint '{}'", constraint.name);
  const Value* holds = table.find("holds");
  const Value* restitution = table.find("restitution");
  if (holds != nullptr) {
    require_kind(Value::Kind::text, *holds, fmt::format("'holds' of {}", what),
                 "write holds = \"bilateral\" or \"unilateral\"");
    if (holds->text != "bilateral" && holds->text != "unilateral") {
      source_.fail(holds->span, fmt::format("a constraint cannot hold {}", quote(holds->text)),
                   "write holds = \"bilateral\", or \"unilateral\" for one that can be left");
    }
    constraint.unilateral = holds->text == "unilateral";
  }
  if (constraint.unilateral && constraint.rolling) {
    source_.fail(
        holds->span,
        fmt::format("{} can be left and has no friction, so that the tangential impulse is not defined", what),
        "give it friction = { static = \"..\", dynamic = \"..\" }: where it lands the body slides, and rolls when slip "
        "has ended; or write sliding for a smooth one");
  }
  if (constraint.unilateral && (constraint.velocity || constraint.psi.size() > 1)) {
    source_.fail(holds->span,
                 constraint.velocity ? fmt::format("{} binds velocities, and has no side to be left to", what)
                                     : fmt::format("{} has {} equations; a contact that can be left has one", what,
                                                   constraint.psi.size()),
                 "write one [[constraint]] with one holonomic = \"psi\" for each contact; it holds psi >= 0");
  }
  if (restitution == nullptr) return;
  if (!constraint.unilateral) {
    source_.fail(restitution->span,
                 fmt::format("'restitution' of {} has no effect: a bilateral constraint is never hit", what),
                 "add holds = \"unilateral\", or remove restitution");
  }
  constraint.restitution =
      resolver_
          .value(*restitution, Context{fmt::format("the restitution of {}", what), 0, Shape::scalar, dimension_of("1"),
                                       "a coefficient of restitution is a number or made of parameters"})
          .node;
}

void ConstraintsReader::read_equations(Constraint& constraint, const Value& value) {
  const std::string what = fmt::format("the constraint '{}'", constraint.name);
  Context context{what, on_motion, Shape::either, std::nullopt,
                  "a holonomic constraint is made of coordinates, functions of time, parameters and t; "
                  "one of velocities is given as velocity = \"..\""};
  if (constraint.velocity) {
    context.allowed = on_motion | on_velocity;
    context.remedy =
        "a constraint on velocities is made of velocities, coordinates, functions of time, parameters and t";
  }
  // The gradient of a square vanishes on the constraint, so that there would be no constraint force.
  const auto no_power = [&](const TypedNode& typed, const Value& of) {
    if (typed.vector || constraint.velocity) return;
    NodeId id = typed.node;
    while (model_.arena[id].op == Op::negate ||
           (model_.arena[id].op == Op::divide && resolver_.coordinates_in(model_.arena[id].args[1]).empty()) ||
           (model_.arena[id].op == Op::multiply && resolver_.coordinates_in(model_.arena[id].args[1]).empty()))
      id = model_.arena[id].args[0];
    while (model_.arena[id].op == Op::multiply && resolver_.coordinates_in(model_.arena[id].args[0]).empty())
      id = model_.arena[id].args[1];
    const Node& node = model_.arena[id];
    if (node.op != Op::power || !resolver_.coordinates_in(node.args[1]).empty()) return;
    const bool number = model_.arena[node.args[1]].op == Op::number;
    if (number && model_.arena[node.args[1]].value <= 1) return;
    std::string base = of.is(Value::Kind::text) ? of.text : "";
    const std::size_t hat = base.rfind('^');
    base =
        hat != std::string::npos && hat > 1 && base.front() == '(' && base[hat - 1] == ')' && base.find(')') == hat - 1
            ? base.substr(1, hat - 2)
            : "";
    source_.fail(of.span,
                 number
                     ? fmt::format("{} is a power: its gradient vanishes where it holds, so that it has no force", what)
                     : fmt::format("{} is a power: it holds where what is raised is 0, and its gradient has another "
                                   "size there for every exponent, or vanishes",
                                   what),
                 base.empty() ? "write what is raised to the power" : fmt::format("write \"{}\"", base));
  };
  const auto with_motion = [&](const TypedNode& typed, Span span) {
    if (typed.dependencies & (constraint.velocity ? on_velocity : on_coordinate)) return;
    if (constraint.velocity) {
      source_.fail(span, fmt::format("{} contains no velocity", what),
                   "write holonomic = \"..\" for a constraint on positions, or velocities such as \"y_dot + z*x_dot\"");
    }
    source_.fail(span, fmt::format("{} contains no coordinate, so that it cannot hold anything", what),
                 "write the expression of coordinates that is to be 0, such as \"R - L\"");
  };
  if (!value.is(Value::Kind::array) || value.items.size() == 3) {
    const TypedNode typed = resolver_.value(value, context);
    with_motion(typed, value.span);
    no_power(typed, value);
    if (!typed.vector) {
      constraint.psi.push_back(typed.node);
      return;
    }
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      constraint.psi.push_back(resolver_.component(typed, axis, value.span).node);
    return;
  }
  if (value.items.empty() || value.items.size() > 3) {
    source_.fail(value.span, fmt::format("{} has {} equations", what, value.items.size()),
                 "write one expression, two for a curve, or a vector for three");
  }
  context.shape = Shape::scalar;
  constraint.curve = value.items.size() == 2;
  for (const Value& item : value.items) {
    const TypedNode typed = resolver_.value(item, context);
    with_motion(typed, item.span);
    no_power(typed, item);
    constraint.psi.push_back(typed.node);
  }
}

void ConstraintsReader::read_energy(const std::optional<TypedNode>& armatures) {
  const Value* table = section("energy");
  if (table != nullptr) {
    check_keys(*table, {"[energy]", {"kinetic", "potential"}});
    if (table->entries.empty())
      source_.fail(table->span, "[energy] is empty", "add kinetic = \"..\" and potential = \"..\"");
  }
  const auto energy = [&](const char* key, Dependencies allowed, const char* remedy) -> std::optional<TypedNode> {
    const Value* value = table == nullptr ? nullptr : table->find(key);
    if (value == nullptr) return std::nullopt;
    return resolver_.value(
        *value, Context{fmt::format("the {} energy", key), allowed, Shape::scalar, dimension_of("J"), remedy});
  };
  std::optional<TypedNode> kinetic = energy("kinetic", on_motion | on_velocity,
                                            "energies are made of coordinates, velocities, functions of time and "
                                            "parameters; an input acts through a [[force]]");
  if (armatures) kinetic = kinetic ? resolver_.sum_of(*kinetic, *armatures, table->span) : armatures;
  if (kinetic) model_.energy.kinetic = kinetic->node;
  const std::optional<TypedNode> potential =
      energy("potential", on_motion,
             "a potential is made of coordinates, functions of time and parameters; what depends on velocities "
             "belongs to kinetic, and an input acts through a [[force]]");
  if (potential) model_.energy.potential = potential->node;
}

void ConstraintsReader::read_impacts() {
  const Value* table = section("impacts");
  if (table == nullptr) return;
  check_keys(*table, {"[impacts]", {"law", "order"}});
  const auto chosen = [&](const char* key, const std::vector<std::string>& words, const char* remedy) -> std::size_t {
    const Value* value = table->find(key);
    if (value == nullptr) return 0;
    require_kind(Value::Kind::text, *value, fmt::format("'{}' of [impacts]", key), remedy);
    const auto found = std::find(words.begin(), words.end(), value->text);
    if (found == words.end())
      source_.fail(value->span, fmt::format("there is no {} of impacts {}", key, quote(value->text)), remedy);
    return static_cast<std::size_t>(found - words.begin());
  };
  Impacts impacts;
  impacts.span = table->span;
  impacts.law = static_cast<Impacts::Law>(
      chosen("law", {"newton", "poisson", "moreau", "stronge"},
             "write law = \"newton\" (the default, without friction), \"poisson\", \"moreau\" or \"stronge\""));
  impacts.order = static_cast<Impacts::Order>(chosen(
      "order", {"simultaneous", "sequence"}, "write order = \"simultaneous\" (the default) or order = \"sequence\""));
  if (impacts.law == Impacts::Law::stronge) {
    const Value* order = table->find("order");
    if (order != nullptr && impacts.order == Impacts::Order::simultaneous)
      source_.fail(order->span, "Stronge's law holds for one contact at a time",
                   "write order = \"sequence\", or leave order out");
    impacts.order = Impacts::Order::sequence;
  }
  const auto opens = [](const Constraint& constraint) { return constraint.unilateral; };
  if (std::none_of(model_.constraints.begin(), model_.constraints.end(), opens))
    source_.fail(table->span, "[impacts] has no effect: no contact of the model can open",
                 "add holds = \"unilateral\" to a constraint, or remove [impacts]");
  model_.impacts = impacts;
}

}  // namespace eomgen::model
