// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/names.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include "emit/context.hpp"

namespace eomgen::emit {
namespace {

constexpr std::string_view keywords[] = {
    "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break", "case", "catch", "char",
    "char8_t", "char16_t", "char32_t", "class", "co_await", "co_return", "co_yield", "compl", "concept", "const",
    "consteval", "constexpr", "constinit", "const_cast", "continue", "decltype", "default", "delete", "do", "double",
    "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false", "float", "for", "friend", "goto", "if",
    "import", "inline", "int", "long", "module", "mutable", "namespace", "new", "noexcept", "not", "not_eq", "nullptr",
    "operator", "or", "or_eq", "private", "protected", "public", "register", "reinterpret_cast", "requires", "restrict",
    "return", "short", "signed", "sizeof", "static", "static_assert", "static_cast", "struct", "switch", "template",
    "this", "thread_local", "throw", "true", "try", "typedef", "typeid", "typename", "typeof", "union", "unsigned",
    "using", "virtual", "void", "volatile", "wchar_t", "while", "xor", "xor_eq", "complex", "imaginary", "noreturn",
    "fortran", "final", "override"};

// Functions that emitted code calls, and variables of the C library.
constexpr std::string_view functions[] = {
    "acos", "asin", "atan", "atan2", "cos", "cosh", "exp", "log", "pow", "sin", "sinh", "sqrt", "tan", "tanh", "abs", "fabs",
    "sincos", "isfinite", "size_t", "signgam", "environ", "timezone", "daylight", "tzname", "program_invocation_name",
    "stdin", "stdout", "stderr", "errno", "main"};

// Macros without arguments, of compilers and of headers that a program of this kind may include before ours.
constexpr std::string_view macros[] = {
    "NULL", "EOF", "I", "TRUE", "FALSE", "NAN", "INFINITY", "HUGE", "HUGE_VAL", "HUGE_VALF", "HUGE_VALL", "MAXFLOAT", "DOMAIN",
    "SING", "OVERFLOW", "UNDERFLOW", "PLOSS", "TLOSS", "SNAN", "SNANF", "SNANL", "BUFSIZ", "RAND_MAX", "EXIT_SUCCESS", "EXIT_FAILURE",
    "NDEBUG", "EDOM", "ERANGE", "EILSEQ", "EINTR", "EIO", "ENOMEM", "EINVAL", "EPERM", "EAGAIN", "EBUSY", "EXDEV",
    "BIG_ENDIAN", "LITTLE_ENDIAN", "BYTE_ORDER", "PDP_ENDIAN", "PAGE_SIZE", "PATH_MAX", "NAME_MAX", "PIPE_BUF", "CLOCKS_PER_SEC",
    "MB_CUR_MAX", "math_errhandling", "unix", "linux", "i386", "vax", "sun", "mips", "sparc", "near", "far", "interface", "small",
    "assert", "offsetof", "isnan", "isinf", "signbit", "min", "max"};

// Prefixes under which headers define macros: M_PI, FP_NAN, DBL_MAX, INT32_MAX, FE_INVALID, ...
constexpr std::string_view macro_prefixes[] = {"M_",   "FP_",   "DBL_", "FLT_",  "LDBL_", "INT", "UINT", "FE_",
                                               "LONG", "ULONG", "LLONG", "CHAR_", "SHRT_", "USHRT", "UCHAR", "SCHAR", "MATH_",
                                               "PRI",  "SCN",   "SIG_", "BUILTIN"};

// Types and namespaces of the emitted header.
constexpr std::string_view own[] = {"Real", "State", "Parameter", "Input", "Output", "Reaction", "std", "eom"};

bool is_one_of(std::string_view name, std::span<const std::string_view> list) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

bool is_temporary(const std::string& name) {  // v1, v2, ...
  return name.size() > 1 && name[0] == 'v' &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_capitals(const std::string& name) {
  return std::none_of(name.begin(), name.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

}  // namespace

bool is_reserved(const std::string& name) {
  for (const auto list : {std::span<const std::string_view>(keywords), std::span<const std::string_view>(functions),
                          std::span<const std::string_view>(macros), std::span<const std::string_view>(own)}) {
    if (is_one_of(name, list)) return true;
  }
  // An underscore and a capital, or two underscores, belong to the compiler.
  if (name.starts_with("__") || (name.size() > 1 && name[0] == '_' && name[1] >= 'A' && name[1] <= 'Z')) return true;
  if (is_temporary(name)) return true;
  // M_PI is a macro; M_12, an entry of the mass matrix, is not, nor is anything with an underscore at the end.
  const auto begins = [&name](std::string_view prefix) {
    return name.starts_with(prefix) && name.find_first_not_of("0123456789_", prefix.size()) != std::string::npos;
  };
  return is_capitals(name) && !name.ends_with('_') &&
         std::any_of(std::begin(macro_prefixes), std::end(macro_prefixes), begins);
}

std::string identifier(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool legal = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    result += legal ? c : '_';
  }
  return result;
}

std::string NameTable::declare(const std::string& wanted) {
  std::string name = identifier(wanted);
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name = "_" + name;
  // What is reserved for how it begins is not freed by an underscore at its end.
  const bool of_the_compiler = name.size() > 1 && name[0] == '_' && (name[1] == '_' || (name[1] >= 'A' && name[1] <= 'Z'));
  if (of_the_compiler) name = "n" + name;
  while (is_reserved(name) || !taken_.insert(name).second) name += '_';
  return name;
}

std::string mangled_id(const std::string& id) {
  std::string name = identifier(id);
  if (name.empty() || name[0] == '_' || (name[0] >= '0' && name[0] <= '9')) name = "model_" + name;
  return is_reserved(name) ? name + "_" : name;
}

}  // namespace eomgen::emit
