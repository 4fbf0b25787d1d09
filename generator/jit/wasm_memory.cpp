// SPDX-License-Identifier: GPL-3.0-or-later
// Modules of WebAssembly (wasm_module.hpp) as parts of the running program. The address of a function is its place in
// the program's table of functions.
#include <emscripten.h>

#include <cstdint>
#include <stdexcept>

#include "error.hpp"
#include "jit/encode.hpp"

// clang-format off
EM_JS(int, eomgen_length_of_table, (void), { return wasmTable.length; });

// The place of the first function in the table; 0 if the module is refused.
EM_JS(int, eomgen_add_module, (const unsigned char* code, int size), {
  var exported;
  try {
    var compiled = new WebAssembly.Module(HEAPU8.slice(code, code + size));
    exported = new WebAssembly.Instance(compiled, {env: {memory: wasmMemory, table: wasmTable}}).exports;
  } catch (refusal) {
    err("eomgen: " + refusal);
    return 0;
  }
  var names = Object.keys(exported);
  var first = wasmTable.length;
  wasmTable.grow(names.length);
  names.forEach(function(name) { wasmTable.set(first + Number(name), exported[name]); });
  return first;
});

EM_JS(void, eomgen_remove_module, (int first, int count), {
  for (var i = 0; i < count; ++i) wasmTable.set(first + i, null);
});
// clang-format on

namespace eomgen::jit {
namespace {

struct Functions {
  int first = 0, count = 0;
};

}  // namespace

/// `start_` has the functions, `size_` the size of the module.
ExecutableMemory::ExecutableMemory(const unsigned char* code, std::size_t size) : size_(size) {
  const int first = eomgen_add_module(code, static_cast<int>(size));
  if (first == 0)
    throw Error("run", {}, "this system takes no further WebAssembly", "smaller models have smaller modules",
                ErrorKind::tool);
  start_ = new Functions{first, eomgen_length_of_table() - first};
}

ExecutableMemory::~ExecutableMemory() {
  auto* const functions = static_cast<Functions*>(start_);
  eomgen_remove_module(functions->first, functions->count);
  delete functions;
}

const void* ExecutableMemory::at(std::size_t offset) const {
  const auto& functions = *static_cast<const Functions*>(start_);
  if (offset >= static_cast<std::size_t>(functions.count)) throw std::logic_error("a function is outside its module");
  return reinterpret_cast<const void*>(static_cast<std::uintptr_t>(functions.first) + offset);
}

}  // namespace eomgen::jit
