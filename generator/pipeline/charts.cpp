// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <eom/modes/mode_array.hpp>

#include "derive/chart_change.hpp"
#include "pipeline/self_test_states.hpp"
#include "program/charts.hpp"

namespace eomgen::pipeline {

std::vector<model::ChartPair> list_charts(const mechanics::Mechanics& m) {
  std::vector<model::ChartPair> charts = model::charts(*m.model);
  std::size_t count = 0;
  for (model::ChartPair& chart : charts) {
    if (!chart.refusal.empty()) continue;
    if (!m.integrals.empty()) {
      chart.refusal =
          fmt::format("what '{}' keeps is written in the coordinates of the start", m.integrals.front().label);
    } else if (++count > eom::max_charts) {
      chart.refusal = fmt::format("only {} charts can be exchanged, and others come first", eom::max_charts);
    }
  }
  return charts;
}

std::vector<model::ChartPair> exchangeable_charts(const std::vector<model::ChartPair>& charts) {
  std::vector<model::ChartPair> result;
  std::copy_if(charts.begin(), charts.end(), std::back_inserter(result),
               [](const auto& chart) { return chart.refusal.empty(); });
  return result;
}

void add_second_charts(DerivedModel& own, program::Program& program, const std::vector<model::ChartPair>& charts,
                       unsigned mask, const ChartRequest& request) {
  if (program.charts.empty()) {
    symbolic::Dag dag;
    std::vector<system::ChartChange> changes;
    for (const model::ChartPair& chart : charts) changes.push_back(derive::chart_change(dag, own.model, chart));
    program::add_charts(program, dag, changes);
  }
  const auto derived =
      derive_model(std::make_shared<const model::Model>(model::in_second_charts(own.model, charts, mask)),
                   request.approach, request.form);
  // Uses the cheapest formulation of the own charts: a second search would take longer than it could save.
  std::stable_partition(derived->candidates.begin(), derived->candidates.end(), [&](const system::EquationSystem& s) {
    return s.formulation == program.formulation && s.approach == program.approach && s.form == program.form;
  });
  derived->candidates.resize(1);
  std::vector<std::uint32_t> exchanged;
  for (std::size_t j = 0; j < charts.size(); ++j) {
    for (const std::uint32_t angle : charts[j].angles) {
      if ((mask >> j & 1) != 0) exchanged.push_back(angle);
    }
  }
  const std::vector<std::uint32_t> places = program::chart_independent_outputs(
      program.outputs, own.candidates.front().outputs, derived->candidates.front().outputs, exchanged);
  program::Request wanted = request.request;
  wanted.outputs.clear();
  for (const std::uint32_t i : places) wanted.outputs.push_back(program.outputs[i]);
  program::Program second = make_program(*derived, wanted);
  const verify::Certificate certificate =
      certify(*derived, second, {50, emission_points, request.seed, nullptr, wanted.fix});
  require_pass(certificate, derived->model);
  for (double Timings::*part : {&Timings::derive, &Timings::optimise, &Timings::verify})
    own.seconds.*part += derived->seconds.*part;
  program::add_chart_variant(program, std::move(second), mask, places);
}

ChartLibrary::ChartLibrary(DerivedModel& own, program::Program program, emit::EmissionContext context,
                           ChartRequest request)
    : own_(own),
      program_(std::move(program)),
      context_(std::move(context)),
      request_(std::move(request)),
      charts_(exchangeable_charts(list_charts(own.mechanics))) {}

const run::Code& ChartLibrary::code_for(const std::vector<unsigned>& masks) {
  if (const auto found = compiled_.find(masks); found != compiled_.end()) return found->second.code.code_for_run();
  const auto start = std::chrono::steady_clock::now();
  const auto before = compiled_.find({masks.begin(), masks.end() - 1});
  program::Program program = before != compiled_.end() ? before->second.program : program_;
  add_second_charts(own_, program, charts_, masks.back(), request_);
  context_.tests = test_vectors(program, context_);
  CompiledCode code = make_code(request_.tier, program, context_, true);
  const auto made = compiled_.emplace(masks, Compiled{std::move(program), std::move(code)}).first;
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return made->second.code.code_for_run();
}

}  // namespace eomgen::pipeline
