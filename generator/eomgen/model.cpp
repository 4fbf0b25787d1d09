// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/model.hpp"

#include <cln/real.h>
#include <fmt/format.h>

#include <cmath>

#include "analysis/shortest_decimal.hpp"
#include "eomgen/prepared_runs.hpp"
#include "lists.hpp"
#include "model/model.hpp"
#include "run/quantities.hpp"

namespace eomgen {
namespace {

template <class T>
std::vector<std::string> names_of(const std::vector<T>& list) {
  return mapped(list, &T::name);
}

}  // namespace

std::recursive_mutex& library_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

CallListener::CallListener(const CallControl& control)
    : Listener(&stopped_), control_(control), stop_callback_(control.stop, SetFlag{&stopped_}) {}

pipeline::ApproachChoice approach_choice(Approach approach) {
  switch (approach) {
    case Approach::one: return pipeline::ApproachChoice::one;
    case Approach::two: return pipeline::ApproachChoice::two;
    case Approach::automatic: break;
  }
  return pipeline::ApproachChoice::automatic;
}

std::map<std::string, symbolic::Rational> exact_rationals(const std::map<std::string, double>& values) {
  std::map<std::string, symbolic::Rational> result;
  for (const auto& [name, value] : values) {
    if (!std::isfinite(value))
      throw Error("library", {}, fmt::format("the value of '{}' is not finite", name), "give a finite number");
    result[name] = analysis::shortest_decimal(value, name);
  }
  return result;
}

Model::Model(model::Model read)
    : read_(new model::Model(std::move(read)), LockedDelete{}), runs_(new PreparedRuns(read_), LockedDelete{}) {}

Model Model::from_file(const std::string& path) {
  const std::scoped_lock lock(library_mutex());
  return Model(model::read_model(path));
}

Model Model::from_text(const std::string& text, const std::string& name, const std::string& folder) {
  const std::scoped_lock lock(library_mutex());
  return Model(model::read_model_text(text, name + ".toml", folder));
}

Model Model::from(const Definition& definition, const std::string& name) { return from_text(definition.text(), name); }

std::string Model::id() const { return read_->id; }
std::string Model::title() const { return read_->title; }
std::vector<std::string> Model::coordinates() const { return names_of(read_->coordinates); }
std::vector<std::string> Model::parameters() const { return names_of(read_->parameters); }
std::vector<std::string> Model::inputs() const { return names_of(read_->inputs); }
std::vector<std::string> Model::scenes() const { return names_of(read_->scenes); }

std::vector<std::string> Model::warnings() const {
  return mapped(read_->warnings, [&](const Warning& warning) { return format_warning(warning); });
}

std::vector<Warning> Model::reader_warnings() const { return read_->warnings; }

double Model::number_of(const std::string& name, const std::string& text, const CallControl& control) const {
  const std::scoped_lock lock(library_mutex());
  const run::Quantity quantity = run::parse_quantity("library", text, text);
  const run::StatedUnit stated = run::stated_unit(*read_, name);
  if (quantity.unit) run::require_dimension("library", name, *quantity.unit, stated);
  if (!quantity.unit && stated.unit && control.on_warning) {
    const std::string si = run::si_unit(stated.unit->dimension);
    control.on_warning(format_warning(
        {SourceLocation{},
         fmt::format("the model states {} in {}, and {} without a unit is in {}", name, stated.unit->text, text, si),
         fmt::format("write {0} {1}, or {0} {2} if this is meant", text, stated.unit->text, si)}));
  }
  return cln::double_approx(quantity.value);
}

std::string Model::text() const { return fmt::format("{}", fmt::join(read_->lines, "\n")); }

std::string Model::folder() const { return read_->folder; }

}  // namespace eomgen
