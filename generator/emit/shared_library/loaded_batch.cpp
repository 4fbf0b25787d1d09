// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/shared_library/loaded_batch.hpp"

#include <dlfcn.h>

#include <utility>

#include "emit/shared_library/build.hpp"
#include "error.hpp"

namespace eomgen::emit {
namespace {

/// Flags for the widest registers of this processor.
std::vector<std::string> flags_of_processor() {
#if defined(__x86_64__) && defined(__GNUC__)
  if (__builtin_cpu_supports("avx512f")) return {"-mavx512f"};
  if (__builtin_cpu_supports("avx2")) return {"-mavx2", "-DEOM_BATCH_LANES=4"};  // compiles this width only
#endif
  return {};
}

}  // namespace

LoadedBatch::LoadedBatch(const std::string& path, const std::string& name) : model(path, name) {
  handle_.reset(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL));
  const auto find = [&](const char* what) {
    return handle_ == nullptr ? nullptr : ::dlsym(handle_.get(), (name + what).c_str());
  };
  rhs = reinterpret_cast<BatchFunction>(find("_rhs_batch"));
  rhs_prepared = reinterpret_cast<PreparedBatchFunction>(find("_rhs_prepared_batch"));
  jac = reinterpret_cast<BatchJacobian>(find("_jac_batch"));
  taylor = reinterpret_cast<BatchSeries>(find("_taylor_batch"));
  const auto width_of = reinterpret_cast<int (*)()>(find("_batch_width"));
  if (width_of != nullptr) width = width_of();
  const auto selftest = reinterpret_cast<int (*)()>(find("_batch_selftest"));
  const bool whole = rhs != nullptr && width_of != nullptr && selftest != nullptr &&
                     (model.rhs_prepared == nullptr || rhs_prepared != nullptr);
  if (whole && selftest() == 0) return;
  throw Error(
      "compile", {},
      whole ? "a compiled batch differs from its single states: " + path : "compiled code lacks batches: " + path,
      "remove the cache folder (EOMGEN_CACHE_DIR, or ~/.cache/eomgen) and try again; without --ensemble no "
      "batch is needed",
      ErrorKind::tool);
}

void LoadedBatch::Close::operator()(void* handle) const { ::dlclose(handle); }

LoadedBatch compile_and_load_batch(const std::vector<std::pair<std::string, std::string>>& files,
                                   const std::string& name, const std::atomic<bool>* interrupt) {
  Recipe recipe;
  recipe.name = name;
  recipe.files = {{name + "_all.c", "#include \"" + name + ".c\"\n#include \"" + name + "_batch.c\"\n"}};
  recipe.files.insert(recipe.files.end(), files.begin(), files.end());
  recipe.flags = {"-std=c11", "-O2", "-fno-math-errno", "-ffp-contract=off", "-fPIC", "-shared"};
  for (const std::string& flag : flags_of_processor()) recipe.flags.push_back(flag);
  recipe.libraries = {"-lm"};
  recipe.what = "emitted batches";
  recipe.remedy = "check the compiler (EOMGEN_CC, CC); if it is in order, please report the model";
  recipe.interrupt = interrupt;
  const BuiltLibrary built = build_library(recipe, [&name](const std::string& path) { LoadedBatch(path, name); });
  LoadedBatch loaded(built.path, name);
  loaded.folder = built.folder;
  return loaded;
}

}  // namespace eomgen::emit
