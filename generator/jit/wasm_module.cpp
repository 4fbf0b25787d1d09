// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/wasm_module.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>

namespace eomgen::jit::wasm {
namespace {

constexpr unsigned char end_of_block = 0x0b, no_result = 0x40, of_functions = 0x60, of_references = 0x70;

void append_unsigned(Bytes& to, std::uint32_t value) {
  for (; value >= 0x80; value >>= 7) to.push_back(static_cast<unsigned char>(value | 0x80));
  to.push_back(static_cast<unsigned char>(value));
}

void append_signed(Bytes& to, std::int64_t value) {
  while (value < -64 || value > 63) {
    to.push_back(static_cast<unsigned char>((value & 0x7f) | 0x80));
    value >>= 7;
  }
  to.push_back(static_cast<unsigned char>(value & 0x7f));
}

void append(Bytes& to, const Bytes& bytes) { to.insert(to.end(), bytes.begin(), bytes.end()); }

void append_name(Bytes& to, std::string_view name) {
  append_unsigned(to, static_cast<std::uint32_t>(name.size()));
  to.insert(to.end(), name.begin(), name.end());
}

/// Bytes with their length before them.
void append_sized(Bytes& to, const Bytes& bytes) {
  append_unsigned(to, static_cast<std::uint32_t>(bytes.size()));
  append(to, bytes);
}

void append_section(Bytes& to, unsigned char kind, const Bytes& content) {
  to.push_back(kind);
  append_sized(to, content);
}

}  // namespace

void Code::op(Op op) { bytes_.push_back(static_cast<unsigned char>(op)); }

void Code::indexed(unsigned char op, std::uint32_t index) {
  bytes_.push_back(op);
  append_unsigned(bytes_, index);
}

void Code::load(Op op, std::uint32_t offset) {
  bytes_.push_back(static_cast<unsigned char>(op));
  append_unsigned(bytes_, op == Op::i32_load ? 2 : 3);  // log2 of the alignment
  append_unsigned(bytes_, offset);
}

void Code::integer(std::uint32_t value) {
  bytes_.push_back(0x41);
  append_signed(bytes_, static_cast<std::int32_t>(value));
}

void Code::number(double value) {
  bytes_.push_back(0x44);
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 0; shift < 64; shift += 8) bytes_.push_back(static_cast<unsigned char>(bits >> shift));
}

void Code::sign_bit() {
  bytes_.push_back(0x42);
  append_signed(bytes_, INT64_MIN);
}

void Code::block(std::optional<Type> result) {
  bytes_.push_back(0x02);
  bytes_.push_back(result ? static_cast<unsigned char>(*result) : no_result);
  ++depth_;
}

void Code::begin_if() {
  bytes_.push_back(0x04);
  bytes_.push_back(no_result);
  ++depth_;
}

void Code::begin_else() { bytes_.push_back(0x05); }

void Code::end() {
  bytes_.push_back(end_of_block);
  --depth_;
}

void Code::call_indirect(std::uint32_t type) {
  indexed(0x11, type);
  bytes_.push_back(0);  // the table
}

std::uint32_t Module::type(const Signature& signature) {
  const auto found = std::find(types_.begin(), types_.end(), signature);
  const auto number = static_cast<std::uint32_t>(found - types_.begin());
  if (found == types_.end()) types_.push_back(signature);
  return number;
}

std::size_t Module::add(const Signature& signature, const std::vector<std::pair<std::uint32_t, Type>>& locals,
                        const Code& code) {
  type_of_.push_back(type(signature));
  Bytes& body = bodies_.emplace_back();
  append_unsigned(body, static_cast<std::uint32_t>(locals.size()));
  for (const auto& [count, type] : locals) {
    append_unsigned(body, count);
    body.push_back(static_cast<unsigned char>(type));
  }
  append(body, code.bytes());
  return bodies_.size() - 1;
}

Bytes Module::bytes() const {
  Bytes result{0, 'a', 's', 'm', 1, 0, 0, 0}, content;
  append_unsigned(content, static_cast<std::uint32_t>(types_.size()));
  for (const Signature& type : types_) {
    content.push_back(of_functions);
    append_unsigned(content, static_cast<std::uint32_t>(type.parameters.size()));
    for (const Type parameter : type.parameters) content.push_back(static_cast<unsigned char>(parameter));
    append_unsigned(content, type.result ? 1 : 0);
    if (type.result) content.push_back(static_cast<unsigned char>(*type.result));
  }
  append_section(result, 1, content);

  content.clear();  // imports
  append_unsigned(content, 2);
  append_name(content, "env");
  append_name(content, "memory");
  content.insert(content.end(), {0x02, 0x00, 0x00});  // of any size
  append_name(content, "env");
  append_name(content, "table");
  content.insert(content.end(), {0x01, of_references, 0x00, 0x00});
  append_section(result, 2, content);

  content.clear();
  append_unsigned(content, static_cast<std::uint32_t>(type_of_.size()));
  for (const std::uint32_t type : type_of_) append_unsigned(content, type);
  append_section(result, 3, content);

  content.clear();  // exports
  append_unsigned(content, static_cast<std::uint32_t>(bodies_.size()));
  for (std::uint32_t k = 0; k < bodies_.size(); ++k) {
    append_name(content, std::to_string(k));
    content.push_back(0x00);
    append_unsigned(content, k);
  }
  append_section(result, 7, content);

  content.clear();
  append_unsigned(content, static_cast<std::uint32_t>(bodies_.size()));
  for (const Bytes& body : bodies_) append_sized(content, body);
  append_section(result, 10, content);
  return result;
}

}  // namespace eomgen::jit::wasm
