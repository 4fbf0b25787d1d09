// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/command.hpp"

namespace eomgen::cli {

using Execute = std::function<int(const Common&)>;

Execute declare_new(CLI::App& app);
Execute declare_list(CLI::App& app);
Execute declare_check(CLI::App& app);
Execute declare_derive(CLI::App& app);
Execute declare_verify(CLI::App& app);
Execute declare_emit(CLI::App& app);
Execute declare_run(CLI::App& app);
Execute declare_equilibria(CLI::App& app);
Execute declare_linearize(CLI::App& app);
Execute declare_inverse(CLI::App& app);
Execute declare_sweep(CLI::App& app);
Execute declare_merge(CLI::App& app);
Execute declare_report(CLI::App& app);
Execute declare_bench(CLI::App& app);
Execute declare_stress(CLI::App& app);

}  // namespace eomgen::cli
