// SPDX-License-Identifier: GPL-3.0-or-later
// How the files of each target are used, with compilers and interpreters: a table that tests of all targets share.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "emit/examples.hpp"

namespace test_systems {

/// Compiles or loads the files of a target in `folder` and runs their self-test, in double or in single precision. A
/// description of the failure, or empty. An interpreter that is not installed is no failure.
using TargetUse = std::string (*)(const std::string& folder, const Example& e);

/// By the name of the target. A target without an entry fails the tests that use the table.
const std::map<std::string, TargetUse>& target_uses();

/// The command for C11, with a warning for doubles in code of single precision.
const std::vector<std::string>& compile_c();
std::vector<std::string> with(std::vector<std::string> command, const std::vector<std::string>& more);
/// Whether a program is installed: it answers to --version.
bool runs(const char* program);
std::string wrong_c(const std::string& folder, const Example& e);
/// Runs the test of the Rust module `file`; "rustc: .." or "test: .." with the output if it fails.
std::string failed_test(const std::string& folder, const std::string& file);
/// Calls the C++ templates of `header` in namespace `space`; `selftest` is added to their status.
std::string wrong_templates(const std::string& folder, const Example& e, const std::string& header,
                            const std::string& space, const std::string& selftest);

}  // namespace test_systems
