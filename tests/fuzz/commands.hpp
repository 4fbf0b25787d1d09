// SPDX-License-Identifier: GPL-3.0-or-later
// Commands of the program on an arbitrary model, in this process. For any model a command succeeds and its JSON
// document matches its schema, or it throws one Error with a remedy. Anything else ends the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace eomgen::fuzz {

using Words = std::vector<std::string>;

/// Calls without their model; a word that begins with "OUT" becomes a path in a temporary folder.
const std::vector<Words>& derive_calls();  // classify, show, verify, emit
const std::vector<Words>& run_calls();     // run for some steps, linearise, find equilibria, invert

/// Runs one of `calls` on a model. A first line "#3" selects the fourth call; without such a line the text determines
/// the call. Returns the error that rejected the model, or "".
std::string try_command(const std::vector<Words>& calls, const std::string& text);

/// A mutation of a model, and sometimes of its call; for an empty text, a mutation of a shipped model.
std::string mutate(const std::vector<Words>& calls, const std::string& text, unsigned seed);

/// The custom mutator of libFuzzer; it sometimes changes bytes instead of words.
std::size_t mutate_bytes(const std::vector<Words>& calls, std::uint8_t* data, std::size_t size, std::size_t most,
                         unsigned seed);

}  // namespace eomgen::fuzz
