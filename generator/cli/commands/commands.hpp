// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/command.hpp"

namespace eomgen::cli {

using Execute = std::function<int(const CommonOptions&)>;

Execute declare_new(Arguments& app);
Execute declare_list(Arguments& app);
Execute declare_import(Arguments& app);
Execute declare_check(Arguments& app);
Execute declare_derive(Arguments& app);
Execute declare_verify(Arguments& app);
Execute declare_emit(Arguments& app);
Execute declare_run(Arguments& app);
Execute declare_equilibria(Arguments& app);
Execute declare_linearize(Arguments& app);
Execute declare_inverse(Arguments& app);
Execute declare_sweep(Arguments& app);
Execute declare_merge(Arguments& app);
Execute declare_report(Arguments& app);
Execute declare_bench(Arguments& app);
Execute declare_stress(Arguments& app);
Execute declare_docs(Arguments& app);
Execute declare_manual(Arguments& app);
Execute declare_completion(Arguments& app);

}  // namespace eomgen::cli
