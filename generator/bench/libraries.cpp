// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/libraries.hpp"

#include <dlfcn.h>

#include <chrono>

#include "bench/median_time.hpp"
#include "emit/shared_library/build.hpp"
#include "error.hpp"
#include "skeletons/gsl_c.hpp"
#include "skeletons/odeint_cpp.hpp"
#include "skeletons/sundials_c.hpp"
#include "skeletons/task.h"
#include "skeletons/task_h.hpp"

namespace eomgen::bench {
namespace {

using Clock = std::chrono::steady_clock;

bool is_cpp(const Library& library) { return std::string(library.file).ends_with(".cpp"); }

emit::Recipe recipe_of(const Library& library, const std::atomic<bool>* interrupt) {
  emit::Recipe recipe;
  recipe.interrupt = interrupt;
  recipe.name = library.name;
  recipe.files = {{library.file, library.text}, {"task.h", adapter::task_h}};
  recipe.flags = {is_cpp(library) ? "-std=c++17" : "-std=c11", "-O2", "-fPIC", "-shared"};
  recipe.libraries = library.link;
  if (is_cpp(library)) {
    recipe.language = "C++";
    recipe.package = "g++";
    recipe.variables = {"EOMGEN_CXX", "CXX"};
    recipe.compilers = {"c++", "g++"};
  }
  recipe.what = library.name;
  return recipe;
}

/// The callbacks of a library's solver: the emitted code, with a count of evaluations and a time limit.
struct Calls {
  const run::RunRequest& request;
  std::vector<double> prepared;
  double seconds = 0;
  Clock::time_point start = {};
  std::size_t evaluations = 0;
  bool late = false;

  bool is_over() {
    constexpr std::size_t look = 256;  // evaluations between checks of the clock
    if (++evaluations % look == 0) late = std::chrono::duration<double>(Clock::now() - start).count() > seconds;
    return late || (request.interrupt != nullptr && *request.interrupt);
  }
  static int rhs(double t, const double* x, double* dx, void* data) {
    Calls& self = *static_cast<Calls*>(data);
    if (self.is_over()) return 1;
    const run::Code& code = self.request.code;
    const double* p = self.request.scene.parameters.data();
    return code.rhs_prepared != nullptr ? code.rhs_prepared(t, x, p, self.prepared.data(), nullptr, 0, dx)
                                        : code.rhs(t, x, p, nullptr, 0, dx);
  }
  static int jacobian(double t, const double* x, double* dfdx, double* dfdt, void* data) {
    Calls& self = *static_cast<Calls*>(data);
    return self.request.code.jac(t, x, self.request.scene.parameters.data(), nullptr, 0, dfdx, dfdt);
  }
};

/// A compiled library with its solvers; it stays loaded as long as one of them exists.
class Loaded {
 public:
  explicit Loaded(const std::string& path) : handle_(::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr)
      throw Error("bench", {}, "cannot load " + path, "install the library anew", ErrorKind::tool);
  }
  ~Loaded() { ::dlclose(handle_); }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;
  eomgen_solver solver(const char* function) const {
    return reinterpret_cast<eomgen_solver>(::dlsym(handle_, function));
  }

 private:
  void* handle_;
};

struct Runner {
  std::shared_ptr<Loaded> loaded;
  eomgen_solver solver;
  std::string name;
  std::vector<double> start;
  std::shared_ptr<Calls> calls;

  Row operator()(double rtol, double atol) const {
    Row row;
    row.solver = name;
    row.rtol = rtol;
    const run::Scene& scene = calls->request.scene;
    const eomgen_task task{static_cast<int>(start.size()),
                           scene.t0,
                           scene.t1,
                           rtol,
                           atol,
                           start.data(),
                           Calls::rhs,
                           calls->request.code.jac != nullptr ? Calls::jacobian : nullptr,
                           calls.get()};
    std::vector<double> x(start.size());
    long steps = 0;
    const auto once = [&] {
      calls->start = Clock::now();
      calls->evaluations = 0;
      calls->late = false;
      return solver(&task, x.data(), &steps);
    };
    const int status = once();
    row.steps = static_cast<std::size_t>(std::max(steps, 0L));
    row.rhs_evaluations = calls->evaluations;
    row.seconds = std::chrono::duration<double>(Clock::now() - calls->start).count();
    if (status != 0) {
      row.outcome = calls->late ? "interrupted" : "failed (" + std::to_string(status) + ")";
      return row;
    }
    row.outcome = "done";
    row.errors = x;
    const Median median = median_time(once);
    row.seconds = median.seconds;
    row.repeats = median.repeats;
    return row;
  }
};

/// The reason of a failure, from the output of the compiler.
std::string why_not(const Library& library, const std::string& said) {
  for (const char* missing : {"No such file", "file not found", "cannot find -l", "there is no"}) {
    if (said.find(missing) != std::string::npos)
      return std::string("it is not installed (sudo apt-get install ") + library.package + ")";
  }
  const std::size_t at = said.find("error:");
  return "its adapter cannot be compiled: " +
         (at == std::string::npos ? said : said.substr(at, said.find('\n', at) - at));
}

std::string does_not_fit(const run::RunRequest& request) {
  if (!request.scene.inputs.empty()) return "inputs that vary during the run need one of eomgen's own solvers";
  if (!request.scene.clock.breakpoints.empty())
    return "kinks in time (abs, sign, min, max, if) need one of eomgen's own solvers, whose steps end there";
  if (request.scene.t1 < request.scene.t0) return "runs backwards in time need one of eomgen's own solvers";
  return "";
}

}  // namespace

const std::vector<Library>& libraries() {
  static const std::vector<Library> list = {
      {"Odeint",
       "odeint.cpp",
       adapter::odeint_cpp,
       "libboost-dev",
       {},
       {{"Odeint dopri5", "eomgen_odeint_dopri5"},
        {"Odeint rkf78", "eomgen_odeint_rkf78"},
        {"Odeint bulirsch_stoer", "eomgen_odeint_bulirsch_stoer"}}},
      {"GSL",
       "gsl.c",
       adapter::gsl_c,
       "libgsl-dev",
       {"-lgsl", "-lgslcblas", "-lm"},
       {{"GSL rk8pd", "eomgen_gsl_rk8pd"}, {"GSL msbdf", "eomgen_gsl_msbdf"}}},
      {"SUNDIALS",
       "sundials.c",
       adapter::sundials_c,
       "libsundials-dev",
       {"-lsundials_arkode", "-lsundials_cvode", "-lsundials_ida", "-lsundials_nvecserial", "-lsundials_sunmatrixdense",
        "-lsundials_sunlinsoldense", "-lm"},
       {{"CVODE BDF", "eomgen_cvode_bdf"},
        {"CVODE Adams", "eomgen_cvode_adams"},
        {"ARKODE ERK 8", "eomgen_arkode_erk8"},
        {"ARKODE DIRK 5", "eomgen_arkode_dirk5"},
        {"IDA", "eomgen_ida"}}},
  };
  return list;
}

FoundLibraries find_libraries(const run::RunRequest& request, const std::vector<double>& start, double seconds) {
  FoundLibraries found;
  const std::string why = does_not_fit(request);
  auto calls = std::make_shared<Calls>(Calls{request, std::vector<double>(request.code.prepared), seconds});
  if (request.code.prepare != nullptr && why.empty())
    request.code.prepare(request.scene.parameters.data(), calls->prepared.data());
  for (const Library& library : libraries()) {
    if (!why.empty()) {
      found.left_out.emplace_back(library.name, why);
      continue;
    }
    std::shared_ptr<Loaded> loaded;
    try {
      loaded = std::make_shared<Loaded>(emit::build_library(recipe_of(library, request.interrupt)).path);
    } catch (const Error& error) {
      found.left_out.emplace_back(library.name, why_not(library, error.what()));
      continue;
    }
    for (const Library::Solver& solver : library.solvers)
      found.external_solvers.push_back(
          {solver.name, Runner{loaded, loaded->solver(solver.function), solver.name, start, calls}});
  }
  return found;
}

}  // namespace eomgen::bench
