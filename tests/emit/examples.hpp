// SPDX-License-Identifier: GPL-3.0-or-later
// Programs with names and numbers, ready for emission.
#pragma once

#include <fmt/format.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "emit/self_test.hpp"
#include "emit/shared_library/loaded_model.hpp"
#include "emit/shared_library/process.hpp"
#include "emit/targets.hpp"
#include "emit/write_files.hpp"
#include "numeric/numbers.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/environment.hpp"
#include "support/temporary_folder.hpp"

namespace test_systems {

struct Example {
  program::Program program;
  emit::EmissionContext context;
};

inline Example example(const std::string& id, const system::EquationSystem& system,
                       const std::vector<std::string>& coordinates, const std::vector<std::string>& parameters,
                       const std::vector<std::string>& inputs = {},
                       const std::vector<std::string>& with = {"jac", "jac_p", "mass", "constraints", "reactions"}) {
  Example result;
  result.program = build(system, with, true, true);
  emit::EmissionContext& context = result.context;
  context.id = id;
  context.title = "A test";
  context.content_hash = "0123abcd";
  context.verdict = "pass: 20 points, 50 digits";
  for (const std::string& name : coordinates) context.coordinates.push_back({name, "rad", "", 0});
  for (const std::string& name : parameters)
    context.parameters.push_back({name, "kg", "", 0.5 + 0.125 * static_cast<double>(context.parameters.size())});
  for (const std::string& name : inputs) context.inputs.push_back({name, "N", "", 0.25});
  for (std::uint64_t point = 0; point < 3; ++point) {
    auto arguments = arguments_at<cln::cl_R>(system, point);
    emit::TestVector test;
    const auto rounded = [](std::vector<cln::cl_R>& values, std::size_t count) {
      std::vector<double> result_values;
      for (std::size_t i = 0; i < count; ++i) {
        result_values.push_back(cln::double_approx(values[i]));
        values[i] = numeric::exact(result_values.back());
      }
      return result_values;
    };
    test.x = rounded(arguments.x, arguments.x.size());
    test.p = rounded(arguments.p, parameters.size());
    test.u = rounded(arguments.u, inputs.size());
    test.t = cln::double_approx(arguments.t);
    context.tests.push_back(*emit::test_vector(result.program, context, test, point));
  }
  context.start = context.tests[0].x;
  return result;
}

inline std::vector<Example> examples() {
  return {example("pendulum", pendulum(), {"theta"}, {"m", "l", "g"}),
          example("double_pendulum", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"}),
          example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}),
          example("spherical", spherical_pendulum(), {"x", "y", "z"}, {"m", "g", "L0", "a", "w"}),
          example("massless", massless_coordinate(), {"x", "y", "z"}, {"m", "k"})};
}

using Folder = eomgen::test::TemporaryFolder;

using eomgen::test::ScopedEnvironmentVariable;

inline std::string file_named(const std::vector<emit::EmittedFile>& files, const std::string& ending) {
  for (const auto& file : files) {
    if (file.name.ends_with(ending)) return file.text;
  }
  return "";
}

inline const std::vector<std::string>& strict_warning_flags() {
  static const std::vector<std::string> list = {"-Wall",    "-Wextra",      "-Wpedantic",
                                                "-Wshadow", "-Wconversion", "-Werror"};
  return list;
}

/// The messages of the compiler; empty if there are none.
inline std::string compiler_diagnostics(std::vector<std::string> command, const std::vector<std::string>& arguments) {
  command.insert(command.end(), strict_warning_flags().begin(), strict_warning_flags().end());
  command.insert(command.end(), arguments.begin(), arguments.end());
  const emit::ProcessResult finished = emit::run_process(command);
  if (!finished.started) return "not started: " + command[0];
  return finished.status == 0 && finished.output.empty()
             ? ""
             : fmt::format("status {}\n{}", finished.status, finished.output);
}

}  // namespace test_systems
