// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/option_words.hpp"

#include <fmt/format.h>

#include <array>

#include "error.hpp"
#include "lists.hpp"
#include "model/names.hpp"

namespace eomgen::import {
namespace {

/// A word of an option and the value that it stands for.
template <typename T>
struct Word {
  const char* text;
  T value;
};
template <typename T>
Word(const char*, T) -> Word<T>;

constexpr std::array attitudes{Word{"euler", Attitude::euler}, Word{"euler_parameters", Attitude::euler_parameters}};
constexpr std::array frictions{Word{"smooth", FrictionLaw::smooth}, Word{"dry", FrictionLaw::dry},
                               Word{"none", FrictionLaw::none}};
constexpr std::array actuations{Word{"transmissions", Actuation::transmissions}, Word{"all", Actuation::all},
                                Word{"none", Actuation::none}};

template <typename Words>
std::vector<std::string> texts_of(const Words& words) {
  return mapped<std::string>(words, [&](const auto& word) { return word.text; });
}

template <typename Words>
auto parse(const std::string& option, const std::string& text, const Words& words) {
  for (const auto& word : words)
    if (text == word.text) return word.value;
  throw Error("import", {}, fmt::format("{} does not take {}", option, model::quote(text)),
              model::suggest_choice(text, texts_of(words)));
}

}  // namespace

ImportOptions import_options(const RobotOptions& options, const std::string& prefix) {
  ImportOptions result;
  result.floating = options.floating;
  result.attitude = parse(prefix + "attitude", options.attitude, attitudes);
  result.friction = parse(prefix + "friction", options.friction, frictions);
  result.actuation = parse(prefix + "actuators", options.actuators, actuations);
  result.stops = options.stops;
  result.parameters = options.parameters;
  result.exact_angles = options.exact_angles;
  return result;
}

std::vector<std::string> attitude_words() { return texts_of(attitudes); }
std::vector<std::string> friction_words() { return texts_of(frictions); }
std::vector<std::string> actuation_words() { return texts_of(actuations); }

}  // namespace eomgen::import
