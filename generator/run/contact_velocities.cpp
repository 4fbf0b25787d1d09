// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/contact_velocities.hpp"

#include <cmath>

namespace eomgen::run {

ContactVelocities::ContactVelocities(const RunRequest& request, ConstraintRows& rows)
    : request_(request),
      rows_(rows),
      projection_(request.code.free.size(), rows.size(), 0),
      y_(request.code.output_names.size()),
      rtol_(request.scene.rtol),
      atol_(request.scene.atol) {
  const auto all = [&](const std::vector<std::string>& names) {
    std::vector<std::size_t> result;
    for (const std::string& name : names) result.push_back(index_of(request.code.output_names, name));
    return result;
  };
  for (const ContactOutputs& outputs : request.contacts) {
    Places places{all(outputs.slip), all(outputs.phi), {}, {}};
    for (const std::vector<std::string>& slopes : outputs.slopes) places.slopes.push_back(all(slopes));
    if (!outputs.restitution.empty()) places.restitution = index_of(request.code.output_names, outputs.restitution);
    places_.push_back(std::move(places));
  }
}

double ContactVelocities::still() const {
  constexpr double rounding = 1e-15, share = 1e-3, roundings = 1e-14;
  return std::max({rounding, atol_, std::max(share * rtol_, roundings) * largest_slip_});
}

double ContactVelocities::restitution(double t, const double* x, const double* u, std::size_t contact) {
  if (!places_[contact].restitution) return 0;
  request_.code.outputs(t, x, request_.scene.parameters.data(), u, 0, y_.data());
  return y_[*places_[contact].restitution];
}

void ContactVelocities::forget() {
  largest_slip_ = 0;
  least_.assign(request_.contacts.size(), still());
}

// Slip is known to the tolerance of the rates that it is made of.
void ContactVelocities::hold(double t, const double* x, const double* u, int mode) {
  constexpr double tolerances = 30;
  const std::size_t n = request_.code.free.size();
  if (request_.code.outputs(t, x, request_.scene.parameters.data(), u, mode, y_.data()) != 0) return;
  for (std::size_t j = 0; j < least_.size(); ++j) {
    if (places_[j].slip.size() != 2) continue;
    double known = 0;
    for (std::size_t a = 0; a < 2; ++a) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double slope = y_[places_[j].slopes[a][i]];
        sum += std::abs(slope) * (atol_ + rtol_ * std::abs(x[n + i]));
      }
      known = std::max(known, sum);
    }
    least_[j] = std::max(still(), tolerances * known);
  }
}

std::array<double, 2> ContactVelocities::slip(double t, const double* x, const double* u, int mode,
                                              std::size_t contact) {
  std::array<double, 2> w{};
  if (request_.code.outputs(t, x, request_.scene.parameters.data(), u, mode, y_.data()) != 0) return w;
  for (std::size_t a = 0; a < 2; ++a) w[a] = y_[places_[contact].slip[a]];
  return w;
}

int ContactVelocities::move(double t, std::span<double> x, const double* u) {
  const Code& code = request_.code;
  const double* p = request_.scene.parameters.data();
  return projection_(
             t, x.data(),
             [&](double at, const double* state, double* psi, double* A, double* b) {
               return rows_(at, state, u, psi, A, b);
             },
             [&](double at, const double* state, double* M, double* h) { return code.mass(at, state, p, M, h); })
      .code;
}

double ContactVelocities::approach(double t, std::span<const double> x, const double* u, std::size_t contact) {
  return rows_.rate(t, x.data(), u, rows_.row_of(contact));
}

// Contacts that touch and would be driven into one another by the impulse take part in it; others are left alone.
int ContactVelocities::impact(double t, std::span<double> x, const double* u, int mode, std::size_t contact,
                              double restitution) {
  const std::vector<double> before(x.begin(), x.end());
  const double after = -restitution * approach(t, x, u, contact);
  int part = mode;
  for (std::size_t j = 0; j < request_.contacts.size(); ++j) {
    if (j != contact && request_.code.contacts[j].unilateral) part = eom::with_contact_digit(part, j, 3);
  }
  for (std::size_t round = 0; round <= request_.contacts.size(); ++round) {
    std::copy(before.begin(), before.end(), x.begin());
    rows_.slide_all(part);
    rows_.target(rows_.row_of(contact), after);
    const int code = move(t, x, u);
    rows_.clear_targets();
    if (code != 0) return code;
    bool more = false;
    for (std::size_t j = 0; j < request_.contacts.size(); ++j) {
      const bool left_out = eom::contact_digit(part, j) == 3 && eom::contact_digit(mode, j) != 3;
      if (!request_.code.contacts[j].unilateral || !left_out || approach(t, x, u, j) >= -still()) continue;
      part = eom::with_contact_digit(part, j, 0);
      more = true;
    }
    if (!more) break;
  }
  return 0;
}

int ContactVelocities::close(double t, std::span<double> x, const double* u, int mode) {
  rows_.slide_all(mode);
  return move(t, x, u);
}

int ContactVelocities::stick(double t, std::span<double> x, const double* u, int mode, std::size_t) {
  rows_.mode(mode);
  return move(t, x, u);
}

// Sliding starts against the friction that held. Where none held, along the tangents' sum: any direction is as good.
int ContactVelocities::slide(double t, std::span<double> x, const double* u, int mode, std::size_t contact) {
  if (const int code = request_.code.outputs(t, x.data(), request_.scene.parameters.data(), u, mode, y_.data());
      code != 0)
    return code;
  std::vector<double> direction;
  double length = 0;
  for (const std::size_t phi : places_[contact].phi) direction.push_back(-y_[phi]);
  for (const double d : direction) length = std::hypot(length, d);
  if (!(length > 0)) direction.assign(direction.size(), length = 1);
  rows_.mode(mode);
  for (std::size_t a = 0; a < direction.size(); ++a)
    rows_.target(rows_.slip_row_of(contact) + a, 2 * least_slip(contact) * direction[a] / length);
  const int code = move(t, x, u);
  rows_.clear_targets();
  return code;
}

}  // namespace eomgen::run
