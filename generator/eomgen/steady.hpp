// SPDX-License-Identifier: GPL-3.0-or-later
// Linearised equations, equilibria and steady motions.
#pragma once

#include <complex>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eomgen {

struct LineariseOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> at = {};  // a time of the scene's motion; the start without it
  std::uint64_t seed = 1;
};

/// y' = A y + B u in independent coordinates and speeds, on the constraint manifold.
struct Linearisation {
  std::string kind;                               // "equilibrium", "steady motion", "motion"
  std::vector<std::string> states;                // n
  std::vector<std::string> inputs;                // k
  std::vector<double> A, B;                       // n x n and n x k, by rows
  std::vector<std::complex<double>> eigenvalues;  // by falling real part
  std::size_t structural_zeros = 0;
  std::string certificate;
};

struct SteadyOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::map<std::string, double> hold = {};  // outputs and their values; empty: the conserved momenta at the start
  std::size_t starts = 300;
  std::uint64_t seed = 1;
};

struct SteadyMotion {
  std::string kind;                     // "equilibrium", "steady motion"
  std::map<std::string, double> state;  // coordinates and rates
  std::string stability, reason;        // "stable", "unstable", "unknown"
  std::vector<std::complex<double>> eigenvalues;
  std::size_t family = 0;  // dimensions of the family that it is one of
};

struct SteadyMotions {
  std::vector<SteadyMotion> motions;
  std::map<std::string, double> held;
  bool interrupted = false;
  std::string certificate;
};

}  // namespace eomgen
