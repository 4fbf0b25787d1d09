// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/rigid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eomgen::import {
namespace {

constexpr long double pi = std::numbers::pi_v<long double>;

/// Sine of k pi/12, exact for multiples of pi/2.
long double sine(long double angle) {
  const long double quarters = std::round(angle / (pi / 2));
  if (std::fabs(angle - quarters * (pi / 2)) < 1e-17L * std::max(1.0L, std::fabs(angle))) {
    const int k = static_cast<int>(std::fmod(quarters, 4.0L) + 4) % 4;
    return k == 1 ? 1 : k == 3 ? -1 : 0;
  }
  return std::sin(angle);
}
long double cosine(long double angle) {
  const long double quarters = std::round(angle / (pi / 2));
  if (std::fabs(angle - quarters * (pi / 2)) < 1e-17L * std::max(1.0L, std::fabs(angle))) {
    const int k = static_cast<int>(std::fmod(quarters, 4.0L) + 4) % 4;
    return k == 0 ? 1 : k == 2 ? -1 : 0;
  }
  return std::cos(angle);
}

/// Removes what is below the roundings of extended precision, so that an entry that is zero stays out of the model.
Number without_rounding(const Number& number, long double scale) {
  return number.text.empty() && std::fabs(number.value) < 1e-17L * scale ? Number() : number;
}

long double largest(const Matrix& a) {
  long double found = 0;
  for (const Vector& row : a)
    for (const Number& entry : row) found = std::max(found, std::fabs(entry.value));
  return found;
}

Matrix without_rounding(Matrix a) {
  const long double scale = largest(a);
  for (Vector& row : a)
    for (Number& entry : row) entry = without_rounding(entry, scale);
  return a;
}

/// An angle that arithmetic left at a multiple of pi/12.
Number named_angle(long double value) {
  const long double twelfths = std::round(value / (pi / 12));
  if (std::fabs(value - twelfths * (pi / 12)) > 1e-17L) return {value};
  if (twelfths == 0) return {};
  Number decimal(value, "0.00000000000000000");
  decimal.value = twelfths * (pi / 12);
  decimal.text = "3.1415926535897932385";  // of enough digits
  return *multiple_of_pi(decimal);
}

}  // namespace

Matrix identity() {
  Matrix result;
  for (std::size_t i = 0; i < 3; ++i) result[i][i] = Number(1, "1");
  return result;
}

Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vector operator*(const Matrix& a, const Vector& v) {
  Vector result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i] = result[i] + a[i][k] * v[k];
  return result;
}

Matrix transposed(const Matrix& a) {
  Matrix result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = a[k][i];
  return result;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  const Matrix columns = transposed(b);
  Matrix result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = a * columns[k];
  return transposed(result);
}

bool is_zero(const Vector& v) {
  return std::all_of(v.begin(), v.end(), [](const Number& x) { return x.is_zero(); });
}

bool is_identity(const Matrix& a) { return a[0][0].value == 1 && a[1][1].value == 1 && a[2][2].value == 1; }

Matrix rotation(const Vector& rpy) {
  const Number cr = cosine(rpy[0].value), sr = sine(rpy[0].value), cp = cosine(rpy[1].value), sp = sine(rpy[1].value),
               cy = cosine(rpy[2].value), sy = sine(rpy[2].value), one(1), zero;
  const Matrix z{{{cy, -sy, zero}, {sy, cy, zero}, {zero, zero, one}}};
  const Matrix y{{{cp, zero, sp}, {zero, one, zero}, {-sp, zero, cp}}};
  const Matrix x{{{one, zero, zero}, {zero, cr, -sr}, {zero, sr, cr}}};
  return without_rounding(z * (y * x));
}

Vector angles_of(const Matrix& R) {
  const long double down = std::clamp(-R[2][0].value, -1.0L, 1.0L);
  // At a pitch of a right angle, roll and yaw turn about one axis: the roll is set to 0.
  if (std::fabs(down) > 1 - 1e-15L) {
    return {Number(), named_angle(down > 0 ? pi / 2 : -pi / 2), named_angle(std::atan2(-R[0][1].value, R[1][1].value))};
  }
  return {named_angle(std::atan2(R[2][1].value, R[2][2].value)),
          named_angle(std::atan2(down, std::hypot(R[0][0].value, R[1][0].value))),
          named_angle(std::atan2(R[1][0].value, R[0][0].value))};
}

Pose operator*(const Pose& a, const Pose& b) {
  Pose result;
  result.p = a.p + a.R * b.p;
  result.R = without_rounding(a.R * b.R);
  result.rpy.reset();
  if (is_identity(a.R))
    result.rpy = b.rpy;
  else if (is_identity(b.R))
    result.rpy = a.rpy;
  return result;
}

bool Inertia::is_zero() const {
  return mass.is_zero() &&
         std::all_of(tensor.begin(), tensor.end(), [](const Vector& row) { return import::is_zero(row); });
}

Inertia operator*(const Pose& pose, const Inertia& inertia) {
  if (inertia.is_zero()) return {};
  return {inertia.mass, pose.p + pose.R * inertia.centre,
          without_rounding(pose.R * inertia.tensor * transposed(pose.R))};
}

Inertia operator+(const Inertia& a, const Inertia& b) {
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
  Inertia sum;
  sum.mass = a.mass + b.mass;
  const Number share_a = sum.mass.is_zero() ? Number() : a.mass / sum.mass;
  const Number share_b = sum.mass.is_zero() ? Number() : b.mass / sum.mass;
  for (std::size_t i = 0; i < 3; ++i) sum.centre[i] = share_a * a.centre[i] + share_b * b.centre[i];
  for (const Inertia* part : {&a, &b}) {
    const Vector d = part->centre - sum.centre;
    const Number square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Number steiner = part->mass * ((i == k ? square : Number()) - d[i] * d[k]);
        sum.tensor[i][k] = sum.tensor[i][k] + part->tensor[i][k] + steiner;
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i)  // symmetric to the last digit
    for (std::size_t k = 0; k < i; ++k) sum.tensor[i][k] = sum.tensor[k][i];
  sum.tensor = without_rounding(sum.tensor);
  return sum;
}

bool is_positive_semidefinite(const Matrix& a) {
  // All principal minors of a semidefinite matrix are at least 0.
  const long double scale = largest(a), slack = 1e-6L * scale;
  const auto entry = [&](std::size_t i, std::size_t k) { return a[i][k].value; };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    if (entry(i, i) < 0) return false;
    if (entry(i, i) * entry(k, k) - entry(i, k) * entry(i, k) < -slack * scale) return false;
  }
  const long double determinant = entry(0, 0) * (entry(1, 1) * entry(2, 2) - entry(1, 2) * entry(1, 2)) -
                                  entry(0, 1) * (entry(0, 1) * entry(2, 2) - entry(1, 2) * entry(0, 2)) +
                                  entry(0, 2) * (entry(0, 1) * entry(1, 2) - entry(1, 1) * entry(0, 2));
  return determinant >= -slack * scale * scale;
}

bool satisfies_triangle_inequality(const Matrix& tensor) {
  const Number half_trace((tensor[0][0].value + tensor[1][1].value + tensor[2][2].value) / 2);
  Matrix second_moments;  // integral of x x^T dm
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) second_moments[i][k] = (i == k ? half_trace : Number()) - tensor[i][k];
  for (std::size_t i = 0; i < 3; ++i)
    if (second_moments[i][i].value < 0 && second_moments[i][i].value > -1e-6L * half_trace.value)
      second_moments[i][i] = {};
  return is_positive_semidefinite(second_moments);
}

}  // namespace eomgen::import
