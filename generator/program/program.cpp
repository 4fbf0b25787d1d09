// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/program.hpp"

namespace eomgen::program {

Program::Program() = default;
Program::Program(const Program&) = default;
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(const Program&) = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

bool Program::open_saves_work() const {
  const auto cost_of = [this](std::string_view name) -> std::optional<std::size_t> {
    for (const Function& function : functions)
      if (function.name == name) return function.operations.cost();
    return std::nullopt;
  };
  const std::optional<std::size_t> open = cost_of("rhs_open"), prepared = cost_of("rhs_prepared");
  return open && *open < (prepared ? *prepared : *cost_of("rhs"));
}

}  // namespace eomgen::program
