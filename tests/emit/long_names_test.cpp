// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the greatest length, everywhere and in every target: no comment or line of code may break where it is
// folded, and names that differ in their last letter stay apart.
#include <doctest/doctest.h>

#include "emit/target_uses.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

constexpr std::size_t longest = 64;

std::string name(char letter, char last) { return std::string(longest - 1, letter) + last; }

Example with_long_names() {
  std::vector<std::string> parameters;
  for (const char last : {'a', 'b', 'c', 'd', 'e'}) parameters.push_back(name('p', last));
  system::EquationSystem system = cart_pendulum();
  // The statement of a rate and its comment, both of one word, do not fit in a line.
  const system::Output rate{"", system.dag->symbol({symbolic::SymbolKind::coordinate, 0, 1}),
                            system::OutputKind::kinetic};
  system.outputs.push_back(rate);
  for (std::size_t i = 0; i < system.outputs.size(); ++i)
    system.outputs[i].name = name('y', static_cast<char>('a' + i));
  Example e = example(name('m', 'm'), system, {name('q', 'a'), name('q', 'b')}, parameters, {name('u', 'u')});
  e.context.title = name('t', 't') + " " + name('t', 'u');
  for (emit::Quantity& parameter : e.context.parameters) parameter.note = name('n', 'n') + " " + name('n', 'o');
  return e;
}

}  // namespace

TEST_CASE("long names: the code of every target compiles and passes its self-test") {
  const Example e = with_long_names();
  for (const emit::TargetEntry& target : emit::targets()) {
    INFO(std::string(target.name));
    const auto use = target_uses().find(target.name);
    REQUIRE((use != target_uses().end()));
    const Folder folder;
    emit::write_files(folder.path, target.emit(e.program, e.context));
    CHECK(use->second(folder.path, e) == "");
  }
}
