// SPDX-License-Identifier: GPL-3.0-or-later
// Segments of a reference solution, and what changes the state between them: impulses of supports, resets at events,
// samples. In: a run with tight tolerances, which has their order. Out: segments whose ends are found in all digits,
// and the changes there.
#pragma once

#include <cln/float.h>

#include <cstdint>
#include <eom/hybrid/segments.hpp>
#include <string>
#include <vector>

#include "program/interpret.hpp"
#include "reference/reference.hpp"
#include "run/runner.hpp"
#include "system/equation_system.hpp"

namespace eomgen::analysis {

/// The impulse of a support at a kink in time, in many digits, for reference solutions. In: the equations, the state
/// before the kink. Out: the velocities behind it. The momenta dL/dqdot are equal before and behind it, apart from the
/// impulses of constraints: M (qdot+ - qdot-) = -(p+ - p-) + A^T Lambda, with A qdot+ + b+ = 0.
class ImpulseInDigits {
 public:
  /// `parameters` has to outlive this object. The system has no contacts.
  ImpulseInDigits(const system::EquationSystem& system, const std::vector<double>& parameters);

  /// The two times of a kink, and the inputs there.
  struct Kink {
    double before, behind;
    std::vector<double> u_before, u_behind;
  };
  /// Changes the rates in x = (q, qdot, integrals).
  void apply(const Kink& kink, std::vector<cln::cl_F>& x, int digits) const;
  /// Changes rates by impulses of the constraints alone, until they satisfy the constraints.
  void make_consistent(const cln::cl_R& t, const std::vector<double>& u, std::vector<cln::cl_F>& x, int digits) const;

 private:
  std::vector<cln::cl_R> values(const std::vector<symbolic::Ref>& roots, const cln::cl_R& t,
                                const std::vector<double>& u, const std::vector<cln::cl_F>& x, int digits) const;
  /// Changes the rates by an impulse and those of the constraints.
  void change(const std::vector<cln::cl_R>& impulse, const cln::cl_R& t, const std::vector<double>& u,
              std::vector<cln::cl_F>& x, int digits) const;

  const system::EquationSystem& system_;
  const std::vector<double>& parameters_;
  std::vector<symbolic::Ref> momenta_;
};

/// Changes of the state by the model itself in many digits, for reference solutions. In: the functions `events` and
/// `resets` of the program, the events and samples of a run, the state. Out: values of event functions, the state after
/// a reset or a sample. Which of them occur, and in which order, is given.
class ResetsInDigits {
 public:
  /// All arguments have to outlive this object.
  ResetsInDigits(const program::Program& program, const system::EquationSystem& system, const ImpulseInDigits& impulses,
                 const run::RunRequest& request);

  /// Arguments of the functions: x is (q, qdot, first-order states, discrete values).
  struct Point {
    cln::cl_F t;
    std::vector<double> u;
    std::vector<cln::cl_F> x;
    int digits;
  };
  cln::cl_F event_value(std::size_t event, const Point& at) const;
  /// Changes at.x. Throws Error{stage "bench"} if a reset moves coordinates that are subject to constraints.
  void apply_event(std::size_t event, Point& at) const;
  void apply_sample(std::size_t sample, std::int64_t k, Point& at) const;

 private:
  std::vector<cln::cl_F> values(const program::Function& function, const Point& at) const;
  void apply(const eom::hybrid::Reset& reset, const std::string& name, Point& at) const;

  const program::Function* events_ = nullptr;
  const program::Function* resets_ = nullptr;
  const system::EquationSystem& system_;
  const ImpulseInDigits& impulses_;
  const run::RunRequest& request_;
};

inline constexpr double trial_tolerance = 1e-12;  // of the run that the reference follows

/// A change of the state by the model itself: a reset at an event, or a sample.
struct StateChange {
  enum class Kind { event, sample } kind;
  std::size_t index;  // of the event or sample
  double t;
  std::int64_t k = 0;  // of a sample
};

/// The end of the run that the reference follows, and what interrupts it.
struct ReferenceTrial {
  std::vector<double> impulses;  // times at which supports give one
  std::vector<StateChange> changes;
  bool crosses_kinks = false;
  std::vector<double> x;
};

class ReferenceBoundaries {
 public:
  /// program, system and request have to outlive this object.
  ReferenceBoundaries(const program::Program& program, const system::EquationSystem& system,
                      const run::RunRequest& request, ReferenceTrial trial);
  ReferenceBoundaries(const ReferenceBoundaries&) = delete;
  ReferenceBoundaries& operator=(const ReferenceBoundaries&) = delete;

  /// The segments of a run, in which `kinks` are known in advance. Called once, before the functions below. Throws
  /// Error{stage "bench"} if the order of two changes is not determined.
  std::vector<reference::InputSegment> segments(double begin, const std::vector<eom::hybrid::Segment>& kinks);

  /// See reference::Problem.
  void change(std::size_t boundary, const cln::cl_F& t, std::vector<cln::cl_F>& x, int digits) const;
  cln::cl_F event_value(std::size_t segment, const cln::cl_F& t, const std::vector<cln::cl_F>& x, int digits) const;

  /// Throws Error{stage "bench"} if the reference does not end where the run that it follows did.
  void require_same_end(const reference::Solution& reference) const;

 private:
  /// Takes the changes at the time t. caused: an event at t may follow from what happens there; otherwise a sample has
  /// to come first.
  void add_boundary(double t, bool caused);
  void add_segment(reference::InputSegment segment);
  [[noreturn]] void refuse_order(const StateChange& change) const;
  std::vector<double> inputs_at(double t) const;
  bool has_impulse(double t) const;

  ReferenceTrial trial_;
  ImpulseInDigits impulse_;
  ResetsInDigits resets_;
  const run::RunRequest& request_;
  std::size_t next_ = 0;  // of the changes, while segments are made
  std::vector<reference::InputSegment> segments_;
  std::vector<ImpulseInDigits::Kink> kinks_;       // per segment, at its end
  std::vector<std::vector<StateChange>> changes_;  // per boundary
};

/// Throws Error{stage "bench"}.
[[noreturn]] void refuse_reference(const std::string& what, const std::string& remedy);

}  // namespace eomgen::analysis
