// SPDX-License-Identifier: GPL-3.0-or-later
// Linearised equations, equilibria and steady motions.
#pragma once

#include <complex>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eomgen {

/// Options of Model::linearise().
struct LineariseOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::optional<double> time = {};  // s, a time of the scene's motion; default: its start
  std::uint64_t seed = 1;
  std::vector<std::string> outputs = {};  // of C and D; empty: those of the scene that have a slope
};

/// Linearised equations y' = A y + B u and outputs o = C y + D u in independent coordinates and speeds, on the
/// constraint manifold.
struct Linearisation {
  std::string kind;                               // "equilibrium", "steady motion", "motion"
  std::vector<std::string> states;                // n, names
  std::vector<std::string> inputs;                // k, names
  std::vector<std::string> outputs;               // m, names
  std::vector<double> A, B, C, D;                 // n x n, n x k, m x n, m x k; row-major
  std::vector<double> output_values;              // m, at the state
  std::vector<std::complex<double>> eigenvalues;  // of A, in 1/s, by decreasing real part
  std::size_t structural_zeros = 0;               // eigenvalues 0 for all parameters
  std::string certificate;
};

/// Options of Model::steady_motions().
struct SteadyOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};
  std::map<std::string, double> hold = {};  // held outputs; empty: the conserved momenta at the start
  std::size_t starts = 300;                 // initial guesses of the search
  std::uint64_t seed = 1;
};

/// An equilibrium or a steady motion, with its stability.
struct SteadyMotion {
  std::string kind;                               // "equilibrium", "steady motion"
  std::map<std::string, double> state;            // coordinates and rates, SI units
  std::string stability, reason;                  // "stable", "unknown" or "unstable", and why
  std::vector<std::complex<double>> eigenvalues;  // 1/s
  std::size_t family_dimension = 0;               // dimension of the family it belongs to; 0: isolated
};

/// Result of Model::steady_motions().
struct SteadyMotions {
  std::vector<SteadyMotion> motions;
  std::map<std::string, double> held;  // outputs held during the search, and their values
  bool interrupted = false;            // not all initial guesses were tried
  std::string certificate;
};

}  // namespace eomgen
