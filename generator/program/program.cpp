// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/program.hpp"

namespace eomgen::program {

Program::Program() = default;
Program::Program(const Program&) = default;
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(const Program&) = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

}  // namespace eomgen::program
