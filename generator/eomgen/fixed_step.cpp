// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/fixed_step.hpp"

#include <algorithm>
#include <eom/discrete/step.hpp>

#include "eomgen/compiled_state.hpp"
#include "error.hpp"

namespace eomgen {
namespace {

/// The functions of a CompiledModel in the form of eom::discrete::Functions.
struct ModelFunctions {
  const CompiledModel& model;

  int rhs(double t, const double* x, const double* p, const double* u, const int* mode, double* dx) const {
    return model.rhs({t, x, p, u, mode}, dx);
  }
  int jac(double t, const double* x, const double* p, const double* u, const int* mode, double* dfdx,
          double* dfdt) const {
    return model.jac({t, x, p, u, mode}, dfdx, dfdt);
  }
  int jac_p(double t, const double* x, const double* p, const double* u, const int* mode, double* dfdp) const {
    return model.jac_p({t, x, p, u, mode}, dfdp);
  }
  int jac_u(double t, const double* x, const double* p, const double* u, const int* mode, double* dfdu) const {
    return model.jac_u({t, x, p, u, mode}, dfdu);
  }
  int momenta(double t, const double* x, const double* p, const double* u, const int* mode, double* momenta,
              double* rates) const {
    return model.momenta({t, x, p, u, mode}, momenta, rates);
  }
  int momenta_jac(double t, const double* x, const double* p, const double* u, const int* mode, double* dmdx,
                  double* dmdt) const {
    return model.momenta_jac({t, x, p, u, mode}, dmdx, dmdt);
  }
  int momenta_jac_p(double t, const double* x, const double* p, const double* u, const int* mode, double* dmdp) const {
    return model.momenta_jac_p({t, x, p, u, mode}, dmdp);
  }
  int momenta_jac_u(double t, const double* x, const double* p, const double* u, const int* mode, double* dmdu) const {
    return model.momenta_jac_u({t, x, p, u, mode}, dmdu);
  }
};

void require_function(const CompiledModel& model, const std::string& method, const char* function) {
  if (model.has(function)) return;
  throw Error("step", {},
              "the method '" + method + "' needs the function '" + std::string(function) + "', which was not compiled",
              "name it in `functions` when the model is compiled, or choose rk4");
}

/// Refuses models whose momenta do not change by their rates alone.
void check_variational(const CompiledModel& model, bool has_contacts) {
  const char* obstacle = nullptr;
  if (!model.constraints().empty())
    obstacle = "constraints with multipliers";
  else if (has_contacts)
    obstacle = "contacts";
  else if (model.states().size() != 2 * model.coordinate_count())
    obstacle = "states beside coordinates and rates";
  if (obstacle == nullptr) return;
  throw Error("step", {},
              std::string("the method '") + eom::discrete::Variational::name + "' takes no model with " + obstacle,
              "choose midpoint");
}

eom::discrete::Step new_step(const CompiledModel& model, const std::string& method, bool has_contacts) {
  const std::vector<std::string> known = FixedStep::methods();
  if (std::find(known.begin(), known.end(), method) == known.end()) {
    std::string names;
    for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
    throw Error("step", {}, "no method of a step is called '" + method + "'", "choose one of " + names);
  }
  if (method == eom::discrete::Midpoint::name) require_function(model, method, "jac");
  if (method == eom::discrete::Variational::name) {
    check_variational(model, has_contacts);
    for (const char* function : {"momenta", "momenta_jac"}) require_function(model, method, function);
  }
  return {method, {model.states().size(), model.parameters().size(), model.inputs().size()}};
}

}  // namespace

struct FixedStep::Data {
  CompiledModel model;
  eom::discrete::Step step;
  bool inputs_vary;
};

FixedStep::FixedStep(CompiledModel model, const std::string& method) {
  const run::Code& code = model.state_->code();
  eom::discrete::Step step = new_step(model, method, !code.contacts.empty() || !code.contact_set.contacts.empty());
  const bool vary = model.state_->constant_inputs.empty() && !model.inputs().empty();
  data_ = std::make_unique<Data>(Data{std::move(model), std::move(step), vary});
}
FixedStep::FixedStep(FixedStep&&) noexcept = default;
FixedStep& FixedStep::operator=(FixedStep&&) noexcept = default;
FixedStep::~FixedStep() = default;

std::vector<std::string> FixedStep::methods() {
  return {eom::discrete::method_names.begin(), eom::discrete::method_names.end()};
}

int FixedStep::operator()(const CompiledModel::Arguments& at, double h, double* x1) {
  return derivatives(at, h, x1, {});
}

int FixedStep::derivatives(const CompiledModel::Arguments& at, double h, double* x1, const StepDerivatives& to) {
  const std::vector<double> held =
      at.inputs == nullptr && data_->inputs_vary ? data_->model.input_values(at.t) : std::vector<double>{};
  const eom::discrete::Arguments arguments{at.t,   h, at.x, at.parameters, held.empty() ? at.inputs : held.data(),
                                           at.mode};
  const int code = data_->step.derivatives(ModelFunctions{data_->model}, arguments, x1,
                                           {to.x, to.parameters, to.inputs, to.t, to.h});
  return code == eom::code_no_convergence ? no_convergence : code;
}

}  // namespace eomgen
