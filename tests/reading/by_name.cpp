// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/by_name.hpp"

#include <optional>
#include <stdexcept>

#include "support/folders.hpp"

namespace eomgen::test {

Sum ByName::operator()(const std::string& name) {
  std::string base = name;
  std::uint8_t order = 0;
  if (name.ends_with("_ddot")) {
    base = name.substr(0, name.size() - 5);
    order = 2;
  } else if (name.ends_with("_dot")) {
    base = name.substr(0, name.size() - 4);
    order = 1;
  }
  using symbolic::SymbolKind;
  if (name == "t") return alphabet_({SymbolKind::time, 0, 0});
  const auto in = [&](const auto& list, SymbolKind kind) -> std::optional<Sum> {
    for (std::uint32_t i = 0; i < list.size(); ++i) {
      if (list[i].name == base) return alphabet_({kind, i, order});
    }
    return std::nullopt;
  };
  const model::Model& model = *m_.model;
  if (const auto found = in(model.parameters, SymbolKind::parameter)) return *found;
  if (const auto found = in(model.coordinates, SymbolKind::coordinate)) return *found;
  if (const auto found = in(model.functions, SymbolKind::function)) return *found;
  if (const auto found = in(model.inputs, SymbolKind::input)) return *found;
  throw std::logic_error("no symbol " + name);
}

System::System(const model::Model& read)
    : model(read), mechanics(mechanics::build_mechanics(model)), symbol(mechanics) {}

Sum sin(const Sum& x) { return reading::call(symbolic::Op::sin, {x}); }
Sum cos(const Sum& x) { return reading::call(symbolic::Op::cos, {x}); }
Sum sqrt(const Sum& x) { return reading::power(x, reading::Rational(1) / 2); }
Sum square(const Sum& x) { return x * x; }
Sum half(const Sum& x) { return reading::Rational(1) / 2 * x; }
Sum over(const Sum& a, const Sum& b) { return a * reading::power(b, -1); }
bool same(const Sum& a, const Sum& b) { return reading::zero_test(a - b) == reading::ZeroTestResult::proven; }
std::string shipped(const std::string& name) { return test::source_folder() + "/models/" + name + ".toml"; }

}  // namespace eomgen::test
