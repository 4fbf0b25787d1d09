// A spherical pendulum built in code: its equations, its C, a run.
#include <cstdio>
#include <eomgen/eomgen.hpp>
#include <fstream>

using eomgen::Value;

int main() {
  eomgen::Definition system("Spherical pendulum");
  system.parameter("m", "1 kg").parameter("L", "1 m").parameter("g", "9.81 m/s^2");
  system.add(
      "particle",
      {{"name", "P"}, {"mass", "m"}, {"position", Value::table({{"spherical", Value::list({"r", "phi", "theta"})}})}});
  system.add("force", {{"gravity", "-g*E3"}});
  system.add("constraint", {{"name", "rod"}, {"holonomic", "r - L"}});
  system.set("scene.default", "t", Value::list({0, 10}));
  system.set("scene.default", "initial", Value::table({{"phi", 1}, {"theta_dot", 2}}));
  try {
    const eomgen::Model model = eomgen::Model::from(system, "pendulum");
    std::fputs(model.equations().latex().c_str(), stdout);
    for (const eomgen::SourceFile& file : model.emit({.target = "c"}).files) std::ofstream(file.name) << file.text;
    const eomgen::Motion motion = model.run();
    std::printf("%s at t = %g: phi = %.12f +- %.0e\n", motion.outcome.c_str(), motion.t, motion.final_value("phi"),
                motion.error_estimate.back().second);
    return motion.is_complete() ? 0 : 3;
  } catch (const eomgen::Error& error) {
    std::fputs(error.what(), stderr);
    return error.exit_code();
  }
}
