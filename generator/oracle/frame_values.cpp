// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/frame_values.hpp"

namespace eomgen::verify {
namespace {

Components components(const Vector& v) { return {v[0].real(), v[1].real(), v[2].real()}; }

}  // namespace

PlaceMotion place_motion(Interpreter& at, std::uint32_t index, std::size_t coordinates) {
  Interpreter& later = at.with_time_slope();
  Interpreter& twice = later.with_time_slope();
  Interpreter& by_q = at.with_coordinate_slopes(false);
  const Vector v = slope(twice.place(index), twice.level(), 0);
  PlaceMotion motion{components(at.place(index)), components(v), components(slope(v, later.level(), 0)), {}};
  const Vector r = by_q.place(index);
  for (std::size_t i = 0; i < coordinates; ++i) motion.tangent.push_back(components(slope(r, by_q.level(), i)));
  return motion;
}

AxesMotion axes_motion(Interpreter& at, std::uint32_t index, std::size_t coordinates) {
  Interpreter& later = at.with_time_slope();
  AxesMotion motion{{components(at.axis(index, 0)), components(at.axis(index, 1)), components(at.axis(index, 2))},
                    components(at.angular_velocity(index)),
                    components(slope(later.angular_velocity(index), later.level(), 0)),
                    {}};
  for (std::size_t i = 0; i < coordinates; ++i) motion.rotation.push_back(components(at.virtual_rotation(index, i)));
  return motion;
}

}  // namespace eomgen::verify
