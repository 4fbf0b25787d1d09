// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/shared_library/build.hpp"
#include "emit/shared_library/loaded_model.hpp"

namespace eomgen::emit {

CompiledModel compile_and_load(const std::string& c_source, const std::string& header, const std::string& name,
                               const std::atomic<bool>* interrupt) {
  Recipe recipe;
  recipe.name = name;
  recipe.files = {{name + ".c", c_source}, {name + ".h", header}};
  // errno is not read, so that sqrt is one instruction. Products and sums are rounded separately, so that every
  // processor computes the same numbers.
  recipe.flags = {"-std=c11", "-O2", "-fno-math-errno", "-ffp-contract=off", "-fPIC", "-shared"};
  recipe.libraries = {"-lm"};
  recipe.what = "emitted code";
  recipe.remedy = "check the compiler (EOMGEN_CC, CC); if it is in order, please report the model";
  recipe.interrupt = interrupt;
  // The library is loaded before it enters the cache: code that fails its self-test is never cached.
  const BuiltLibrary built = build_library(recipe, [&name](const std::string& path) { LoadedModel(path, name); });
  return {LoadedModel(built.path, name), built.path, built.cached, built.seconds, built.folder, built.note};
}

}  // namespace eomgen::emit
