// SPDX-License-Identifier: GPL-3.0-or-later
// Batches through compilers: batch_harness.c compares each state with the same state alone.
#include <doctest/doctest.h>

#include "emit/examples.hpp"
#include "emit/shared_library/loaded_batch.hpp"
#include "emit/single_precision.hpp"
#include "error.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

struct Width {
  int lanes;
  std::vector<std::string> flags;
};

/// Register widths that this processor supports; in single precision twice as many lanes.
std::vector<Width> widths(const Example& e) {
  const int twice = e.context.single_error ? 2 : 1;
  const auto asked = [](int lanes) { return fmt::format("-DEOM_BATCH_LANES={}", lanes); };
  std::vector<Width> all{{2 * twice, {asked(2 * twice)}}, {1, {asked(1)}}};
#if defined(__x86_64__) && defined(__GNUC__)
  if (__builtin_cpu_supports("avx2")) all.push_back({4 * twice, {"-mavx2", asked(4 * twice)}});
  if (__builtin_cpu_supports("avx512f")) all.push_back({8 * twice, {"-mavx512f"}});
#endif
  return all;
}

std::vector<Example> in_single(std::vector<Example> all) {
  for (Example& e : all) emit::convert_to_single(e.program, e.context);
  return all;
}

/// Compiles the functions for one state, once for all widths. Returns what the compiler reports.
std::string compile_alone(const std::string& folder, const std::string& name) {
  if (std::filesystem::exists(folder + "/alone.o")) return "";
  return compiler_diagnostics(
      {EOMGEN_TEST_CC, "-std=gnu11", "-O1", "-ffp-contract=off", "-c", "-o", folder + "/alone.o"},
      {folder + "/" + name + ".c"});
}

/// The failure of the batch of these files; empty if every state has the same bits as alone.
std::string wrong(const std::string& folder, const Example& e, const Width& width, const std::string& modes) {
  const std::string name = emit::mangled_id(e.context.id), program = folder + "/use";
  const auto has = [&](const char* function) { return e.program.result_size(function) > 0; };
  std::vector<std::string> command{EOMGEN_TEST_CC,
                                   "-std=gnu11",
                                   "-O1",
                                   "-ffp-contract=off",
                                   "-o",
                                   program,
                                   "-DNAME=" + name,
                                   "-DHEADER=\"" + name + "_batch.h\"",
                                   "-DMODES=" + modes,
                                   fmt::format("-DWIDTH={}", width.lanes),
                                   e.context.single_error ? "-DREAL=float" : "-DREAL=double",
                                   "-I" + folder};
  command.insert(command.end(), width.flags.begin(), width.flags.end());
  for (const auto& [function, define] :
       {std::pair{"prepare", "-DPREPARED"}, {"jac", "-DJAC"}, {"outputs", "-DOUTPUTS"}, {"events", "-DEVENTS"}}) {
    if (has(function)) command.emplace_back(define);
  }
  if (e.program.taylor) command.emplace_back("-DTAYLOR");
  if (const std::string said = compile_alone(folder, name); !said.empty()) return said;
  const std::string said = compiler_diagnostics(
      command, {EOMGEN_TEST_HARNESS, folder + "/" + name + "_batch.c", folder + "/alone.o", "-lm"});
  if (!said.empty()) return said;
  const emit::ProcessResult finished = emit::run_process({program});
  return finished.status == 0 ? "" : fmt::format("line {} of the harness: {}", finished.status, finished.output);
}

std::string wrong(const Example& e, const std::string& modes = "{0}") {
  const Folder folder;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "batch"));
  for (const Width& width : widths(e)) {
    const std::string found = wrong(folder.path, e, width, modes);
    if (!found.empty()) return fmt::format("{} lanes: {}", width.lanes, found);
  }
  return "";
}

}  // namespace

TEST_CASE("batch: every state has the same bits and code as alone, independent of its neighbours, for every width") {
  for (const Example& e : examples()) {
    INFO(e.context.id);
    CHECK(wrong(e) == "");
  }
  for (const Example& e : in_single(examples())) {
    INFO("in single precision ", e.context.id);
    CHECK(wrong(e) == "");
  }
}

TEST_CASE("batch: series of several states with different orders") {
  auto list = {example("chain3", chain(3), {"k", "x", "w"}, {"m1", "a", "b", "l1", "z", "dx", "g"}, {}, {"taylor"}),
               example("cart", cart_pendulum(), {"x", "theta"}, {"M", "m", "l", "g", "c"}, {"F"}, {"taylor", "mass"})};
  for (const Example& e : list) {
    INFO(e.context.id);
    REQUIRE(e.program.taylor);
    CHECK(wrong(e) == "");
  }
}

TEST_CASE("batch: a loaded ensemble library keeps its functions after a move") {
  const Example e =
      example("chain3", chain(3), {"a", "b", "c"}, {"m1", "m2", "m3", "l1", "l2", "l3", "g"}, {}, {"taylor", "jac"});
  std::vector<std::pair<std::string, std::string>> files;
  for (const emit::EmittedFile& file : emit::emit(e.program, e.context, "batch"))
    files.emplace_back(file.name, file.text);
  emit::LoadedBatch loaded = emit::compile_and_load_batch(files, emit::mangled_id(e.context.id), nullptr);
  const emit::LoadedBatch moved = std::move(loaded);
  CHECK((moved.rhs != nullptr));
  CHECK((moved.rhs_prepared != nullptr));
  CHECK((moved.jac != nullptr));
  CHECK((moved.taylor != nullptr));
  CHECK(moved.width >= 1);
}

TEST_CASE("batch: generic code selects the widest registers of the actual processor") {
  const Example two = example("two", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"});
  for (const Example& e : {two, in_single({two}).front()}) {
    const Folder folder;
    emit::write_files(folder.path, emit::emit(e.program, e.context, "batch"));
#ifdef __clang__  // supports one width per file, that of its flags (docs/abi.md)
    const auto lanes = [&](int bits) { return bits / (e.context.single_error ? 32 : 64); };
#else
    const auto lanes = [&](int) {
      int widest = 1;
      for (const Width& width : widths(e)) widest = std::max(widest, width.lanes);
      return widest;
    };
#endif
    CHECK(wrong(folder.path, e, {lanes(128), {}}, "{0}") == "");
#if defined(__x86_64__) && defined(__GNUC__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      CHECK(wrong(folder.path, e, {lanes(256), {"-mavx2", "-mfma"}}, "{0}") == "");
#endif
  }
}

TEST_CASE("batch: a function with thousands of operations is split into parts") {
  constexpr std::uint32_t n = 22;
  std::vector<std::string> coordinates, parameters;
  for (std::uint32_t i = 1; i <= n; ++i) coordinates.push_back(fmt::format("theta{}", i));
  for (const char* of : {"m", "l"}) {
    for (std::uint32_t i = 1; i <= n; ++i) parameters.push_back(fmt::format("{}{}", of, i));
  }
  parameters.push_back("g");
  const Example e = example("long_chain", chain(n), coordinates, parameters, {}, {});
  REQUIRE(e.program.functions[0].code.size() > 3000);
  const Folder folder;
  emit::write_files(folder.path, emit::emit(e.program, e.context, "batch"));
  CHECK(wrong(folder.path, e, widths(e).back(), "{0}") == "");
}

TEST_CASE("batch: its self test detects an entry that is never written, and a wrong lane") {
  const Example e =
      example("two", double_pendulum(), {"theta1", "theta2"}, {"m1", "m2", "l1", "l2", "g"}, {}, {"jac", "taylor"});
  const std::vector<emit::EmittedFile> files = emit::emit(e.program, e.context, "batch");
  const auto status = [&](const std::string& what, const std::string& instead) {
    const Folder folder;
    emit::write_files(folder.path, files);
    std::string code = file_named(files, "_batch.c");
    if (!what.empty()) {
      const std::size_t at = code.find(what);
      REQUIRE(at != std::string::npos);
      code.replace(at, what.size(), instead);
    }
    std::ofstream(folder.path + "/two_batch.c") << code;
    std::ofstream(folder.path + "/use.c")
        << "#include \"two_batch.h\"\nint main(void) { return two_batch_selftest(); }\n";
    const std::string program = folder.path + "/use";
    CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=gnu11", "-O2", "-ffp-contract=off", "-o", program},
                               {program + ".c", folder.path + "/two.c", folder.path + "/two_batch.c", "-lm"}) == "");
    return emit::run_process({program}).status;
  };
  CHECK(status("", "") == 0);
  CHECK(status("\n  two_batch_store(", "\n  if (0) two_batch_store(") != 0);
  CHECK(status("codes[first + k] = code;", "codes[first + k] = code + 1;") != 0);
}

TEST_CASE("batch: hostile names, and every available compiler") {
  const Example two =
      example("two", double_pendulum(), {"two_batch_sincos", "block"}, {"fine", "place", "now", "w_0", "dx"});
  for (const Example& e : {two, in_single({two}).front()}) {
    CHECK(wrong(e) == "");
    const Folder folder;
    emit::write_files(folder.path, emit::emit(e.program, e.context, "batch"));
    const std::string c = folder.path + "/two_batch.c";
    CHECK(compiler_diagnostics({EOMGEN_TEST_CXX, "-std=c++20", "-x", "c++", "-c", "-o", folder.path + "/o"}, {c}) ==
          "");
    if (emit::run_process({"clang", "--version"}).started) {
      CHECK(compiler_diagnostics({"clang", "-std=c11", "-c", "-o", folder.path + "/o"}, {c}) == "");
    }
    CHECK(compiler_diagnostics({EOMGEN_TEST_CC, "-std=c11", "-ffast-math", "-c", "-o", folder.path + "/o"}, {c})
              .find("without -ffast-math") != std::string::npos);
  }
}

TEST_CASE("batch: the output of target c is unchanged") {
  for (const Example& e : examples()) {
    const auto alone = emit::emit(e.program, e.context, "c"), with = emit::emit(e.program, e.context, "batch");
    REQUIRE(with.size() == 4);
    for (std::size_t i = 0; i < alone.size(); ++i) CHECK(with[i].text == alone[i].text);
  }
}
