// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/names.hpp"

#include <algorithm>

#include "emit/context.hpp"

namespace eomgen::emit {
namespace {

// Lists of words, in lines.
// clang-format off
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

// Object-like macros of compilers and of headers that a program may include before the emitted ones.
constexpr std::string_view macros[] = {
    "NULL", "EOF", "I", "TRUE", "FALSE", "NAN", "INFINITY", "HUGE", "HUGE_VAL", "HUGE_VALF", "HUGE_VALL", "MAXFLOAT", "DOMAIN",
    "SING", "OVERFLOW", "UNDERFLOW", "PLOSS", "TLOSS", "SNAN", "SNANF", "SNANL", "BUFSIZ", "RAND_MAX", "EXIT_SUCCESS", "EXIT_FAILURE",
    "NDEBUG", "EDOM", "ERANGE", "EILSEQ", "EINTR", "EIO", "ENOMEM", "EINVAL", "EPERM", "EAGAIN", "EBUSY", "EXDEV",
    "BIG_ENDIAN", "LITTLE_ENDIAN", "BYTE_ORDER", "PDP_ENDIAN", "PAGE_SIZE", "PATH_MAX", "NAME_MAX", "PIPE_BUF", "CLOCKS_PER_SEC",
    "MB_CUR_MAX", "math_errhandling", "unix", "linux", "i386", "vax", "sun", "mips", "sparc", "near", "far", "interface", "small",
    "assert", "offsetof", "isnan", "isinf", "signbit", "min", "max", "EOM_DEVICE", "EOM_GPU", "EOM_VERSION",
    "EOM_COMPILED_RUNTIME", "EOM_RUNTIME_INLINE"};

// Prefixes under which headers define macros: M_PI, FP_NAN, DBL_MAX, INT32_MAX, FE_INVALID, ...
constexpr std::string_view macro_prefixes[] = {"M_",   "FP_",   "DBL_", "FLT_",  "LDBL_", "INT", "UINT", "FE_",
                                               "LONG", "ULONG", "LLONG", "CHAR_", "SHRT_", "USHRT", "UCHAR", "SCHAR", "MATH_",
                                               "PRI",  "SCN",   "SIG_", "BUILTIN", "EOM_VERSION_"};

// Types and namespaces of the emitted header.
constexpr std::string_view own[] = {"Real", "State", "Parameter", "Input", "Output", "Reaction", "std", "eom"};

// Names of the runtime, in whose namespace `eom` the emitted header has its own (a test holds this list against lib/eom).
constexpr std::string_view runtime[] = {
    "EINTR", "EISDIR", "ELOOP", "F_DUPFD_CLOEXEC", "O_CLOEXEC", "O_CREAT", "O_EXCL", "O_NOCTTY", "O_NOFOLLOW", "O_RDONLY", "O_RDWR", "O_WRONLY",
    "S_ISCHR", "S_ISDIR", "S_ISREG",  // macros of headers that it includes
    "STDERR_FILENO", "STDIN_FILENO", "STDOUT_FILENO", "StepBound", "AtomicFile",
    "EventAction", "Automatic", "ChangeReason", "MethodChoice", "CompiledBatch", "CompiledBatchJacobian", "CompiledBatchSeries", "CompiledModel", "Complex", "Contact", "ContactMotion", "ContactShape", "Contacts",
    "Crossing", "CsvWriter", "Direction", "Drift", "Eligibility", "EnsembleEnd", "EnsembleOptions", "EnsembleRhs", "EnsembleStart", "ErrorEstimate", "EstimateCost", "EventFunction", "EventLocator", "EventMemory", "EventPoint", "Feature", "Features", "Lu",
    "MethodChange", "MethodInfo", "Mode", "ModeArray", "ModeEntries", "ModeEvent", "ModeLayout", "ModePoint", "ModeResult", "Needs", "NoObserver", "NoProjection", "Options",
    "Outcome", "Plot", "PlotMark", "PlotSeries", "PowerBalance", "Projection", "ProjectionOptions", "ProjectionResult", "Refusal", "Registry", "Result", "Rhs",
    "Run", "StateLayout", "Statistics", "StepEnds", "StepView", "System", "Transition", "Watch", "WatchedSurface", "WithJacobian", "WithTaylor", "all_features", "open_mode", 
    "code_jump", "code_no_convergence", "code_not_finite", "constrained", "is_contact_digit", 
    "contact_digit", "contact_sign", "contact_modes", "contact_states", "contact_values", "contacts", "decimals", "detail", "device", "discrete", "divergence_bound",
    "eligible", "ensemble", "estimate_error", "events", "events_without_progress", "explicit_rk", "expressions", "find_method", "fmi", "hybrid", "implicit", "integrate",
    "integrate_ensemble", "integrate_ensemble_events", "integrate_events", "integrate_modes", "max_charts", "max_contacts", "methods", "modes", "name",
    "no_jacobian_here", "no_time_derivative_here", "outcome_of_abi_code", "plot", "keeps_sliding", "smallest_step_in_ulps", "svg",
    "system_of", "taylor", "to_text", "variational", "with_contact_digit"};

// Keywords of Python, its standard library, and likely imports of a script that uses the module.
constexpr std::string_view python[] = {
    "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del", "elif",
    "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda", "nonlocal", "not", "or",
    "pass", "raise", "return", "try", "while", "with", "yield", "match", "case", "type", "abc", "aifc", "antigravity",
    "argparse", "array", "ast", "asynchat", "asyncio", "asyncore", "atexit", "audioop", "base64", "bdb", "binascii", "binhex",
    "bisect", "builtins", "bz2", "cProfile", "calendar", "cgi", "cgitb", "chunk", "cmath", "cmd", "code", "codecs", "codeop",
    "collections", "colorsys", "compileall", "compression", "concurrent", "configparser", "contextlib", "contextvars", "copy",
    "copyreg", "crypt", "csv", "ctypes", "curses", "dataclasses", "datetime", "dbm", "decimal", "difflib", "dis", "distutils",
    "doctest", "email", "encodings", "ensurepip", "enum", "errno", "faulthandler", "fcntl", "filecmp", "fileinput", "fnmatch",
    "formatter", "fractions", "ftplib", "functools", "gc", "genericpath", "getopt", "getpass", "gettext", "glob", "graphlib",
    "grp", "gzip", "hashlib", "heapq", "hmac", "html", "http", "idlelib", "imaplib", "imghdr", "imp", "importlib", "inspect",
    "io", "ipaddress", "itertools", "json", "keyword", "lib2to3", "linecache", "locale", "logging", "lzma", "macpath",
    "mailbox", "mailcap", "marshal", "math", "mimetypes", "mmap", "modulefinder", "msilib", "msvcrt", "multiprocessing",
    "netrc", "nis", "nntplib", "nt", "ntpath", "nturl2path", "numbers", "opcode", "operator", "optparse", "os", "ossaudiodev",
    "parser", "pathlib", "pdb", "pickle", "pickletools", "pipes", "pkgutil", "platform", "plistlib", "poplib", "posix",
    "posixpath", "pprint", "profile", "pstats", "pty", "pwd", "py_compile", "pyclbr", "pydoc", "pydoc_data", "pyexpat",
    "queue", "quopri", "random", "re", "readline", "reprlib", "resource", "rlcompleter", "runpy", "sched", "secrets",
    "select", "selectors", "shelve", "shlex", "shutil", "signal", "site", "sitecustomize", "smtpd", "smtplib", "sndhdr",
    "socket", "socketserver", "spwd", "sqlite3", "sre_compile", "sre_constants", "sre_parse", "ssl", "stat", "statistics",
    "string", "stringprep", "struct", "subprocess", "sunau", "symbol", "symtable", "sys", "sysconfig", "syslog", "tabnanny",
    "tarfile", "telnetlib", "tempfile", "termios", "test", "textwrap", "this", "threading", "time", "timeit", "tkinter",
    "token", "tokenize", "tomllib", "trace", "traceback", "tracemalloc", "tty", "turtle", "turtledemo", "types", "typing",
    "unicodedata", "unittest", "urllib", "usercustomize", "uu", "uuid", "venv", "warnings", "wave", "weakref", "webbrowser",
    "winreg", "winsound", "wsgiref", "xdrlib", "xml", "xmlrpc", "xxlimited", "xxlimited_35", "xxsubtype", "zipapp", "zipfile",
    "zipimport", "zlib", "zoneinfo", "numpy", "scipy", "matplotlib", "pandas", "sympy", "pip", "setuptools", "pkg_resources"};

constexpr std::string_view javascript[] = {
    "arguments", "async", "await", "debugger", "eval", "exports", "extends", "finally", "function", "globalThis", "implements", "import", "in", "instanceof",
    "let", "location", "module", "null", "of", "package", "require", "self", "super", "top", "undefined", "var", "window", "with", "yield", "document",
    "NaN", "Infinity", "Math", "Object", "Array", "Float32Array", "Float64Array", "fround", "Number", "JSON", "global", "process"};
// clang-format on

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
  // An underscore and a capital, or two underscores, are reserved for the compiler.
  if (name.starts_with("__") || (name.size() > 1 && name[0] == '_' && name[1] >= 'A' && name[1] <= 'Z')) return true;
  if (is_temporary(name)) return true;
  // M_PI is a macro. M_12, an entry of the mass matrix, is not, nor are names with a trailing underscore.
  const auto begins = [&name](std::string_view prefix) {
    return name.starts_with(prefix) && name.find_first_not_of("0123456789_", prefix.size()) != std::string::npos;
  };
  return is_capitals(name) && !name.ends_with('_') &&
         std::any_of(std::begin(macro_prefixes), std::end(macro_prefixes), begins);
}

std::span<const std::string_view> javascript_reserved_words() { return javascript; }

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
  // A trailing underscore does not help if the beginning of the name is reserved.
  const bool of_the_compiler =
      name.size() > 1 && name[0] == '_' && (name[1] == '_' || (name[1] >= 'A' && name[1] <= 'Z'));
  if (of_the_compiler) name = "n" + name;
  while (is_reserved(name) || taken_.contains(name)) name += '_';
  if (name.size() > longest_) {
    const std::string begin = name.substr(0, longest_ - 8);
    do name = begin + '_' + std::to_string(++cut_);
    while (taken_.contains(name));
  }
  taken_.insert(name);
  return name;
}

std::string mangled_id(const std::string& id) {
  std::string name = identifier(id);
  if (name.empty() || name[0] == '_' || (name[0] >= '0' && name[0] <= '9')) name = "model_" + name;
  return is_reserved(name) || is_one_of(name, runtime) ? name + "_" : name;
}

std::string id_beside(const std::string& id, std::span<const std::string_view> taken) {
  const std::string name = mangled_id(id);
  return is_one_of(name, taken) ? name + "_" : name;
}

std::string script_name(const std::string& id) { return id_beside(id, javascript); }

std::string module_name(const std::string& id) { return id_beside(id, python); }

}  // namespace eomgen::emit
