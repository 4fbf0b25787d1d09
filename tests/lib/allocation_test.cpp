// A run allocates at its start and end only: operator new is counted over a short and a long run.
#include <doctest/doctest.h>

#include <cstdlib>
#include <new>
#include <string>

#include "eom/ode.hpp"
#include "lib/series_problems.hpp"

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("all methods: a run of 100 periods allocates as often as one of a tenth of a period") {
  const problems::KeplerSeries kepler;
  const auto check = [&](const eom::MethodInfo& method) {
    CAPTURE(std::string(method.name));
    eom::Options options;
    if (!method.adaptive) options.fixed_step = 0.01;
    problems::State x(4);
    const auto observe = [&](const eom::StepView& view) {
      view.interpolate(0.5 * (view.t0 + view.t1), x);
      return true;
    };
    const auto project = [](double, double* state) { return state[0] += 1e-15, 0; };
    const auto count = [&](double t1) {
      const std::size_t before = allocations;
      const eom::Result result = eom::integrate(method.name, kepler, 0, kepler.start, t1, options, observe, project);
      CHECK(result.outcome == eom::Outcome::done);
      return allocations - before;
    };
    const std::size_t of_short_run = count(0.6);
    CHECK(of_short_run > 0);
    CHECK(count(600) == of_short_run);
  };
  for (const eom::MethodInfo& method : eom::methods()) check(method);
  check({eom::Automatic::name, eom::Automatic::order, 4, true});
}
