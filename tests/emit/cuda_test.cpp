// SPDX-License-Identifier: GPL-3.0-or-later
// Target cuda: its host form is compiled and compared with target c and with eom::integrate (cuda_harness.cpp). nvcc
// compiles it if installed.
#include <doctest/doctest.h>

#include "emit/examples.hpp"
#include "error.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

/// Names of the files of the target.
std::vector<std::string> write(const Example& e, const Folder& folder) {
  std::vector<std::string> names;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "c"));
  const auto files = emit::emit(e.program, e.context, "cuda");
  for (const emit::EmittedFile& file : files) names.push_back(file.name);
  emit::write_files(folder.path, files);
  return names;
}

/// Compiles a program, or with `-c` an object, with the runtime.
std::string diagnostics(const std::vector<std::string>& options, const std::vector<std::string>& files) {
  std::vector<std::string> command{EOMGEN_TEST_CXX, "-std=c++20", "-O0", "-ffp-contract=off", "-I" EOMGEN_TEST_LIB};
  command.insert(command.end(), options.begin(), options.end());
  return compiler_diagnostics(command, files);
}

/// The object of eom::integrate, compiled once.
const std::string& runtime_object() {
  static const Folder folder;
  static const std::string object = [] {
    std::string path = folder.path + "/runtime.o";
    CHECK(diagnostics({"-c", "-o", path}, {EOMGEN_TEST_CUDA_HARNESS}) == "");
    return path;
  }();
  return object;
}

std::string wrong_kernel(const Example& e) {
  const Folder folder;
  write(e, folder);
  const std::string name = emit::mangled_id(e.context.id), path = folder.path + "/" + name;
  const std::string of_c = compiler_diagnostics(
      {EOMGEN_TEST_CC, "-std=c11", "-O1", "-ffp-contract=off", "-c", "-o", path + ".o"}, {path + ".c"});
  if (!of_c.empty()) return of_c;
  const std::string said = diagnostics({"-o", folder.path + "/use", "-DNAME=" + name, "-I" + folder.path},
                                       {"-x", "c++", path + "_ensemble.cu", EOMGEN_TEST_CUDA_HARNESS, "-x", "none",
                                        path + ".o", runtime_object(), "-lm"});
  if (!said.empty()) return said;
  const emit::ProcessResult finished = emit::run_process({folder.path + "/use"});
  return finished.status == 0 ? "" : fmt::format("line {} of the harness: {}", finished.status, finished.output);
}

}  // namespace

TEST_CASE("cuda: the host form agrees with C, and members end with the bits of eom::integrate for both orders") {
  for (const Example& e : examples()) {  // with constraints, inputs, and equations without inertia
    if (e.context.id == "pendulum" || e.context.id == "spherical") continue;
    INFO(e.context.id);
    CHECK(wrong_kernel(e) == "");
  }
}

TEST_CASE("cuda: hostile names") {
  CHECK(wrong_kernel(example("device", double_pendulum(), {"Model", "members"},
                             {"EOM_DEVICE", "EOM_GPU", "threadIdx", "rhs", "eom_sincos"})) == "");
}

TEST_CASE("cuda: nvcc compiles it without warnings, if installed") {
  const char* const nvcc = std::filesystem::exists("/usr/local/cuda/bin/nvcc") ? "/usr/local/cuda/bin/nvcc" : "nvcc";
  if (!emit::run_process({nvcc, "--version"}).started) {
    MESSAGE("nvcc is not installed: nothing was compiled for a device");
    return;
  }
  const Folder folder;
  const Example e = example("two", double_pendulum(), {"a", "b"}, {"m1", "m2", "L1", "L2", "g"});
  CHECK(write(e, folder) == std::vector<std::string>{"two.cuh", "two_ensemble.cu", "two_ensemble.h"});
  const emit::ProcessResult finished =
      emit::run_process({nvcc, "-std=c++20", "-O1", "-I" EOMGEN_TEST_LIB, "-ptx", folder.path + "/two_ensemble.cu",
                         "-o", folder.path + "/two.ptx"});
  CHECK(finished.output == "");
  CHECK(finished.status == 0);
}

TEST_CASE("cuda: unsupported features are rejected") {
  const auto said = [](const program::Program& program, const emit::EmissionContext& context) -> std::string {
    try {
      emit::emit(program, context, "cuda");
    } catch (const Error& error) {
      return error.message();
    }
    return "";
  };
  Example e = example("two", double_pendulum(), {"a", "b"}, {"m1", "m2", "L1", "L2", "g"});
  CHECK(said(e.program, e.context) == "");
  emit::EmissionContext with_kink = e.context;
  with_kink.jumps_in_time = true;
  CHECK(said(e.program, with_kink).find("kink in time") != std::string::npos);
  program::Program changed = e.program;
  changed.contacts.emplace_back();
  CHECK(said(changed, e.context).find("contacts") != std::string::npos);
  changed = e.program;
  changed.charts.emplace_back();
  CHECK(said(changed, e.context).find("charts") != std::string::npos);
  changed = e.program;
  changed.taylor.emplace();
  CHECK(said(changed, e.context).find("series") != std::string::npos);
}
