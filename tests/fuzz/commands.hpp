// SPDX-License-Identifier: GPL-3.0-or-later
// Commands of the program on a model that somebody made, in this process: whatever the model is, a command does its
// work and its JSON document fits its schema, or it ends in one Error with a remedy. Anything else ends the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace eomgen::fuzz {

using Words = std::vector<std::string>;

/// Calls without their model; a word that begins with "OUT" becomes a path in a folder that is thrown away.
const std::vector<Words>& derive_calls();  // classify, show, verify, emit
const std::vector<Words>& run_calls();     // run for some steps, linearise, find equilibria, invert

/// Runs one of `calls` on a model; its first line "#3" says that it is the fourth, and without one the text does.
/// Gives the error that refused it, or "".
std::string try_command(const std::vector<Words>& calls, const std::string& text);

/// A change to a model, and now and then to its call; from nothing, a changed model of those that are shipped.
std::string mutate(const std::vector<Words>& calls, const std::string& text, unsigned seed);

/// What libFuzzer asks of a custom mutator; bytes instead of words now and then.
std::size_t mutate_bytes(const std::vector<Words>& calls, std::uint8_t* data, std::size_t size, std::size_t most,
                         unsigned seed);

}  // namespace eomgen::fuzz
