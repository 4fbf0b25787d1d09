// SPDX-License-Identifier: GPL-3.0-or-later
// Dynamics and their derivatives in Pinocchio, for bench/derivatives.py.
//
//   PROGRAM LINKS CALLS [floating]    on standard input q, qdot, qddot and d(qddot)/d(q, qdot) by columns, as emitted
//
// Ends with a message if an entry differs by more than 1e-12 of the largest one of its array. Otherwise prints the
// median processor times of a call in ns (of 31 means over CALLS calls, each with a velocity of its own) and the
// largest difference: aba; crba with nonLinearEffects (M and h); rnea; computeABADerivatives. A floating robot is timed
// with a free flyer in place of six joints, whose joints and their derivatives are compared too.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "pinocchio_model.hpp"

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
constexpr double tolerance = 1e-12;  // both compute in binary64, in another order

struct Point {
  VectorXd q, v;
};

template <class Array>
Array read(Index rows, Index columns) {
  Array result(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i)
      if (!(std::cin >> result(i, j))) throw std::runtime_error("numbers are missing");
  return result;
}

double difference(const MatrixXd& ours, const MatrixXd& theirs, const std::string& what) {
  const double result = (ours - theirs).cwiseAbs().maxCoeff() / ours.cwiseAbs().maxCoeff();
  if (!(result < tolerance))
    throw std::runtime_error(what + " differ by " + std::to_string(result / tolerance) + "e-12");
  return result;
}

// The pose and the velocity of the sixth joint's body, in the body's axes, and the joints after it.
Point of_free_flyer(const pinocchio::Model& six_joints, const Point& at) {
  pinocchio::Data data(six_joints);
  pinocchio::forwardKinematics(six_joints, data, at.q, at.v);
  Point result{VectorXd(at.q.size() + 1), at.v};
  const Eigen::Quaterniond rotation(data.oMi[6].rotation());
  result.q << data.oMi[6].translation(), rotation.coeffs(), at.q.tail(at.q.size() - 6);
  result.v.head<6>() = data.v[6].toVector();
  return result;
}

// The largest difference of accelerations and derivatives of the coordinates after the first `first`.
double compared(const pinocchio::Model& model, const Point& at, Index first, const MatrixXd& a, const MatrixXd& J) {
  pinocchio::Data data(model);
  const Index n = model.nv, m = n - first;
  if (!model.check(data)) throw std::runtime_error("the links are not in the order of Pinocchio");
  const VectorXd no_forces = VectorXd::Zero(n);
  pinocchio::computeABADerivatives(model, data, at.q, at.v, no_forces);
  double result = difference(a.bottomRows(m), data.ddq.tail(m), "accelerations");
  result =
      std::max(result, difference(J.block(first, first, m, m), data.ddq_dq.bottomRightCorner(m, m), "d(qddot)/dq"));
  return std::max(result,
                  difference(J.block(first, n + first, m, m), data.ddq_dv.bottomRightCorner(m, m), "d(qddot)/d(qdot)"));
}

double processor_ns() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

template <class Function>
double median(int calls, VectorXd& v, const Function& function) {
  constexpr int repeats = 31;
  std::vector<double> times;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const double begin = processor_ns();
    for (int k = 0; k < calls; ++k) {
      v[k % v.size()] += 1e-9;
      function();
    }
    times.push_back((processor_ns() - begin) / calls);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[repeats / 2];
}

void time(const pinocchio::Model& model, Point at, const MatrixXd& accelerations, int calls, double largest) {
  pinocchio::Data data(model);
  const VectorXd no_forces = VectorXd::Zero(model.nv), a = accelerations;
  const double aba = median(calls, at.v, [&] { pinocchio::aba(model, data, at.q, at.v, no_forces); });
  const double mass = median(calls, at.v, [&] {
    pinocchio::crba(model, data, at.q);
    pinocchio::nonLinearEffects(model, data, at.q, at.v);
  });
  const double rnea = median(calls, at.v, [&] { pinocchio::rnea(model, data, at.q, at.v, a); });
  const double derivatives =
      median(calls, at.v, [&] { pinocchio::computeABADerivatives(model, data, at.q, at.v, no_forces); });
  std::printf("[%.0f, %.0f, %.0f, %.0f, %.1e]\n", aba, mass, rnea, derivatives, largest);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3) throw std::runtime_error("arguments are missing");
    const std::vector<engines::PinocchioLink> links = engines::links_of(argv[1]);
    const int calls = std::atoi(argv[2]);
    const bool is_floating = argc > 3;
    const pinocchio::Model model = engines::model_of(links);
    const Point at{read<VectorXd>(model.nv, 1), read<VectorXd>(model.nv, 1)};
    const MatrixXd a = read<MatrixXd>(model.nv, 1), J = read<MatrixXd>(model.nv, 2 * model.nv);
    const double largest = compared(model, at, 0, a, J);
    if (!is_floating) {
      time(model, at, a, calls, largest);
      return 0;
    }
    const pinocchio::Model free = engines::model_of(links, true);
    const Point free_point = of_free_flyer(model, at);
    time(free, free_point, a, calls, std::max(largest, compared(free, free_point, 6, a, J)));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
