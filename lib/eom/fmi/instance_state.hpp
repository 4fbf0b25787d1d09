// SPDX-License-Identifier: MIT
// The members of Instance that save, restore and serialise its state. In: an instance, or a state. Out: a state, or its
// bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "eom/fmi/instance.hpp"

namespace eom::fmi {

inline Instance::State Instance::save() const {
  State state = now_;
  if (exchange_) state.exchange = exchange_->save();
  if (stepwise_) state.stepwise = stepwise_->save();
  return state;
}

inline void Instance::restore(const State& from) {
  reset();
  if (from.x.size() != now_.x.size() || from.u.size() != now_.u.size() || from.p.size() != now_.p.size() ||
      from.given.size() != now_.given.size())
    throw std::invalid_argument("the state belongs to another FMU");
  now_ = from;
  now_.exchange = {};
  now_.stepwise = {};
  if (from.phase != Phase::running && from.phase != Phase::terminated) return;
  problem_.t0 = from.start_time;
  problem_.t1 = std::max(from.stop_time.value_or(from.start_time + (problem_.t1 - problem_.t0)), from.start_time);
  problem_.parameters = from.p;
  is_start_old_ = false;
  hybrid::Problem problem = problem_of_start();
  if (co_simulation_) {
    stepwise_ = std::make_unique<hybrid::StepwiseRun>(std::move(problem));
    stepwise_->restore(from.stepwise);
  } else {
    exchange_ = std::make_unique<hybrid::ExternalSteps>(std::move(problem));
    exchange_->restore(now_.t, now_.x, from.exchange);
  }
}

template <class Archive>
void transfer(Archive& archive, Instance::State& state) {
  auto& [phase, t, start_time, tolerance, stop_time, x, u, p, given, exchange, stepwise] = state;
  transfer(archive, phase);
  transfer(archive, t);
  transfer(archive, start_time);
  transfer(archive, tolerance);
  transfer(archive, stop_time);
  transfer(archive, x);
  transfer(archive, u);
  transfer(archive, p);
  transfer(archive, given);
  transfer(archive, exchange);
  transfer(archive, stepwise);
}

inline std::vector<std::uint8_t> Instance::serialise(const State& state) {
  ByteWriter writer;
  State copy = state;
  transfer(writer, copy);
  return writer.take();
}

inline Instance::State Instance::deserialise(std::span<const std::uint8_t> bytes) {
  ByteReader reader(bytes);
  State state;
  transfer(reader, state);
  reader.require_end();
  return state;
}

}  // namespace eom::fmi
