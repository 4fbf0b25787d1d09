// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/machine_code.hpp"

#include <deque>
#include <eom/modes/mode_array.hpp>
#include <map>
#include <stdexcept>

#include "error.hpp"
#include "jit/assign.hpp"
#include "jit/encode.hpp"
#include "jit/kernels.hpp"
#include "lists.hpp"
#include "program/taylor.hpp"

namespace eomgen::jit {

using program::Function;
using program::Program;

/// Data to which the code refers by address.
struct MachineCode::Parts {
  Constants constants;
  std::vector<double> default_inputs;
  std::deque<FunctionSteps> steps;
  ChartExchange charts;
  PrepareInCharts prepare;
  TaylorSeries taylor;
  std::unique_ptr<ExecutableMemory> memory;
};

namespace {

const Function* find(const Program& program, const std::string& name) { return find_named(program.functions, name); }

}  // namespace

std::string refusal() { return encoder_refusal(); }

/// Collects the functions of a program, then encodes them.
class Generation {
 public:
  Generation(const Program& program, MachineCode::Parts& parts) : program_(program), parts_(parts) {}

  /// The addresses of the functions by their names in the ABI.
  std::map<std::string, const void*> run() {
    programs_.push_back(&program_);
    for (const Program& variant : program_.chart_variants) programs_.push_back(&variant);
    for (const Program* one : programs_) {
      for (const Function& function : one->functions) assign(function, one->free.size());
    }
    for (const program::ChartInfo& chart : program_.charts) {
      assign(chart.to, program_.free.size());
      assign(chart.back, program_.free.size());
    }
    if (program_.taylor) {
      assign(program_.taylor->start, program_.free.size());
      assign(program_.taylor->next, program_.free.size());
    }
    // The constants are complete, and stay where they are.
    for (FunctionSteps& steps : parts_.steps)
      encoder_.function(steps, parts_.constants.values().data(), parts_.default_inputs.data());
    for (const Function& function : program_.functions) add(function);
    if (!program_.charts.empty()) add_chart();
    if (program_.taylor) add_taylor();
    Encoder::Finished finished = encoder_.finish();
    parts_.memory = std::move(finished.memory);
    bind(finished.entries);
    std::map<std::string, const void*> addresses;
    for (const auto& [name, number] : numbers_) addresses[name] = finished.entries.at(number);
    for (FunctionSteps& steps : parts_.steps) steps.steps = {};
    return addresses;
  }

 private:
  void assign(const Function& function, std::size_t free_count) {
    number_of_[&function] = parts_.steps.size();
    parts_.steps.push_back(assign_registers(function, parts_.default_inputs, free_count, parts_.constants));
    const eom::ModeLayout layout = program_.mode_layout();
    for (ModeValue& value : parts_.steps.back().mode_values)
      value.entry = static_cast<std::uint32_t>(value.is_side ? layout.kink(value.index) : value.index / 2);
  }

  void add(const Function& function) {
    const std::string& name = function.name;
    if (program_.charts.empty()) {
      numbers_[name] = number_of_.at(&function);
      return;
    }
    const abi::Function& shape = *abi::find(name);
    if (name == "prepare") {
      numbers_[name] = encoder_.with_context(reinterpret_cast<const void*>(&prepare_in_charts), &parts_.prepare,
                                             shape.inputs, shape.results.size());
    } else if (shape.has_input(abi::Input::mode)) {
      numbers_[name] = encoder_.choice(shape.inputs, shape.results.size(), program_.mode_layout(), cases(name), true);
    } else {
      numbers_[name] = number_of_.at(&function);
      const abi::Function& by_mode = *abi::find(name + "_in");
      numbers_[by_mode.name] =
          encoder_.choice(by_mode.inputs, by_mode.results.size(), program_.mode_layout(), cases(name), false);
    }
  }

  std::vector<ChartCase> cases(const std::string& name) const {
    const bool prepared = abi::find(name)->has_input(abi::Input::prepared);
    std::vector<ChartCase> result;
    std::size_t offset = 0;
    for (const Program* one : programs_) {
      const Function* function = find(*one, name);
      ChartCase entry{one->in_charts, 0, prepared ? offset : 0, false};
      if (function == nullptr) {
        if (!prepared) throw std::logic_error("a chart lacks the function " + name);
        function = find(*one, "rhs");  // this chart has no prepared values
        entry.without_prepared = true;
        entry.prepared_offset = 0;
      }
      entry.function = number_of_.at(function);
      if (prepared) offset += one->result_size("prepare");
      result.push_back(entry);
    }
    return result;
  }

  void add_chart() {
    parts_.charts.states = program_.state_count();
    parts_.charts.first_entry = program_.mode_layout().chart(0);
    const abi::Function& shape = *abi::find("chart");
    numbers_["chart"] = encoder_.with_context(reinterpret_cast<const void*>(&exchange_charts), &parts_.charts,
                                              shape.inputs, shape.results.size());
  }

  void add_taylor() {
    const program::Taylor& taylor = *program_.taylor;
    parts_.taylor.states = program_.state_count();
    parts_.taylor.order_zero_count = taylor.order_zero_count;
    parts_.taylor.product_count = taylor.product_count;
    parts_.taylor.workspace = taylor.workspace_size();
    parts_.taylor.highest_order = static_cast<int>(program::taylor_order(taylor));
    const abi::Function& shape = *abi::find("taylor");
    numbers_["taylor"] = encoder_.with_context(reinterpret_cast<const void*>(&taylor_series), &parts_.taylor,
                                               shape.inputs, shape.results.size());
  }

  /// Gives the parts that call functions their addresses.
  void bind(const std::vector<const void*>& entries) {
    const auto address = [&](const Function& function, auto& to) {
      to = reinterpret_cast<std::remove_reference_t<decltype(to)>>(
          const_cast<void*>(entries.at(number_of_.at(&function))));
    };
    for (const program::ChartInfo& chart : program_.charts) {
      address(chart.to, parts_.charts.to_second.emplace_back());
      address(chart.back, parts_.charts.to_own.emplace_back());
    }
    std::size_t offset = 0;
    for (const Program* one : programs_) {
      const Function* prepare = find(*one, "prepare");
      if (prepare == nullptr || one->result_size("prepare") == 0) continue;
      address(*prepare, parts_.prepare.functions.emplace_back());
      parts_.prepare.offsets.push_back(offset);
      offset += one->result_size("prepare");
    }
    if (!program_.taylor) return;
    address(program_.taylor->start, parts_.taylor.start);
    address(program_.taylor->next, parts_.taylor.next);
  }

  const Program& program_;
  MachineCode::Parts& parts_;
  Encoder encoder_;
  std::vector<const Program*> programs_;  // in the charts of the model, then in others
  std::map<const Function*, FunctionNumber> number_of_;
  std::map<std::string, FunctionNumber> numbers_;
};

MachineCode::MachineCode(const Program& program, std::span<const double> default_inputs)
    : parts_(std::make_unique<Parts>()) {
  if (const std::string reason = refusal(); !reason.empty())
    throw Error("run", {}, "there is no machine code without a compiler: " + reason,
                "--tier compiled uses the C compiler", ErrorKind::tool);
  parts_->default_inputs.assign(default_inputs.begin(), default_inputs.end());
  const std::map<std::string, const void*> addresses = Generation(program, *parts_).run();
  each([&](const char* name, auto& pointer) {
    if (const auto found = addresses.find(name); found != addresses.end())
      pointer = reinterpret_cast<std::remove_reference_t<decltype(pointer)>>(const_cast<void*>(found->second));
  });
}

MachineCode::~MachineCode() = default;
MachineCode::MachineCode(MachineCode&&) noexcept = default;
MachineCode& MachineCode::operator=(MachineCode&&) noexcept = default;

std::size_t MachineCode::bytes() const { return parts_->memory->size(); }

}  // namespace eomgen::jit
