// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "emit/names.hpp"
#include "emit/straight_line.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::emit {

ModelNames model_names(const program::Program& program, const EmissionContext& context,
                       std::span<const std::string_view> taken, std::size_t longest) {
  NameTable table(longest);
  for (const std::string_view word : taken) table.declare(std::string(word));
  ModelNames names;
  for (const std::string& prefix : {mangled_id(context.id), std::string("eom")}) {  // names of kernels
    for (const char* name : {"_sincos", "_sincos_near", "_sincos_far", "_sincos_lanes", "_is_near", "_lanes", "_bits",
                             "_rhs_from", "_rhs_far", "_rhs_prepared_from", "_rhs_prepared_far", "_taylor_start",
                             "_taylor_next", "_taylor_sums", "_differs"})
      table.declare(prefix + name);
  }
  for (const char* name :
       {"block",        "state", "call",         "kernel",   "target",   "lanes",  "mask",        "bits",
        "memory",       "load",  "store",        "at",       "all",      "select", "abs",         "sign",
        "every",        "whole", "place",        "to",       "side",     "slides", "normal_sign", "sincos",
        "sincos_lanes", "alone", "lane_by_lane", "run",      "INLINE",   "WIDTH",  "MOST",        "MET",
        "LAST",         "NAMED", "NAMED_FOR",    "NAMED_SO", "FOR_WIDTH"})
    table.declare(mangled_id(context.id) + "_batch_" + name);
  for (const Quantity& coordinate : context.coordinates) names.all_coordinates.push_back(identifier(coordinate.name));
  for (const std::uint32_t i : program.free) names.state.push_back(table.declare(context.coordinates.at(i).name));
  for (const std::uint32_t i : program.free)
    names.state.push_back(table.declare(context.coordinates.at(i).name + "_dot"));
  for (const symbolic::Symbol& state : program.states)
    names.state.push_back(table.declare(context.states.at(state.index).name));
  for (const std::uint32_t i : program.free) names.acceleration.push_back(context.coordinates.at(i).name + "_ddot");
  for (const program::ContactInfo& contact : program.contacts) {
    names.contacts.push_back(table.declare(identifier("slides_" + contact.name)));
    names.contacts.push_back(table.declare(identifier("normal_force_sign_" + contact.name)));
  }
  for (const Quantity& q : context.parameters) names.parameters.push_back(table.declare(q.name));
  for (const Quantity& q : context.inputs) names.inputs.push_back(table.declare(q.name));
  names.time = table.declare("t");
  names.x = table.declare("x");
  names.p = table.declare("p");
  names.w = table.declare("w");
  names.u = table.declare("u");
  names.mode = table.declare("mode");
  const std::size_t vector = program::vector_size(program);
  if (vector > 0) names.v = table.declare("v");
  for (std::size_t i = 0; i < vector; ++i) names.vector.push_back(table.declare(fmt::format("v_{}", i)));
  names.first_kink = program.mode_layout().kink(0);
  for (std::size_t k = 0; k < program.kinks.size(); ++k)
    names.sides.push_back(table.declare("side_" + std::to_string(k + 1)));
  NameTable outputs(longest), reactions(longest), events(longest), frames(longest), inertial(longest);
  for (const std::string& name : program.outputs) names.outputs.push_back(outputs.declare(name));
  for (const std::string& name : program.reactions) names.reactions.push_back(reactions.declare(name));
  if (program.result_size("frames") > 0) {
    for (const std::string& name : context.frames) names.frames.push_back(frames.declare(name));
  }
  if (program.result_size("regressor") > 0) {
    for (const std::string& name : context.inertial) names.inertial.push_back(inertial.declare(name));
  }
  for (const std::string& name : program.events) names.events.push_back(events.declare(name));
  for (std::size_t k = 0; k < program.kinks.size(); ++k)
    names.events.push_back(events.declare("kink_" + std::to_string(k + 1)));
  for (const program::ContactInfo& contact : program.contacts) {
    if (program.event_count() == 0) break;
    for (const char* what : {"slip_", "above_", "below_", "hold_", "margin_"}) {
      names.events.push_back(events.declare(identifier(what + contact.name)));
    }
  }
  return names;
}

}  // namespace eomgen::emit
