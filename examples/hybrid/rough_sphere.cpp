// A particle that leaves a rough sphere: generated code with only the runtime. Writes the table of `eomgen run
// P5_rough_sphere --out F.csv`, byte for byte.
#include <cstdio>
#include <eom/hybrid/run.hpp>
#include <eom/output/csv.hpp>
#include <span>
#include <string>
#include <vector>

#include "P5_rough_sphere_run.hpp"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s TABLE.csv\n", arguments[0]);
    return 2;
  }
  const eom::hybrid::Code code = P5_rough_sphere_code();
  eom::hybrid::Problem problem = P5_rough_sphere_problem(code);  // all members may be changed

  const std::vector<std::size_t> columns = P5_rough_sphere_columns();
  std::vector<std::string> names;
  for (const std::size_t column : columns) names.push_back(code.output_names[column]);
  std::vector<double> values(columns.size());
  eom::CsvWriter table(arguments[1], names);
  problem.row = [&](double t, std::span<const double> outputs) {
    for (std::size_t i = 0; i < columns.size(); ++i) values[i] = outputs[columns[i]];
    table.row(t, values);
  };

  const eom::hybrid::RunResult result = eom::hybrid::run(problem);
  table.finish(result.outcome);
  for (const eom::hybrid::Event& event : result.events)
    std::printf("%s at '%s', t = %.9f\n", event.kind.c_str(), event.name.c_str(), event.t);
  std::printf("%s at t = %g after %zu steps, error about %.1e; the energy is accounted for to %.1e\n",
              eom::name(result.outcome), result.t, result.statistics.steps, result.error.max, result.power_balance);
  return result.ended() ? 0 : 3;
}
