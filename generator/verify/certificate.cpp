// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/certificate.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <eom/modes/contact_state.hpp>

#include "derive/formulations.hpp"
#include "oracle/state_sampler.hpp"
#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {
namespace {

// Rejections before the search for states ends: a base number, and a number per state.
constexpr std::size_t rejections_at_least = 200, rejections_per_point = 20;
// Digits of states that cost little. A state takes longer with every digit, above all the quadrature of integrals.
constexpr int usual_digits = 200;
// Fewer digits prove nothing. Differences are stored as binary64, which ends at 1e-308.
constexpr int least_digits = 10, most_digits = 300;

std::string describe(const Comparison& c) {
  return fmt::format("{:.1e} ({} against {})", c.max_relative_difference, c.a, c.b);
}

bool nearer_to_failing(const Comparison& a, const Comparison& b) {
  return a.max_relative_difference * b.tolerance < b.max_relative_difference * a.tolerance;
}

std::vector<std::size_t> unilateral_constraints(const mechanics::Mechanics& mechanics) {
  std::vector<std::size_t> result;
  for (const mechanics::Contact& contact : mechanics.contacts) {
    if (contact.unilateral && !contact.first_input) result.push_back(contact.constraints[0]);
  }
  return result;
}

Oracle::ContactInputs contact_inputs(const mechanics::Mechanics& mechanics) {
  Oracle::ContactInputs result;
  if (!mechanics.has_contact_inputs()) return result;
  for (std::size_t k = 0; k < mechanics.constraints.size(); ++k)
    if (mechanics.constraints[k].force_input) result.forces[k] = *mechanics.constraints[k].force_input;
  for (const mechanics::Contact& contact : mechanics.contacts) {
    for (std::uint32_t a = 0; a < contact.dimensions(); ++a) result.friction.push_back(*contact.first_input + a);
  }
  return result;
}

// The states of the contacts: open ones and others.
std::vector<int> mode_at(const mechanics::Mechanics& mechanics, const State& state) {
  std::vector<int> mode(mechanics.contacts.size());
  for (std::size_t j = 0; j < mechanics.contacts.size(); ++j) {
    const mechanics::Contact& contact = mechanics.contacts[j];
    if (contact.unilateral && !contact.first_input && state.open.contains(contact.constraints[0]))
      mode[j] = eom::contact_states / 2;
  }
  return mode;
}

/// Records a failure for code that is compared at no state, because it reports an undecided friction law at every
/// state.
void note_uncompared(const Subjects& subjects, ComparisonTable& tally) {
  const auto note = [&](const std::string& name, Arithmetic arithmetic) {
    const auto& rows = tally.comparisons();
    if (std::none_of(rows.begin(), rows.end(), [&](const Comparison& row) { return row.a == name; }))
      tally.record(name, system_name(subjects.systems.front()), true, 1, arithmetic);
  };
  if (subjects.systems.empty()) return;
  for (const ProgramForm& form : subjects.programs) note(form.name, Arithmetic::precise);
  for (const CompiledForm& form : subjects.compiled) note(form.name, Arithmetic::binary64);
}

/// The rejections allowed for so many points: fewer at extreme numbers, whose states need many digits.
std::size_t allowed_rejections(std::size_t points, int digits) {
  const std::size_t usual = rejections_at_least + rejections_per_point * points;
  return digits <= usual_digits ? usual : usual * usual_digits / static_cast<std::size_t>(digits);
}

}  // namespace

int required_extra_digits(const mechanics::Mechanics& mechanics) {
  constexpr int usual = 30, most = 1500;  // decades of binary64 numbers and their squares
  constexpr int coarse = 30;
  const Oracle oracle(*mechanics.model, coarse);
  const double largest = StateSampler(oracle, 0, 0).max_decades_from_one();
  return largest < usual ? 0 : std::min(most, static_cast<int>(2 * largest));
}

std::size_t Certificate::rejections() const {
  std::size_t sum = 0;
  for (const auto& [reason, count] : rejected) sum += count;
  return sum;
}

std::string Certificate::summary() const {
  std::vector<Comparison> shown;
  // The failures; if there are none, the strongest evidence: the pairs that share no code.
  const auto wanted = [&](const Comparison& c) { return pass ? !c.shares_code : !c.pass; };
  std::copy_if(comparisons.begin(), comparisons.end(), std::back_inserter(shown), wanted);
  std::string text = fmt::format("{}: {} points, {} digits", verdict(), points, options.digits);
  if (shown.empty()) return text;
  std::string out;
  for (const work::LeftOut& l : left_out) {
    if (l.over_budget) out += (out.empty() ? "; without " : ", ") + l.what;
  }
  const Comparison& worst = *std::max_element(shown.begin(), shown.end(), nearer_to_failing);
  text += ", worst " + describe(worst);
  if (!pass && shown.size() > 1) text += fmt::format(" and {} more comparisons", shown.size() - 1);
  return text + out;
}

std::vector<std::string> Certificate::agreeing_forms() const {
  std::vector<std::string> names;
  for (const Comparison& c : comparisons) {
    if (c.b != oracle_name || c.a.find(" of ") != std::string::npos) continue;
    const auto its_own = [&](const Comparison& row) {
      return row.b == oracle_name && (row.a == c.a || row.a.ends_with(" of " + c.a));
    };
    const bool all = std::all_of(comparisons.begin(), comparisons.end(),
                                 [&](const Comparison& row) { return row.pass || !its_own(row); });
    if (all) names.push_back(c.a);
  }
  return names;
}

std::vector<system::EquationSystem> all_formulations(mechanics::Mechanics& mechanics,
                                                     std::vector<work::LeftOut>* left_out) {
  constexpr std::size_t large = 16;  // coordinates
  std::vector<system::EquationSystem> systems;
  for (const derive::FormulationEntry& formulation : derive::formulations())
    for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
      // Without eliminated coordinates both approaches coincide: a large system is derived only once.
      if (approach == system::Approach::one && mechanics.fixed.empty() && mechanics.q.size() > large) continue;
      derive::DerivationResult outcome = derive::derive_if_worthwhile(formulation, mechanics, approach);
      if (outcome.system)
        systems.push_back(std::move(*outcome.system));
      else if (left_out != nullptr)
        left_out->push_back({fmt::format("{} {}", formulation.name, system::name(approach)),
                             std::move(outcome.skip_reason), outcome.over_budget});
    }
  return systems;
}

Certificate certify(const mechanics::Mechanics& mechanics, const Subjects& subjects, const Options& options) {
  if (options.digits < least_digits || options.digits > most_digits)
    throw Error("verify", SourceLocation{}, fmt::format("{} digits cannot be compared", options.digits),
                fmt::format("ask for {} to {}", least_digits, most_digits));
  const int range = options.extra_digits ? *options.extra_digits : required_extra_digits(mechanics);
  const int digits = options.digits + guard_digits + range;
  Oracle oracle(*mechanics.model, digits);
  for (std::uint32_t k = 0; k < mechanics.constraints.size(); ++k) {
    if (!mechanics.is_independent(k)) oracle.mark_implied(k);
  }
  oracle.set_contact_inputs(contact_inputs(mechanics));
  StateSampler points(oracle, options.seed, allowed_rejections(options.points, digits), options.fixed,
                      unilateral_constraints(mechanics));
  ComparisonTable tally(options.digits);
  bool interrupted = false;
  while (tally.points() < options.points) {
    State state = points.next();
    state.mode = mode_at(mechanics, state);
    ComparisonTable with_this_point = tally;
    try {
      compare_at(mechanics, subjects, oracle, state, with_this_point);
    } catch (const work::Interrupted&) {
      if (tally.points() == 0) throw;
      interrupted = true;
      break;
    } catch (const std::domain_error& no_value) {
      points.reject(no_value.what());
      continue;
    }
    tally = std::move(with_this_point);
    tally.count_point();
  }
  if (!interrupted) note_uncompared(subjects, tally);
  Certificate certificate;
  certificate.options = options;
  certificate.comparisons = tally.comparisons();
  certificate.points = tally.points();
  certificate.rejected = points.rejected();
  certificate.left_out = subjects.left_out;
  certificate.interrupted = interrupted;
  const auto& rows = certificate.comparisons;
  certificate.pass = !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const Comparison& c) { return c.pass; });
  return certificate;
}

Certificate verify(mechanics::Mechanics& mechanics, const Options& options) {
  Subjects subjects;
  subjects.systems = all_formulations(mechanics, &subjects.left_out);
  return certify(mechanics, subjects, options);
}

Certificate::Certificate() = default;
Certificate::Certificate(const Certificate&) = default;
Certificate::Certificate(Certificate&&) noexcept = default;
Certificate& Certificate::operator=(const Certificate&) = default;
Certificate& Certificate::operator=(Certificate&&) noexcept = default;
Certificate::~Certificate() = default;

}  // namespace eomgen::verify
