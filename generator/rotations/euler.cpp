// SPDX-License-Identifier: GPL-3.0-or-later
// One formula for the twelve sets of Euler angles: Q = F(n3,g3) F(n2,g2) F(n1,g1), eq. (5.57).
#include "rotations/families.hpp"

namespace eomgen::rotations {
namespace {

std::string product(const std::string& a, const std::string& b) {
  if (a == "0" || b == "0") return "0";
  if (a == "1") return b;
  if (b == "1") return a;
  return "(" + a + ")*(" + b + ")";
}
std::string negative(const std::string& a) { return a == "0" ? a : "-(" + a + ")"; }
std::string sum(const std::string& a, const std::string& b) { return a == "0" ? b : b == "0" ? a : a + " + " + b; }

Components unit_vector(std::size_t axis) {
  Components result{"0", "0", "0"};
  result[axis] = "1";
  return result;
}

std::string dot(const Components& a, const Components& b) {
  return sum(sum(product(a[0], b[0]), product(a[1], b[1])), product(a[2], b[2]));
}
Components cross(const Components& a, const Components& b) {
  Components result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    result[k] = sum(product(a[i], b[j]), negative(product(a[j], b[i])));
  }
  return result;
}

/// Components of a vector along the axes after a step.
Components turned(const Step& step, const Components& v) {
  return {dot(step.R[0], v), dot(step.R[1], v), dot(step.R[2], v)};
}

}  // namespace

Step about_axis(std::size_t axis, const std::string& n) {
  const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
  Step step{{unit_vector(0), unit_vector(1), unit_vector(2)}, {"0", "0", "0"}};
  step.R[j][j] = step.R[k][k] = "cos(" + n + ")";
  step.R[j][k] = "sin(" + n + ")";
  step.R[k][j] = "-sin(" + n + ")";
  step.w[axis] = n + "_dot";
  return step;
}

Rotation euler(int i, int j, int k) {
  const std::array<std::size_t, 3> axis{static_cast<std::size_t>(i - 1), static_cast<std::size_t>(j - 1),
                                        static_cast<std::size_t>(k - 1)};
  Rotation result;
  result.name = std::to_string(i) + std::to_string(j) + std::to_string(k);
  result.family = "euler";
  result.title =
      "Euler angles about the axes " + std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k);
  for (std::size_t s = 0; s < 3; ++s) {
    result.entries.push_back({"n" + std::to_string(s + 1), "rad"});
    result.steps.push_back(about_axis(axis[s], result.entries[s].name));
  }
  const Components after_two = turned(result.steps[1], unit_vector(axis[0]));  // g1
  result.basis = {turned(result.steps[2], after_two), turned(result.steps[2], unit_vector(axis[1])),
                  unit_vector(axis[2])};
  // g1 . (g2 x g3), which does not depend on n1 and n3.
  const std::string volume = dot(after_two, cross(unit_vector(axis[1]), unit_vector(axis[2])));
  for (std::size_t s = 0; s < 3; ++s) {
    Components dual = cross(result.basis[(s + 1) % 3], result.basis[(s + 2) % 3]);
    for (std::string& component : dual) {
      if (component != "0") component = "(" + component + ")/(" + volume + ")";
    }
    result.dual.push_back(dual);
  }
  const bool symmetric = i == k;
  result.singular = symmetric ? "n2 = 0, n2 = pi" : "n2 = pi/2, n2 = -pi/2";
  result.singularity = symmetric ? "sin(n2)" : "cos(n2)";
  return result;
}

}  // namespace eomgen::rotations
