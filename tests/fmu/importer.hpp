// SPDX-License-Identifier: GPL-3.0-or-later
// An importer of FMUs for tests: reads the archive, loads the binary, simulates by model exchange with a method of its
// own (the classical one of order 4, events located by bisection), or by co-simulation.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace eomgen::test {

/// The files of an archive without compression, in their order. Throws std::runtime_error if a checksum, a length or
/// the directory is wrong.
std::vector<std::pair<std::string, std::string>> read_archive(const std::string& bytes);

struct ScalarVariable {
  std::uint32_t reference = 0;
  std::string causality, variability, initial, unit;
  bool has_start = false;
  double start = 0;
  int derivative_of = -1;  // value reference
};

class Importer {
 public:
  /// Unpacks and loads the binary into `folder`.
  Importer(const std::string& archive, const std::string& folder);
  Importer(const Importer&) = delete;
  Importer& operator=(const Importer&) = delete;
  ~Importer();

  int version() const { return version_; }
  const std::map<std::string, ScalarVariable>& variables() const { return variables_; }
  const std::string& description() const { return description_; }
  double start_time() const { return start_time_; }
  double stop_time() const { return stop_time_; }
  std::size_t states() const { return states_; }
  std::size_t indicators() const { return indicators_; }
  const std::string& messages() const { return messages_; }

  // Each throws std::runtime_error with the message of the FMU unless the status is 0 (fmi2OK, fmi3OK).
  void instantiate(bool co_simulation, const std::string& token = "");
  void free();
  void enter_initialization(double t0, double tolerance = 0);
  void exit_initialization();
  void set(const std::string& name, double value);
  double get(const std::string& name);
  std::vector<double> get_states();
  void set_point(double t, const std::vector<double>& x);
  std::vector<double> derivatives();
  std::vector<double> event_indicators();
  bool complete_step();
  struct Update {
    bool terminate = false, changed = false;
    double next = 0;  // infinite if there is no next event in time
  };
  Update update();
  /// Returns true if the simulation ended.
  bool do_step(double from, double step);
  std::vector<double> directional(const std::vector<std::string>& unknowns, const std::vector<std::string>& knowns,
                                  const std::vector<double>& seed);
  std::vector<double> adjoint(const std::vector<std::string>& unknowns, const std::vector<std::string>& knowns,
                              const std::vector<double>& seed);
  std::vector<std::uint8_t> serialised_state();
  void restore(const std::vector<std::uint8_t>& bytes);

  /// Model exchange from the current point with steps of at most h to t_end, or until the FMU terminates. `inputs` is
  /// called before each evaluation. Returns the time reached.
  double simulate(double t0, double t_end, double h, const std::function<void(double t)>& inputs = {});

 private:
  template <class Function>
  Function* function(const std::string& name) const;
  void require(int status, const std::string& what);
  std::vector<std::uint32_t> references(const std::vector<std::string>& names) const;

  std::string description_, token_, messages_;
  int version_ = 0;
  std::map<std::string, ScalarVariable> variables_;
  double start_time_ = 0, stop_time_ = 0;
  std::size_t states_ = 0, indicators_ = 0;
  void* library_ = nullptr;
  void* instance_ = nullptr;
  bool is_simulation_ = false;
};

}  // namespace eomgen::test
