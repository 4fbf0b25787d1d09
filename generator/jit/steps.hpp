// SPDX-License-Identifier: GPL-3.0-or-later
// A function as operations on 16 floating-point registers and a scratch array: what is left between the straight-line
// program and the bytes of a processor.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "abi/functions.hpp"

namespace eomgen::jit {

inline constexpr std::size_t register_count = 16;

/// The place of a value: in a register, in the scratch array, in an argument of the function, among the constants.
enum class Place : std::uint8_t { register_, scratch, state, parameter, prepared, input, constant, result };
struct Location {
  Place place = Place::register_;
  std::uint32_t index = 0;
};

enum class Action : std::uint8_t {
  load,   // target = source
  store,  // source = target
  add,    // target += source; likewise the next five
  subtract,
  multiply,
  divide,
  least,                     // target = target < source ? target : source
  greatest,                  // target = target > source ? target : source
  root,                      // target = sqrt(source)
  negate,                    // target = -target
  absolute,                  // target = |target|
  sign,                      // target = 1, -1, or 0
  add_sign,                  // target = -target if the source register, which is lost, is negative
  compare,                   // target with source, for the actions that follow
  load_unless_above,         // target = source unless the compared target was above the compared source
  return_if_above,           // returns `extra`
  return_if_above_or_equal,  // likewise
  return_if_equal,           // likewise
  call,                      // register 0 = library function `extra` of the registers 0 (and 1)
  sincos_group,              // the sines and cosines of the `extra` angles at scratch[source] follow there
  begin_result,              // the entries of result `extra` follow
  end_result
};

struct Step {
  Action action = Action::load;
  std::uint8_t target = 0;
  Location source;
  std::uint32_t extra = 0;
};

/// A value that an entry of `mode` determines (eom/modes/mode_array.hpp), and its place in the scratch array. `index`:
/// the kink; of a contact 2 j + order, the sign of its state.
struct ModeValue {
  bool is_side = false;  // of a kink, else of a contact
  std::uint32_t index = 0, scratch = 0;
  std::uint32_t entry = 0;  // of `mode`
};

/// A function of one or two arguments of the C library.
enum class Library : std::uint32_t { pow, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, atan2 };

/// The arguments and the body of a function. The last step is followed by a test for numbers that are not finite, if
/// there is one, and by `return 0`.
struct FunctionSteps {
  std::vector<abi::Input> inputs;
  std::vector<bool> may_be_null;  // of the result arrays
  std::vector<Step> steps;
  std::vector<ModeValue> mode_values;
  std::uint32_t scratch_size = 0;
  std::uint32_t time = 0;  // place of t in the scratch array
  bool reads_time = false;
  std::uint32_t finite_from = 0, finite_to = 0;  // entries of the first result whose sum must be finite, else 5
};

/// Constants of all functions, equal ones once.
class Constants {
 public:
  std::uint32_t index(double value);
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> values_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_;  // by bits
};

}  // namespace eomgen::jit
