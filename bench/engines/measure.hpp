// SPDX-License-Identifier: GPL-3.0-or-later
// The loop that all programs of bench/robots_beside.py have in common. Each of them has one class:
//
//   Engine(const Arguments&)                      reads the robot
//   void forward(const double* x, double* a)      accelerations a of the state x = q, v, in the order of the joints
//
//   PROGRAM STATES N FILE  JOINT x N  DAMPING x N    states on standard input
//
// Prints a line of accelerations for each state, and then the shortest mean time of a call in ns among 200 runs of some
// 0.5 ms, which other programs disturb least.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace engines {

struct Arguments {
  int states;
  std::size_t n;
  std::string file;
  std::vector<std::string> joints;
  std::vector<double> damping;  // the force -damping v, for programs that do not read it
};

inline Arguments arguments_of(int argc, char** argv) {
  if (argc < 4) throw std::runtime_error("arguments are missing");
  Arguments result{std::atoi(argv[1]), static_cast<std::size_t>(std::atoi(argv[2])), argv[3], {}, {}};
  const std::vector<std::string> rest(argv + 4, argv + argc);
  if (rest.size() != 2 * result.n) throw std::runtime_error("each joint has a name and a damping");
  result.joints.assign(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(result.n));
  for (std::size_t i = 0; i < result.n; ++i) result.damping.push_back(std::atof(rest[result.n + i].c_str()));
  return result;
}

template <class Engine>
int compare(int argc, char** argv) {
  try {
    const Arguments arguments = arguments_of(argc, argv);
    const std::size_t n = arguments.n;
    Engine engine(arguments);
    std::vector<double> x(2 * n), a(n);
    for (int s = 0; s < arguments.states; ++s) {
      for (double& value : x)
        if (!(std::cin >> value)) throw std::runtime_error("states are missing");
      engine.forward(x.data(), a.data());
      for (const double value : a) std::printf("%.17g ", value);
      std::printf("\n");
    }
    const auto seconds_of = [&](int calls) {
      const auto begin = std::chrono::steady_clock::now();
      for (int call = 0; call < calls; ++call) {
        engine.forward(x.data(), a.data());
        // Every position changes, so that no program keeps results of the call before.
        for (std::size_t i = 0; i < n; ++i) x[i] += 1e-12 * a[i];
      }
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / calls;
    };
    constexpr double length_of_run = 5e-4;
    double shortest = 1;
    for (int run = 0; run < 10; ++run) shortest = std::min(shortest, seconds_of(10));
    const int calls = std::max(1, static_cast<int>(length_of_run / shortest));
    for (int run = 0; run < 200; ++run) shortest = std::min(shortest, seconds_of(calls));
    std::printf("%.17g\n", 1e9 * shortest);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace engines
