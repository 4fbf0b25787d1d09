// SPDX-License-Identifier: GPL-3.0-or-later
// In: functions as instructions of WebAssembly. Out: the bytes of a module (WebAssembly Core Specification 1.0,
// section 5). It imports the memory and the table of functions of the program, and exports its functions by their
// numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace eomgen::jit::wasm {

enum class Type : std::uint8_t { i32 = 0x7f, f64 = 0x7c };

struct Signature {
  std::vector<Type> parameters;
  std::optional<Type> result;
  bool operator==(const Signature&) const = default;
};

enum class Op : std::uint8_t {
  select = 0x1b,
  i32_load = 0x28,
  f64_load = 0x2b,
  f64_store = 0x39,
  i32_eqz = 0x45,
  i32_eq = 0x46,
  i32_ne = 0x47,
  f64_eq = 0x61,
  f64_ne = 0x62,
  f64_lt = 0x63,
  f64_gt = 0x64,
  f64_ge = 0x66,
  i32_add = 0x6a,
  i32_sub = 0x6b,
  i32_and = 0x71,
  i32_or = 0x72,
  i32_shl = 0x74,
  i64_and = 0x83,
  i64_xor = 0x85,
  f64_abs = 0x99,
  f64_neg = 0x9a,
  f64_sqrt = 0x9f,
  f64_add = 0xa0,
  f64_sub = 0xa1,
  f64_mul = 0xa2,
  f64_div = 0xa3,
  f64_convert_i32_s = 0xb7,
  i64_reinterpret_f64 = 0xbd,
  f64_reinterpret_i64 = 0xbf
};

using Bytes = std::vector<unsigned char>;

/// The instructions of a function, with its last `end`. Local variables are the arguments, then others.
class Code {
 public:
  void op(Op op);
  void get(std::uint32_t local) { indexed(0x20, local); }
  void set(std::uint32_t local) { indexed(0x21, local); }
  void load(Op op, std::uint32_t offset);                        // pops an address
  void store(Op op, std::uint32_t offset) { load(op, offset); }  // pops an address and a value
  void integer(std::uint32_t value);
  void number(double value);
  void sign_bit();  // the integer of 64 bits whose first bit alone is set
  void block(std::optional<Type> result);
  void begin_if();
  void begin_else();
  void end();
  /// Branches to the end of an open block: 0 is the function, 1 the outermost block in it.
  void leave(std::uint32_t block) { indexed(0x0c, depth_ - 1 - block); }
  /// Pops a condition, and branches to the end of an open block, numbered from the innermost.
  void branch_if(std::uint32_t depth) { indexed(0x0d, depth); }
  void call(std::uint32_t function) { indexed(0x10, function); }
  void call_indirect(std::uint32_t type);  // pops the number of the function in the table

  const Bytes& bytes() const { return bytes_; }

 private:
  void indexed(unsigned char op, std::uint32_t index);

  Bytes bytes_;
  std::uint32_t depth_ = 1;  // open blocks, with the function
};

class Module {
 public:
  /// The number of a type of functions.
  std::uint32_t type(const Signature& signature);
  /// `locals`: numbers of further local variables by type, which are 0 at first. Returns the number of the function.
  std::size_t add(const Signature& signature, const std::vector<std::pair<std::uint32_t, Type>>& locals,
                  const Code& code);
  std::size_t size() const { return bodies_.size(); }
  Bytes bytes() const;

 private:
  std::vector<Signature> types_;
  std::vector<std::uint32_t> type_of_;  // by function
  std::vector<Bytes> bodies_;
};

}  // namespace eomgen::jit::wasm
