// SPDX-License-Identifier: GPL-3.0-or-later
// Target batch: NAME_batch.c and NAME_batch.h in addition to NAME.c and NAME.h. The functions of the C ABI for many
// states as structures of arrays. States are computed in the lanes of SIMD registers, with the same bits as each state
// alone.
#include <fmt/format.h>

#include <algorithm>
#include <eom/modes/contact_state.hpp>
#include <set>

#include "emit/batch/taylor_lanes.hpp"
#include "emit/kernels.hpp"
#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/parts.hpp"
#include "emit/signature.hpp"
#include "emit/targets.hpp"
#include "emit/text.hpp"
#include "error.hpp"
#include "program/internal_functions.hpp"
#include "program/taylor.hpp"
#include "skeletons/batch_model_batch_c.hpp"
#include "skeletons/batch_model_batch_h.hpp"

namespace eomgen::emit {
namespace {

// Limit of the numbers of one block, which are on the stack: all entries and results of a state together.
constexpr std::size_t max_numbers = 8192;

// The arrays of a block, in the order of `from`.
struct Array {
  Slot slot;
  const char* name;  // of the argument; `own`: flag for one array per state
  const char* own;
};
constexpr Array arrays[] = {
    {Slot::time, "t", "own_time"},         {Slot::state, "x", nullptr},      {Slot::parameter, "p", "own_parameters"},
    {Slot::prepared, "w", "own_prepared"}, {Slot::input, "u", "own_inputs"}, {Slot::vector, "v", nullptr}};

class File {
 public:
  File(const program::Program& program, const EmissionContext& context)
      : program_(program),
        context_(context),
        name_(mangled_id(context.id)),
        prefix_(name_ + "_batch_"),
        names_(model_names(program, context)) {
    dialect_ = lane_dialect(single(), prefix_);
    NameTable table;
    for (const auto* list :
         {&names_.state, &names_.contacts, &names_.parameters, &names_.inputs, &names_.sides, &names_.vector}) {
      for (const std::string& name : *list) table.declare(name);
    }
    for (std::size_t i = 0; i < program.prepared_count(); ++i)
      names_.prepared.push_back(table.declare(fmt::format("w_{}", i)));
  }

  std::vector<EmittedFile> run() {
    for (const Function& function : program_.functions) add(function);
    if (program_.taylor) add_taylor();
    std::vector<std::pair<std::string, std::string>> values = {
        {"banner", banner(program_, context_, "/* ", " * ", " */")},
        {"name", name_},
        {"prefix", prefix_},
        {"library", library()},
        {"mode_room", std::to_string(std::max<std::size_t>(1, program_.mode_layout().size()))},
        {"contact_states", std::to_string(eom::contact_states)},
        {"sincos", packs_ ? sincos() : ""},
        {"names", named()},
        {"state_count", std::to_string(program_.state_count())},
        {"parameter_count", std::to_string(context_.parameters.size())},
        {"states", room(Slot::state)},
        {"parameters", room(Slot::parameter)},
        {"prepared", room(Slot::prepared)},
        {"inputs", room(Slot::input)},
        {"vector", room(Slot::vector)},
        {"default_inputs", default_inputs()},
        {"start_time", dialect_.value(context_.start_time)},
        {"order", program_.taylor ? name_ + "_taylor_order" : "0"},
        {"prepare", program_.prepared_count() > 0 ? fmt::format("    {}_prepare(p, w);\n", name_) : ""}};
    const std::vector<std::pair<std::string, std::string>> numbers = lane_template_values(single());
    values.insert(values.end(), numbers.begin(), numbers.end());
    return {{name_ + "_batch.c", render_template(skeleton::batch_model_batch_c, values, defined_)},
            {name_ + "_batch.h", render_template(skeleton::batch_model_batch_h, values, declared_)}};
  }

 private:
  bool single() const { return context_.single_error.has_value(); }
  /// Entries of one state. Without a function, v has those of the longest one.
  std::size_t entries(const Array& array, const std::string& function = {}) const {
    switch (array.slot) {
      case Slot::vector:
        return function.empty() ? program::vector_size(program_) : program::vector_size(function, program_);
      case Slot::time: return 1;
      case Slot::state: return program_.state_count();
      case Slot::parameter: return context_.parameters.size();
      case Slot::prepared: return program_.prepared_count();
      default: return context_.inputs.size();
    }
  }

  /// Size of an array of the self test, which is never empty.
  std::string room(Slot slot) const {
    for (const Array& array : arrays) {
      if (array.slot == slot) return std::to_string(std::max<std::size_t>(1, entries(array)));
    }
    return "1";
  }
  std::string default_inputs() const {
    return context_.inputs.empty() ? "0" : joined(values_of(context_.inputs), dialect_.value);
  }

  void add(const Function& function) {
    const bool gives =
        std::any_of(function.results.begin(), function.results.end(), [](const auto& r) { return !r.entries.empty(); });
    if (!gives) return;
    std::vector<std::pair<std::string, std::size_t>> results;
    for (const program::Result& result : function.results) {
      if (!result.is_test()) results.emplace_back(result.name, result.entries.size());
    }
    const std::vector<Argument> list = abi_arguments(function.name);
    if (!fits(function.name, list, results)) return;
    add(function.name, list, results,
        block_function(function.name, print_function(function, names_, context_, dialect_)));
  }
  void add_taylor() {
    const std::vector<Argument> list = abi_arguments("taylor");
    const std::vector<std::pair<std::string, std::size_t>> results{
        {list.back().name, program_.state_count() * (program::taylor_order(*program_.taylor) + 1)}};
    if (!fits("taylor", list, results) || !taylor_fits_lanes(*program_.taylor, program_.state_count())) return;
    for (const char* name : {"taylor_sums", "taylor_block"}) name_for_width(name);
    add("taylor", list, results,
        taylor_block(program_, names_, context_, dialect_,
                     [this](const std::string& name, const FunctionText& text) { return block_function(name, text); }));
  }
  void add(const std::string& function, const std::vector<Argument>& list,
           const std::vector<std::pair<std::string, std::size_t>>& results, const std::string& block) {
    const std::string head =
        wrapped(fmt::format("int {}_{}_batch({})", name_, function, batch_arguments(list)), "    ");
    declared_.push_back({{"purpose", function_purpose(function)}, {"prototype", head}});
    defined_.push_back({{"adaptor", adaptor(function, list)},
                        {"kernel", kernel(function, block)},
                        {"many", driver(function, list, results)},
                        {"entry", entry(function, list, head)},
                        {"check_name", fmt::format("{}{}_agrees", prefix_, function)},
                        {"check", check(function, list, results)}});
  }
  bool fits(const std::string& function, const std::vector<Argument>& list,
            const std::vector<std::pair<std::string, std::size_t>>& results) const {
    std::size_t numbers = 0;
    for (const Array& array : arrays) numbers += takes(list, array.slot) ? entries(array, function) : 0;
    for (const auto& [name, size] : results) numbers += size;
    return numbers <= max_numbers;
  }

  static bool takes(const std::vector<Argument>& list, Slot slot) {
    return std::any_of(list.begin(), list.end(), [&](const Argument& a) {
      return (a.kind == Argument::Kind::number || a.kind == Argument::Kind::input) && a.slot == slot;
    });
  }

  static bool is_integer(const Argument& a) {
    return a.kind == Argument::Kind::mode || a.kind == Argument::Kind::integer;
  }
  std::string batch_arguments(const std::vector<Argument>& list) {
    std::string inputs, results;
    for (const Argument& a : list) {
      if (a.kind == Argument::Kind::result)
        results += fmt::format("{}* {}, ", dialect_.lane_type, a.name);
      else
        inputs += fmt::format("const {}* {}, ", is_integer(a) ? "int" : dialect_.lane_type, a.name);
    }
    return "size_t count, size_t stride, " + inputs + "int own, " + results + "int* codes";
  }

  /// Prints the function for the lanes of one block.
  std::string block_function(const std::string& function, const FunctionText& text) {
    const std::string block = name_for_width(function + "_block"),
                      arguments =
                          fmt::format("const struct {}block* {}, size_t {}", prefix_, text.block, text.block_index),
                      handed = fmt::format("{}, {}", text.block, text.block_index);
    std::string result;
    for (std::size_t k = 0; k < text.parts.size(); ++k) {
      const std::string part = name_for_width(fmt::format("{}_part{}", function, k + 1));
      result += fmt::format("__attribute__((noinline))\nstatic int {}({}, {}* {})\n{{\n{}}}\n\n", part, arguments,
                            dialect_.real, text.work, text.parts[k]);
    }
    const std::string body =
        text.parts.empty() ? text.body : part_calls(prefix_ + function, text, handed, dialect_.real);
    packs_ = packs_ || text.packs > 0;
    library_.insert(text.library.begin(), text.library.end());
    return result + fmt::format("{}INLINE int {}({})\n{{\n{}}}\n\n", prefix_, block, arguments, body);
  }
  std::string kernel(const std::string& function, const std::string& block) {
    return fmt::format(R"(#if {1}WIDTH > 1
{2}static size_t {0}(const struct {1}block* block, size_t blocks)
{{
  size_t now;
  for (now = 0; now < blocks && {0}_block(block, now) == 0; ++now) {{
  }}
  return now;
}}
#endif

)",
                       name_for_width(function), prefix_, block);
  }

  std::string adaptor(const std::string& function, const std::vector<Argument>& list) const {
    std::string handed;
    std::size_t results = 0;
    for (const Argument& a : list) {
      handed += handed.empty() ? "" : ", ";
      if (a.kind == Argument::Kind::result)
        handed += fmt::format("state->to[{}]", results++);
      else if (is_integer(a))
        handed += "state->" + a.name;
      else
        handed += fmt::format("{}state->from[{}]", a.kind == Argument::Kind::number ? "*" : "", place_of(a.slot));
    }
    return fmt::format("\nstatic int {0}{1}_alone(const struct {0}state* state)\n{{\n{2}\n}}\n", prefix_, function,
                       wrapped(fmt::format("  return {}_{}({});", name_, function, handed), "      "));
  }
  static std::size_t place_of(Slot slot) {
    return static_cast<std::size_t>(
        std::find_if(std::begin(arrays), std::end(arrays), [slot](const Array& a) { return a.slot == slot; }) -
        std::begin(arrays));
  }

  /// Prints NAME_FUNCTION_batch for one register width.
  std::string driver(const std::string& function, const std::vector<Argument>& list,
                     const std::vector<std::pair<std::string, std::size_t>>& results) {
    std::string body = fmt::format("  struct {}call call;\n", prefix_), numbers;
    const bool inputs = takes(list, Slot::input) && !context_.inputs.empty();
    if (inputs) {
      body += wrapped(fmt::format("  static const {} standing[] = {{{}}};", dialect_.lane_type, default_inputs()),
                      "      ") +
              "\n";
    }
    const auto size = [&](std::size_t count) {
      if (count > 0) numbers += (numbers.empty() ? "" : " + ") + std::to_string(count);
      return count;
    };
    std::string fill = fmt::format(
        "  memset(&call, 0, sizeof call);\n#if {0}WIDTH > 1\n  call.kernel = {0}{1};\n#endif\n"
        "  call.one = {0}{1}_alone;\n",
        prefix_, function);
    for (std::size_t k = 0; k < std::size(arrays); ++k) {
      const Array& array = arrays[k];
      if (!takes(list, array.slot)) continue;
      const bool input = array.slot == Slot::input;
      const std::size_t count = size(entries(array, function));
      if (input && !inputs) {
        fill += "  (void)u;\n";
        continue;
      }
      fill += fmt::format("  call.from[{}] = {};\n  call.entries[{}] = {};\n", k,
                          input ? "u ? u : standing" : array.name, k, count);
      const std::string own =
          array.own == nullptr ? "1" : fmt::format("{}(own & {}_{}) != 0", input ? "u && " : "", name_, array.own);
      fill += fmt::format("  call.own[{}] = {};\n", k, own);
    }
    for (const Argument& a : list) {
      if (a.kind == Argument::Kind::mode)
        fill += fmt::format(
            "  call.mode = mode;\n  call.modes = {};\n  call.own_modes = mode && (own & {}_own_modes) != 0;\n",
            program_.mode_layout().size(), name_);
      if (a.kind == Argument::Kind::integer)
        fill += fmt::format("  call.order = order;\n  call.own_orders = (own & {}_own_orders) != 0;\n", name_);
    }
    for (std::size_t r = 0; r < results.size(); ++r) {
      fill += fmt::format("  call.to[{0}] = {1};\n  call.results[{0}] = {2};\n", r, results[r].first,
                          size(results[r].second));
    }
    if (function == "taylor") fill += rows_asked_for();
    body +=
        fmt::format("  {} room[({}WIDTH + 1)*({})];\n", dialect_.lane_type, prefix_, numbers.empty() ? "1" : numbers);
    const std::string head =
        wrapped(fmt::format("static int {}({})", name_for_width(function + "_many"), batch_arguments(list)), "    ");
    return fmt::format("{}\n{{\n{}{}  return {}run(&call, count, stride, room, codes);\n}}\n", head, body, fill,
                       prefix_);
  }

  /// Coefficients up to the highest order that a state requests.
  std::string rows_asked_for() const {
    return fmt::format(R"(  {{
    int highest = 0;
    size_t s;
    for (s = 0; s < (call.own_orders ? count : 1); ++s)
      if (order[s] > highest && order[s] <= {0}_taylor_order) highest = order[s];
    call.results[0] = {1}*((size_t)highest + 1);
  }}
)",
                       name_, program_.state_count());
  }

  std::string entry(const std::string& function, const std::vector<Argument>& list, const std::string& head) const {
    std::string inputs, results;
    for (const Argument& a : list) (a.kind == Argument::Kind::result ? results : inputs) += a.name + ", ";
    return fmt::format("{}\n{{\n{}\n}}\n", head,
                       wrapped(fmt::format("  {}FOR_WIDTH({}_many, (count, stride, {}own, {}codes));", prefix_,
                                           function, inputs, results),
                               "      "));
  }

  /// The comparison of the self test with the function of one state.
  std::string check(const std::string& function, const std::vector<Argument>& list,
                    const std::vector<std::pair<std::string, std::size_t>>& results) const {
    std::string declared, unset, batch, sizes, handed, size = fmt::format("1 + {}", room(Slot::state));
    for (const Slot slot : {Slot::parameter, Slot::prepared, Slot::input, Slot::vector}) size += " + " + room(slot);
    for (std::size_t r = 0; r < 3; ++r) {
      const std::size_t count = r < results.size() ? results[r].second : 0;
      batch += fmt::format("{}{}", r == 0 ? "" : ", ", r < results.size() ? fmt::format("y{}", r + 1) : "0");
      sizes += fmt::format("{}{}", r == 0 ? "" : ", ", count);
      if (r >= results.size()) continue;
      size += fmt::format(" + {}", count);
      declared +=
          fmt::format("{}y{}[{}*{}SAMPLES]", r == 0 ? "" : ", ", r + 1, std::max<std::size_t>(1, count), prefix_);
      unset += fmt::format("  {0}unset(y{1}, {2}*{0}SAMPLES);\n", prefix_, r + 1, count);
    }
    std::size_t result = 0;
    for (const Argument& a : list) {
      if (a.kind == Argument::Kind::result) {
        if (result == 0) handed += "all, ";
        handed += fmt::format("y{}, ", ++result);
      } else {
        handed += fmt::format("samples->{}, ", is_integer(a) ? a.name : arrays[place_of(a.slot)].name);
      }
    }
    return fmt::format(R"(static int {0}{1}_agrees(struct {0}samples* samples)
{{
  enum {{
    all = {2}_own_time | {2}_own_parameters | {2}_own_inputs | {2}_own_modes | {2}_own_prepared | {2}_own_orders
  }};
  {3} {4}, room[{5}];
  {3}* const batch[3] = {{{6}}};
  const size_t results[3] = {{{7}}};
{8}{9}
  return {0}compare({0}{1}_alone, samples, batch, results, room);
}}
)",
                       prefix_, function, name_, dialect_.lane_type, declared, size, batch, sizes, unset,
                       wrapped(fmt::format("  {0}_{1}_batch({2}SAMPLES, {2}SAMPLES, {3}samples->codes);", name_,
                                           function, prefix_, handed),
                               "      "));
  }

  /// Registers a name that differs for each register width.
  std::string name_for_width(const std::string& name) {
    for_width_.insert(name);
    return prefix_ + name;
  }
  std::string named() const {
    std::set<std::string> names = for_width_;
    names.insert(library_.begin(), library_.end());
    names.insert({"lanes",  "mask",        "bits",   "memory",       "load",         "at",    "store", "all",
                  "select", "abs",         "sign",   "every",        "whole",        "place", "to",    "side",
                  "slides", "normal_sign", "sincos", "sincos_lanes", "lane_by_lane", "run"});
    std::string text;
    for (const std::string& name : names) text += fmt::format("#define {0}{1} {0}NAMED({1})\n", prefix_, name);
    return text;
  }

  std::string sincos() const {
    constexpr const char* together = R"(
/* Sines and cosines of the lanes of one angle, valid up to {1}. Adds |angle| to `reach`; lanes in which it stays below
 * the limit are valid. */
{0}INLINE void {0}sincos({0}lanes angle, {0}lanes* sine, {0}lanes* cosine, {0}lanes* reach)
{{
  {0}lanes size;
  {0}sincos_lanes(&angle, &size, sine, cosine);
  *reach += size;
}}
)";
    return sincos_lanes(prefix_, "static inline", "", single()) +
           fmt::format(together, prefix_, single() ? 2048 : 65536);
  }

  std::string library() const {
    std::string text;
    for (const std::string& function : library_) {
      const bool two = function == "pow" || function == "atan2";
      const std::string arguments =
          two ? fmt::format("{0}lanes a, {0}lanes b", prefix_) : fmt::format("{}lanes a", prefix_);
      text += fmt::format(
          "{0}INLINE {0}lanes {1}({2})\n{{\n  for (int k = 0; k < {0}WIDTH; ++k) a[k] = {3}({4});\n  return a;\n}}\n\n",
          prefix_, prefix_ + function, arguments, function + (single() ? "f" : ""), two ? "a[k], b[k]" : "a[k]");
    }
    return text;
  }

  const program::Program& program_;
  const EmissionContext& context_;
  std::string name_, prefix_;
  ModelNames names_;
  Dialect dialect_;
  bool packs_ = false;
  std::set<std::string> library_, for_width_;
  std::vector<std::vector<std::pair<std::string, std::string>>> defined_, declared_;
};

}  // namespace

std::vector<EmittedFile> emit_batch(const program::Program& program, const EmissionContext& context) {
  if (!program.charts.empty()) {
    throw Error("emit", {}, "the target batch does not support charts yet",
                "use the target c or cpp, or leave --with charts out");
  }
  std::vector<EmittedFile> files = emit_c(program, context);
  for (EmittedFile& file : File(program, context).run()) files.push_back(std::move(file));
  return files;
}

}  // namespace eomgen::emit
