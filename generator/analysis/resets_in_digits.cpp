// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/resets_in_digits.hpp"

#include <fmt/format.h>

#include <eom/hybrid/samples.hpp>

#include "error.hpp"
#include "numeric/numbers.hpp"

namespace eomgen::analysis {

using cln::cl_F;
using cln::cl_R;

ResetsInDigits::ResetsInDigits(const program::Program& program, const system::EquationSystem& system,
                               const ImpulseInDigits& impulses, const run::RunRequest& request)
    : system_(system), impulses_(impulses), request_(request) {
  for (const program::Function& function : program.functions) {
    if (function.name == "events") events_ = &function;
    if (function.name == "resets") resets_ = &function;
  }
}

cl_F ResetsInDigits::event_value(std::size_t event, const Point& at) const { return values(*events_, at)[event]; }

void ResetsInDigits::apply_event(std::size_t event, Point& at) const {
  apply(request_.events[event].reset, request_.events[event].name, at);
}

void ResetsInDigits::apply_sample(std::size_t sample, std::int64_t k, Point& at) const {
  const eom::hybrid::Sample& taken = request_.samples[sample];
  for (const eom::hybrid::Noise& noise : taken.noise)
    at.x[noise.component] =
        cln::cl_float(numeric::exact(eom::hybrid::random_number(noise, k)), cln::float_format(at.t));
  apply(taken.reset, taken.name, at);
}

std::vector<cl_F> ResetsInDigits::values(const program::Function& function, const Point& at) const {
  program::Arguments<cl_R> arguments;
  arguments.t = at.t;
  arguments.x.assign(at.x.begin(), at.x.end());
  for (const double p : request_.scene.parameters) arguments.p.push_back(numeric::exact(p));
  for (const double u : at.u) arguments.u.push_back(numeric::exact(u));
  std::vector<cl_F> result;
  const program::Values<cl_R> found = program::interpret(function, arguments, at.digits);
  for (const cl_R& value : found.results[0]) result.push_back(cln::cl_float(value, cln::float_format(at.t)));
  return result;
}

void ResetsInDigits::apply(const eom::hybrid::Reset& reset, const std::string& name, Point& at) const {
  if (reset.set.empty()) return;
  const std::vector<cl_F> r = values(*resets_, at);
  if (reset.condition && cln::zerop(r[*reset.condition])) return;
  const std::size_t n = system_.free.size();
  bool moves = false;
  for (const eom::hybrid::Reset::Entry& entry : reset.set) {
    if (entry.component < n && !system_.active.empty())
      throw Error("bench", {}, fmt::format("'{}' moves coordinates that are subject to constraints", name),
                  "eomgen run gives an error_estimate");
    moves = moves || entry.component < system_.layout().first_order_begin();
    at.x[entry.component] = r[entry.value];
  }
  if (moves) impulses_.make_consistent(at.t, at.u, at.x, at.digits);
}

}  // namespace eomgen::analysis
