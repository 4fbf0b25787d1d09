// SPDX-License-Identifier: GPL-3.0-or-later
// Conflicts of output names: a name of the model must differ from the built-in outputs and from those derived from
// other names.
#include <fmt/format.h>

#include <map>

#include "model/read_scenes.hpp"

namespace eomgen::model {

void ScenesReader::refuse_shadowed_outputs() {
  std::map<std::string, std::string> taken;  // output name -> description
  const auto derived = [&taken](const std::string& name, const std::string& what) { taken.emplace(name, what); };
  derived("energy", "T + U");
  derived("kinetic", "the kinetic energy");
  derived("potential", "the potential energy");
  derived("power", "what changes the energy");
  derived("jacobi", "the Jacobi integral");
  derived("all", "every output");
  derived("energy.applied", "an integral of the motion");
  for (const char* axis : {"E1", "E2", "E3"}) {
    derived(fmt::format("linear_momentum.{}", axis), "the momentum of all masses");
    derived(fmt::format("angular_momentum.{}", axis), "the angular momentum of all masses");
  }
  for (const Coordinate& c : model_.coordinates)
    derived("momentum." + c.name, fmt::format("the generalised momentum of '{}'", c.name));
  for (const Constraint& c : model_.constraints) {
    for (const char* what : {"reaction", "integral", "friction", "slip", "mode", "gap"})
      derived(fmt::format("{}.{}", what, c.name), fmt::format("an output of '{}'", c.name));
  }
  for (const Force& f : model_.forces) {
    for (const char* what : {"friction", "slip", "mode"})
      derived(fmt::format("{}.{}", what, f.name), fmt::format("an output of '{}'", f.name));
  }
  const auto own = [&](const std::string& output, const std::string& name, const std::string& kind, Span span) {
    const auto found = taken.find(output);
    if (found == taken.end()) return;
    source_.fail(span,
                 output == name ? fmt::format("the {} '{}' has the name of an output: {}", kind, name, found->second)
                                : fmt::format("the {} '{}' has an output '{}', which is {} too", kind, name, output,
                                              found->second),
                 fmt::format("give it another name, such as {}", output == name ? name + "_1" : name + "_body"));
  };
  for (const Coordinate& c : model_.coordinates) own(c.name, c.name, "coordinate", c.span);
  for (const State& z : model_.states) {
    if (!z.integral) own(z.name, z.name, "state", z.span);
  }
  for (const Definition& d : model_.definitions) {
    if (!d.vector) own(d.name, d.name, "definition", d.span);
  }
  for (std::size_t k = 1; k <= 3; ++k) {
    for (std::size_t i = 1; i < model_.places.size(); ++i) {
      const Place& place = model_.places[i];
      for (const char* what : {"position", "velocity"})
        own(fmt::format("{}.{}{}", place.name, what, k), place.name, "place", place.span);
    }
    for (std::size_t i = 1; i < model_.frames.size(); ++i)
      own(fmt::format("{}.omega{}", model_.frames[i].name, k), model_.frames[i].name, "frame", model_.frames[i].span);
  }
}

}  // namespace eomgen::model
