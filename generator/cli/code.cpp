// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/code.hpp"

#include <algorithm>
#include <stdexcept>

#include "cli/interrupt.hpp"
#include "cli/output.hpp"
#include "error.hpp"
#include "program/kinks.hpp"
#include "program/taylor.hpp"

namespace eomgen::cli {

CompiledCode::CompiledCode(emit::Compiled compiled, const program::Program& program)
    : compiled_(std::move(compiled)),
      outputs_(program.outputs),
      kinks_(program.kinks),
      free_(program.free),
      integrals_(program.integrals.size()),
      prepared_(program.prepared_count()),
      active_(program.active_constraints),
      holonomic_(program.holonomic) {
  if (program.taylor) taylor_order_ = static_cast<int>(program::taylor_order(*program.taylor));
  for (const program::ContactInfo& contact : program.contacts) contacts_.push_back({contact, contact.name, 0});
  for (const program::Program& second : program.second) {
    own_outputs_.push_back({second.in_charts, {}});
    for (const program::Function& function : second.functions) {
      if (function.name != "outputs") continue;
      for (std::uint32_t i = 0; i < outputs_.size(); ++i) {
        if (std::find(function.places.begin(), function.places.end(), i) == function.places.end()) own_outputs_.back().outputs.push_back(i);
      }
    }
  }
}

verify::CompiledForm CompiledCode::form() const {
  const emit::RhsFunction rhs = compiled_.model.rhs;
  const emit::PrepareFunction prepare = compiled_.model.prepare;
  const emit::PreparedRhsFunction rhs_prepared = compiled_.model.rhs_prepared;
  const std::size_t size = 2 * free_.size() + integrals_;
  return {"emitted code", [rhs, prepare, rhs_prepared, size, prepared = prepared_](double t, const std::vector<double>& x, const std::vector<double>& p,
                                      const std::vector<double>& u, int mode) -> std::optional<std::vector<double>> {
            std::vector<double> dx(size);
            std::vector<double> w(prepared);
            // What `run` integrates; the self test has compared it with `rhs`.
            const int code = prepared == 0 ? rhs(t, x.data(), p.data(), u.data(), mode, dx.data())
                             : prepare(p.data(), w.data()) != 0
                                 ? 1
                                 : rhs_prepared(t, x.data(), p.data(), w.data(), u.data(), mode, dx.data());
            if (code != 0) return std::nullopt;
            return dx;
          }};
}

run::Code CompiledCode::for_run() const {
  const emit::LoadedModel& model = compiled_.model;
  run::Code code{model.rhs, model.prepare, model.rhs_prepared, prepared_, model.outputs, model.events, model.jac, model.mass, model.constraints, outputs_, free_, integrals_, active_, holonomic_};
  code.taylor = model.taylor;
  code.jac_p = model.jac_p;
  code.momenta = model.momenta;
  code.taylor_order = taylor_order_;
  code.kinks = kinks_;
  code.contacts = contacts_;
  code.first_kink_bit = program::first_kink_bit;
  code.chart = model.chart;
  code.mass_in = model.mass_in;
  code.constraints_in = model.constraints_in;
  code.own_outputs = own_outputs_;
  return code;
}

CompiledCode compile(const program::Program& program, const emit::EmissionContext& context, bool again) {
  const std::string name = emit::mangled_id(context.id);
  std::string source, header;
  for (const emit::EmittedFile& file : emit::emit(program, context, "cpp")) {
    if (file.name == name + ".c") source = file.text;
    if (file.name == name + ".h") header = file.text;
  }
  if (source.empty() || header.empty()) throw std::logic_error("the cpp target emitted no C source");
  emit::Compiled compiled = emit::compile_and_load(source, header, name, &Interrupt::flag());
  if (!compiled.note.empty() && !again) {
    tell(format_warning({{}, compiled.note + "; what is compiled now is kept in a private one, for this run alone",
                         "chmod 700 a folder of your own, or name one in EOMGEN_CACHE_DIR"}));
  }
  return {std::move(compiled), program};
}

CompiledCode compile_for_check(Derived& derived, const program::Program& program) {
  const run::Scene scene = run::resolve_scene(derived.mechanics, derived.candidates.front(),
                                              derived.model.scene("default"), {});
  verify::Certificate pending;
  return compile(program, emission_context(derived, program, scene, pending));
}

}  // namespace eomgen::cli
