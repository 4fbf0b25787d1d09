// SPDX-License-Identifier: MIT
// The state of an FMU as bytes and back. Bytes belong to the same FMU on the same kind of machine. In: a state. Out:
// bytes. Reading checks every length and throws std::invalid_argument if bytes are missing or left over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "eom/hybrid/external_steps.hpp"
#include "eom/hybrid/stepwise_modes.hpp"
#include "eom/hybrid/stepwise_run.hpp"

namespace eom::fmi {

/// Calls itself for each part of a value; `Archive` is a ByteWriter or a ByteReader.
template <class Archive, class Value>
void transfer(Archive& archive, Value& value) requires std::is_trivially_copyable_v<Value> {
  archive.bytes(&value, sizeof value);
}
template <class Archive>
void transfer(Archive& archive, std::vector<bool>& list) {
  std::uint64_t size = list.size();
  transfer(archive, size);
  archive.resize(list, size, 1);
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::uint8_t entry = list[i] ? 1 : 0;
    transfer(archive, entry);
    list[i] = entry != 0;
  }
}
template <class Archive, class Entry>
void transfer(Archive& archive, std::vector<Entry>& list) {
  std::uint64_t size = list.size();
  transfer(archive, size);
  archive.resize(list, size, std::is_trivially_copyable_v<Entry> ? sizeof(Entry) : 1);
  for (Entry& entry : list) transfer(archive, entry);
}
template <class Archive>
void transfer(Archive& archive, std::string& text) {
  std::vector<char> letters(text.begin(), text.end());
  transfer(archive, letters);
  text.assign(letters.begin(), letters.end());
}
template <class Archive, class Value>
void transfer(Archive& archive, std::optional<Value>& value) requires(!std::is_trivially_copyable_v<Value>) {
  std::uint8_t has = value ? 1 : 0;
  transfer(archive, has);
  if (has == 0) return value.reset();
  if (!value) value.emplace();
  transfer(archive, *value);
}
// Structured bindings name every member: a new member of these types is an error here.
template <class Archive>
void transfer(Archive& archive, hybrid::ContactModes::State& state) {
  auto& [mode, chatter, hits, slip, restitution, largest_gap, force_sizes] = state;
  auto& [largest, least, starts] = slip;
  transfer(archive, mode);
  transfer(archive, chatter);
  transfer(archive, hits);
  transfer(archive, largest);
  transfer(archive, least);
  transfer(archive, starts);
  transfer(archive, restitution);
  transfer(archive, largest_gap);
  transfer(archive, force_sizes);
}
template <class Archive>
void transfer(Archive& archive, hybrid::SolvedContacts::State& state) {
  auto& [states, chatter, sizes, hits] = state;
  auto& [speed, gap, terms, force, flight] = sizes;
  transfer(archive, states);
  transfer(archive, chatter);
  transfer(archive, speed);
  transfer(archive, gap);
  transfer(archive, terms);
  transfer(archive, force);
  transfer(archive, flight);
  transfer(archive, hits);
}
template <class Archive>
void transfer(Archive& archive, hybrid::ChartSwitch::State& state) {
  auto& [second, sides, own, t] = state;
  transfer(archive, second);
  transfer(archive, sides);
  transfer(archive, own);
  transfer(archive, t);
}
/// The history of changes of the method is not kept: only reports read it.
template <class Archive>
void transfer(Archive& archive, MethodChoice& choice) {
  auto& [method, stiff, nonstiff, steps, changes] = choice;
  std::string name = method == nullptr ? "" : method;
  transfer(archive, name);
  transfer(archive, stiff);
  transfer(archive, nonstiff);
  transfer(archive, steps);
  const MethodInfo* found = name.empty() ? nullptr : find_method(name);
  method = found == nullptr ? nullptr : found->name;
  changes.clear();
}
template <class Archive>
void transfer(Archive& archive, hybrid::StepBoxes::Function& function) {
  auto& [variables, box, side, margin] = function;
  transfer(archive, variables);
  transfer(archive, box);
  transfer(archive, side);
  transfer(archive, margin);
}
template <class Archive>
void transfer(Archive& archive, hybrid::StepBoxes::State& state) {
  auto& [parameters, functions, last, begun, is_extended] = state;
  transfer(archive, parameters);
  transfer(archive, functions);
  transfer(archive, last);
  transfer(archive, begun);
  transfer(archive, is_extended);
}
template <class Archive>
void transfer(Archive& archive, hybrid::Integration::State& state) {
  auto& [contacts, solved_contacts, charts, largest_kinks, constants, choice, taken, sliding, clearance, narrow] =
      state;
  transfer(archive, contacts);
  transfer(archive, solved_contacts);
  transfer(archive, charts);
  transfer(archive, largest_kinks);
  transfer(archive, constants);
  transfer(archive, choice);
  transfer(archive, taken);
  transfer(archive, sliding);
  transfer(archive, clearance);
  transfer(archive, narrow);
}
template <class Archive>
void transfer(Archive& archive, hybrid::ExternalSteps::State& state) {
  auto& [modes, parameters, sides, residuals, sizes, last, floor] = state;
  transfer(archive, modes);
  transfer(archive, parameters);
  transfer(archive, sides);
  transfer(archive, residuals);
  transfer(archive, sizes);
  transfer(archive, last);
  transfer(archive, floor);
}
/// Inputs of an FMU are held values: tables.
template <class Archive>
void transfer(Archive& archive, hybrid::Signal& signal) {
  transfer(archive, signal.times);
  transfer(archive, signal.values);
}
template <class Archive>
void transfer(Archive& archive, hybrid::StepwiseRun::State& state) {
  auto& [t, x, begun, next_step, origin, next_row, inputs, parameters, modes] = state;
  transfer(archive, t);
  transfer(archive, x);
  transfer(archive, begun);
  transfer(archive, next_step);
  transfer(archive, origin);
  transfer(archive, next_row);
  transfer(archive, inputs);
  transfer(archive, parameters);
  hybrid::StepwiseModes copy = modes ? *modes : hybrid::StepwiseModes{};
  transfer(archive, static_cast<hybrid::Integration::State&>(copy));
  modes = std::make_shared<const hybrid::StepwiseModes>(std::move(copy));
}

class ByteWriter {
 public:
  void bytes(const void* from, std::size_t count) {
    const auto* first = static_cast<const std::uint8_t*>(from);
    written_.insert(written_.end(), first, first + count);
  }
  template <class List>
  void resize(List&, std::uint64_t, std::size_t) {}
  std::vector<std::uint8_t> take() { return std::move(written_); }

 private:
  std::vector<std::uint8_t> written_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> from) : from_(from) {}
  void bytes(void* to, std::size_t count) {
    if (count > from_.size()) throw std::invalid_argument("a serialised state is too short");
    std::memcpy(to, from_.data(), count);
    from_ = from_.subspan(count);
  }
  template <class List>
  void resize(List& list, std::uint64_t size, std::size_t entry) {
    if (size > from_.size() / entry) throw std::invalid_argument("a serialised state is too short");
    list.resize(static_cast<std::size_t>(size));
  }
  void require_end() const {
    if (!from_.empty()) throw std::invalid_argument("a serialised state is too long");
  }

 private:
  std::span<const std::uint8_t> from_;
};

}  // namespace eom::fmi
