// SPDX-License-Identifier: GPL-3.0-or-later
// Twenty systems of textbooks: energies and equations of motion have the terms, the grouping and the order that books
// print. In: models. Compared: T, U and the equations, as text.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "print/render.hpp"
#include "reading/forms.hpp"
#include "reading/routh.hpp"

using namespace eomgen;

namespace {

struct Textbook {
  const char* name;
  std::string parameters, body;
  std::vector<std::string> energies, equations;  // T, U (further parts of T are left out); one per coordinate
};

std::string particle(const std::string& name, const std::string& mass, const std::string& position) {
  return "[[particle]]\nname = \"" + name + "\"\nmass = \"" + mass + "\"\nposition = [" + position + "]\n";
}
std::string body(const std::string& inertia, const std::string& angle, const std::string& position) {
  return "[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = " + inertia + "\nrotation = { axis = \"E3\", angle = \"" +
         angle + "\" }\nposition = [" + position + "]\n";
}
std::string coordinates(const std::vector<std::string>& names) {
  std::string text = "[coordinates]\n";
  for (const std::string& name : names) text += name + " = {}\n";
  return text;
}
std::string potential(const std::string& energy) { return "[energy]\npotential = \"" + energy + "\"\n"; }

const std::string weight = "[[force]]\ngravity = \"-g*E2\"\n", weight_in_space = "[[force]]\ngravity = \"-g*E3\"\n";

std::vector<Textbook> systems() {
  return {
      {"plane pendulum",
       "m = 1\nl = 1\ng = 9.81\n",
       coordinates({"theta"}) + particle("P", "m", "\"l*sin(theta)\", \"-l*cos(theta)\", 0") + weight,
       {"T~ = 1/2 m l^2 theta_dot^2", "U~ = -m l g cos(theta)"},
       {"m l^2 theta_ddot + m l g sin(theta) = 0"}},
      {"double pendulum",
       "m1 = 1\nm2 = 1\nl1 = 1\nl2 = 1\ng = 9.81\n",
       coordinates({"theta1", "theta2"}) + particle("A", "m1", "\"l1*sin(theta1)\", \"-l1*cos(theta1)\", 0") +
           particle("B", "m2", "\"l1*sin(theta1) + l2*sin(theta2)\", \"-l1*cos(theta1) - l2*cos(theta2)\", 0") + weight,
       {"T~ = 1/2 (m1 + m2) l1^2 theta1_dot^2 + m2 l1 l2 cos(theta1 - theta2) theta1_dot theta2_dot + 1/2 m2 l2^2 "
        "theta2_dot^2",
        "U~ = -(m1 + m2) l1 g cos(theta1) - m2 l2 g cos(theta2)"},
       {"(m1 + m2) l1^2 theta1_ddot + m2 l1 l2 cos(theta1 - theta2) theta2_ddot + m2 l1 l2 sin(theta1 - theta2) "
        "theta2_dot^2 + (m1 + m2) l1 g sin(theta1) = 0",
        "m2 l1 l2 cos(theta1 - theta2) theta1_ddot + m2 l2^2 theta2_ddot - m2 l1 l2 sin(theta1 - theta2) theta1_dot^2 "
        "+ m2 l2 g sin(theta2) = 0"}},
      {"spherical pendulum",
       "m = 1\nl = 1\ng = 9.81\n",
       coordinates({"theta", "phi"}) +
           particle("P", "m", "\"l*sin(theta)*cos(phi)\", \"l*sin(theta)*sin(phi)\", \"l*cos(theta)\"") +
           weight_in_space,
       {"T~ = 1/2 m l^2 (theta_dot^2 + sin^2(theta) phi_dot^2)", "U~ = m l g cos(theta)"},
       {"m l^2 theta_ddot - m l^2 sin(theta) cos(theta) phi_dot^2 - m l g sin(theta) = 0",
        "m l^2 sin^2(theta) phi_ddot + 2 m l^2 sin(theta) cos(theta) theta_dot phi_dot = 0"}},
      {"pendulum on a cart",
       "M = 1\nm = 1\nl = 1\ng = 9.81\n",
       coordinates({"x", "theta"}) + particle("C", "M", "\"x\", 0, 0") +
           particle("P", "m", "\"x + l*sin(theta)\", \"-l*cos(theta)\", 0") + weight,
       {"T~ = 1/2 (M + m) x_dot^2 + m l cos(theta) x_dot theta_dot + 1/2 m l^2 theta_dot^2", "U~ = -m l g cos(theta)"},
       {"(M + m) x_ddot + m l cos(theta) theta_ddot - m l sin(theta) theta_dot^2 = 0",
        "m l cos(theta) x_ddot + m l^2 theta_ddot + m l g sin(theta) = 0"}},
      {"elastic pendulum",
       "m = 1\nk = 1\nl0 = 1\ng = 9.81\n",
       coordinates({"r", "theta"}) + particle("P", "m", "\"r*sin(theta)\", \"-r*cos(theta)\", 0") + weight +
           potential("k*(r - l0)^2/2"),
       {"T~ = 1/2 m (r_dot^2 + r^2 theta_dot^2)", "U~ = 1/2 k (r - l0)^2 - m g r cos(theta)"},
       {"m r_ddot - m r theta_dot^2 + k (r - l0) - m g cos(theta) = 0",
        "m r^2 theta_ddot + 2 m r r_dot theta_dot + m g r sin(theta) = 0"}},
      {"bead on a rotating hoop",
       "m = 1\nR = 1\nw = 1\ng = 9.81\n",
       coordinates({"theta"}) +
           particle("P", "m", "\"R*sin(theta)*cos(w*t)\", \"R*sin(theta)*sin(w*t)\", \"-R*cos(theta)\"") +
           weight_in_space,
       {"T~ = 1/2 m R^2 theta_dot^2 + 1/2 m R^2 w^2 sin^2(theta)", "U~ = -m R g cos(theta)"},
       {"m R^2 theta_ddot - m R^2 w^2 sin(theta) cos(theta) + m R g sin(theta) = 0"}},
      {"planet",
       "m = 1\nk = 1\n",
       coordinates({"r", "phi"}) + particle("P", "m", "\"r*cos(phi)\", \"r*sin(phi)\", 0") + potential("-k/r"),
       {"T~ = 1/2 m (r_dot^2 + r^2 phi_dot^2)", "U~ = -k/r"},
       {"m r_ddot - m r phi_dot^2 + k/r^2 = 0", "m r^2 phi_ddot + 2 m r r_dot phi_dot = 0"}},
      {"bead on a parabola",
       "m = 1\na = 1\ng = 9.81\n",
       coordinates({"x"}) + particle("P", "m", "\"x\", \"a*x^2\", 0") + weight,
       {"T~ = 1/2 m (4 a^2 x^2 + 1) x_dot^2", "U~ = m a g x^2"},
       {"m (4 a^2 x^2 + 1) x_ddot + 4 m a^2 x x_dot^2 + 2 m a g x = 0"}},
      {"Atwood's machine",
       "m1 = 1\nm2 = 2\nl = 3\ng = 9.81\n",
       coordinates({"x"}) + particle("A", "m1", "0, \"-x\", 0") + particle("B", "m2", "1, \"-(l - x)\", 0") + weight,
       {"T~ = 1/2 (m1 + m2) x_dot^2"},
       {"(m1 + m2) x_ddot - (m1 - m2) g = 0"}},
      {"block on a wedge",
       "M = 1\nm = 1\nalpha = 0.5\ng = 9.81\n",
       coordinates({"x", "s"}) + particle("W", "M", "\"x\", 0, 0") +
           particle("P", "m", "\"x + s*cos(alpha)\", \"-s*sin(alpha)\", 0") + weight,
       {"T~ = 1/2 (M + m) x_dot^2 + m cos(alpha) x_dot s_dot + 1/2 m s_dot^2", "U~ = -m g s sin(alpha)"},
       {"(M + m) x_ddot + m cos(alpha) s_ddot = 0", "m cos(alpha) x_ddot + m s_ddot - m g sin(alpha) = 0"}},
      {"two masses between springs",
       "m = 1\nk = 1\nK = 1\n",
       coordinates({"x1", "x2"}) + particle("A", "m", "\"x1\", 0, 0") + particle("B", "m", "\"x2\", 1, 0") +
           potential("k*x1^2/2 + K*(x2 - x1)^2/2 + k*x2^2/2"),
       {"T~ = 1/2 m (x1_dot^2 + x2_dot^2)", "U~ = 1/2 k x1^2 + 1/2 K (x2 - x1)^2 + 1/2 k x2^2"},
       {"m x1_ddot + (k + K) x1 - K x2 = 0", "m x2_ddot - K x1 + (k + K) x2 = 0"}},
      {"physical pendulum",
       "m = 1\na = 1\nJ = 1\ng = 9.81\n",
       coordinates({"theta"}) + body("\"J\"", "theta", "\"a*sin(theta)\", \"-a*cos(theta)\", 0") + weight,
       {"T~ = 1/2 m a^2 theta_dot^2 + 1/2 J theta_dot^2", "U~ = -m a g cos(theta)"},
       {"(m a^2 + J) theta_ddot + m a g sin(theta) = 0"}},
      {"cylinder on an incline",
       "m = 1\nR = 1\nalpha = 0.3\ng = 9.81\n",
       coordinates({"s"}) + body("\"m*R^2/2\"", "-s/R", "\"s*cos(alpha)\", \"-s*sin(alpha)\", 0") + weight,
       {"T~ = 3/4 m s_dot^2", "U~ = -m g s sin(alpha)"},
       {"3/2 m s_ddot - m g sin(alpha) = 0"}},
      {"sphere on an incline",
       "m = 1\nR = 1\nalpha = 0.3\ng = 9.81\n",
       coordinates({"s"}) + body("{ sphere = \"R\" }", "-s/R", "\"s*cos(alpha)\", \"-s*sin(alpha)\", 0") + weight,
       {"T~ = 7/10 m s_dot^2", "U~ = -m g s sin(alpha)"},
       {"7/5 m s_ddot - m g sin(alpha) = 0"}},
      {"sliding ladder",
       "m = 1\nL = 1\ng = 9.81\n",
       coordinates({"theta"}) + body("\"m*L^2/12\"", "theta", "\"L/2*sin(theta)\", \"L/2*cos(theta)\", 0") + weight,
       {"T~ = 1/6 m L^2 theta_dot^2", "U~ = 1/2 m L g cos(theta)"},
       {"1/3 m L^2 theta_ddot - 1/2 m L g sin(theta) = 0"}},
      {"pendulum on a driven support",
       "m = 1\nl = 1\na = 1\nw = 1\ng = 9.81\n",
       coordinates({"theta"}) + particle("P", "m", "\"a*cos(w*t) + l*sin(theta)\", \"-l*cos(theta)\", 0") + weight,
       {"T~ = 1/2 m l^2 theta_dot^2 - m l a w sin(w t) cos(theta) theta_dot + 1/2 m a^2 w^2 sin^2(w t)",
        "U~ = -m l g cos(theta)"},
       {"m l^2 theta_ddot - m l a w^2 cos(w t) cos(theta) + m l g sin(theta) = 0"}},
      {"particle in a cone",
       "m = 1\nalpha = 0.5\ng = 9.81\n",
       coordinates({"r", "phi"}) +
           particle("P", "m", "\"r*sin(alpha)*cos(phi)\", \"r*sin(alpha)*sin(phi)\", \"r*cos(alpha)\"") +
           weight_in_space,
       {"T~ = 1/2 m (r_dot^2 + r^2 sin^2(alpha) phi_dot^2)", "U~ = m g r cos(alpha)"},
       {"m r_ddot - m r sin^2(alpha) phi_dot^2 + m g cos(alpha) = 0",
        "m r^2 sin^2(alpha) phi_ddot + 2 m r sin^2(alpha) r_dot phi_dot = 0"}},
      {"two masses on a string through a hole",
       "m1 = 1\nm2 = 1\nl = 3\ng = 9.81\n",
       coordinates({"r", "theta"}) + particle("A", "m1", "\"r*cos(theta)\", \"r*sin(theta)\", 0") +
           particle("B", "m2", "0, 0, \"r - l\"") + weight_in_space,
       {"T~ = 1/2 (m1 + m2) r_dot^2 + 1/2 m1 r^2 theta_dot^2"},
       {"(m1 + m2) r_ddot - m1 r theta_dot^2 + m2 g = 0", "m1 r^2 theta_ddot + 2 m1 r r_dot theta_dot = 0"}},
      {"particle in a rotating frame",
       "m = 1\nw = 1\nk = 1\n",
       coordinates({"x", "y"}) + particle("P", "m", "\"x*cos(w*t) - y*sin(w*t)\", \"x*sin(w*t) + y*cos(w*t)\", 0") +
           potential("k*(x^2 + y^2)/2"),
       {"T~ = 1/2 m (x_dot^2 + y_dot^2) - m w (y x_dot - x y_dot) + 1/2 m w^2 x^2 + 1/2 m w^2 y^2"},
       {"m x_ddot - 2 m w y_dot - (m w^2 - k) x = 0", "m y_ddot + 2 m w x_dot - (m w^2 - k) y = 0"}},
      {"bead on a cycloid",
       "m = 1\na = 1\ng = 9.81\n",
       coordinates({"theta"}) + particle("P", "m", "\"a*(theta - sin(theta))\", \"a*(1 + cos(theta))\", 0") + weight,
       {"T~ = m a^2 (1 - cos(theta)) theta_dot^2", "U~ = m a g cos(theta) + m a g"},
       {"2 m a^2 (1 - cos(theta)) theta_ddot + m a^2 sin(theta) theta_dot^2 - m a g sin(theta) = 0"}},
  };
}

/// Springs with a natural length, alone, between bodies, in space and beside others.
std::vector<Textbook> springs() {
  return {
      {"two masses on a line",
       "m1 = 1\nm2 = 1\nk1 = 1\nk2 = 1\nl1 = 1\nl2 = 1\n",
       coordinates({"x1", "x2"}) + particle("A", "m1", "\"x1\", 0, 0") + particle("B", "m2", "\"x2\", 0, 0") +
           potential("k1*(x1 - l1)^2/2 + k2*(x2 - x1 - l2)^2/2"),
       {"U~ = 1/2 k1 (x1 - l1)^2 + 1/2 k2 (x2 - x1 - l2)^2"},
       {"m1 x1_ddot + k1 (x1 - l1) - k2 (x2 - x1 - l2) = 0", "m2 x2_ddot + k2 (x2 - x1 - l2) = 0"}},
      {"two equal springs, whose lengths cancel between them",
       "m = 1\nk = 1\na = 1\n",
       coordinates({"x1", "x2"}) + particle("A", "m", "\"x1\", 0, 0") + particle("B", "m", "\"x2\", 0, 0") +
           potential("k*(x1 - a)^2/2 + k*(x2 - x1 - a)^2/2"),
       {"U~ = 1/2 k (x1 - a)^2 + 1/2 k (x2 - x1 - a)^2"},
       {"m x1_ddot + 2 k x1 - k x2 = 0", "m x2_ddot + k (x2 - x1 - a) = 0"}},
      {"two masses and a spring without length",
       "m = 1\nM = 1\nk = 1\n",
       coordinates({"x1", "x2"}) + particle("A", "m", "\"x1\", 0, 0") + particle("B", "M", "\"x2\", 0, 0") +
           potential("k*(x2 - x1)^2/2"),
       {"U~ = 1/2 k (x2 - x1)^2"},
       {"m x1_ddot - k (x2 - x1) = 0", "M x2_ddot + k (x2 - x1) = 0"}},
      {"hardening spring",
       "m = 1\nk = 1\nc = 1\nl0 = 1\n",
       coordinates({"r"}) + particle("P", "m", "\"r\", 0, 0") + potential("k*(r - l0)^2/2 + c*(r - l0)^4/4"),
       {"U~ = 1/4 c (r - l0)^4 + 1/2 k (r - l0)^2"},
       {"m r_ddot + c (r - l0)^3 + k (r - l0) = 0"}},
      {"torsion springs of two links",
       "I = 1\nJ = 1\nk = 1\nK = 1\ntheta0 = 1\n",
       coordinates({"theta1", "theta2"}) + "[energy]\nkinetic = \"I*theta1_dot^2/2 + J*theta2_dot^2/2\"\n"
                                           "potential = \"k*(theta1 - theta0)^2/2 + K*(theta2 - theta1)^2/2\"\n",
       {"U~ = 1/2 k (theta1 - theta0)^2 + 1/2 K (theta2 - theta1)^2"},
       {"I theta1_ddot + k (theta1 - theta0) - K (theta2 - theta1) = 0", "J theta2_ddot + K (theta2 - theta1) = 0"}},
      {"mass on a turntable",
       "m = 1\nw = 1\nk = 1\nl0 = 1\n",
       coordinates({"r"}) + particle("P", "m", "\"r*cos(w*t)\", \"r*sin(w*t)\", 0") + potential("k*(r - l0)^2/2"),
       {"U~ = 1/2 k (r - l0)^2"},
       {"m r_ddot - m w^2 r + k (r - l0) = 0"}},
      {"cart on a spring with a pendulum",
       "M = 1\nm = 1\nk = 1\nl = 1\nx0 = 1\ng = 9.81\n",
       coordinates({"x", "theta"}) + particle("C", "M", "\"x\", 0, 0") +
           particle("P", "m", "\"x + l*sin(theta)\", \"-l*cos(theta)\", 0") + weight + potential("k*(x - x0)^2/2"),
       {"U~ = 1/2 k (x - x0)^2 - m l g cos(theta)"},
       {"(M + m) x_ddot + m l cos(theta) theta_ddot - m l sin(theta) theta_dot^2 + k (x - x0) = 0",
        "m l cos(theta) x_ddot + m l^2 theta_ddot + m l g sin(theta) = 0"}},
      {"parallel springs",
       "m = 1\nk1 = 1\nk2 = 1\na = 1\n",
       coordinates({"x"}) + particle("P", "m", "\"x\", 0, 0") + potential("k1*(x - a)^2/2 + k2*(a - x)^2/2"),
       {"U~ = 1/2 (k1 + k2) (x - a)^2"},
       {"m x_ddot + (k1 + k2) (x - a) = 0"}},
      {"spring in space, by two points",
       "m = 1\nk = 1\nl0 = 1\na = 1\n",
       "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n"
       "[[point]]\nname = \"O\"\nposition = \"a*E1\"\n"
       "[[force]]\nspring = { stiffness = \"k\", length = \"l0\", between = [\"P\", \"O\"] }\n",
       {"U~ = 1/2 k (s - l0)^2"},
       {"m x_ddot + k (s - l0) (x - a)/s = 0", "m y_ddot + k y (s - l0)/s = 0"}},
      {"spring as a force law",
       "m = 1\nk = 1\nc = 1\nl0 = 1\n",
       coordinates({"x"}) + particle("P", "m", "\"x\", 0, 0") +
           "[[force]]\non = \"P\"\nforce = \"-(k*(x - l0) + c*x_dot)*E1\"\n",
       {"U~ = 0"},
       {"m x_ddot = -c x_dot - k (x - l0)"}},
  };
}

model::Model read(const std::string& parameters, const std::string& body) {
  return model::read_model_text("format = 1\n[parameters]\n" + parameters + body, "book.toml");
}

std::vector<std::string> texts(const std::vector<print::PrintedFormula>& items, const std::string& key) {
  std::vector<std::string> result;
  for (const print::PrintedFormula& item : items) {
    if (item.key == key) result.push_back(item.text);
  }
  return result;
}

std::string in_lines(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& line : list) text += "\n" + line;
  return text;
}

bool contains(const std::vector<std::string>& list, const std::string& line) {
  return std::find(list.begin(), list.end(), line) != list.end();
}

void compare(const std::vector<Textbook>& systems) {
  for (const Textbook& book : systems) {
    CAPTURE(book.name);
    const mechanics::Mechanics m = mechanics::build_mechanics(read(book.parameters, book.body));
    const auto items =
        print::render(m, reading::derive_display_form(m, system::Approach::two), {"energies", "equations"});
    const std::vector<std::string> energies = texts(items, "energies");
    for (const std::string& line : book.energies) {
      CAPTURE(in_lines(energies));
      CHECK_MESSAGE(contains(energies, line), line);
    }
    CHECK(texts(items, "explicit") == book.equations);
  }
}

}  // namespace

TEST_CASE("textbooks: twenty systems have the energies and equations that books print") {
  CHECK(systems().size() == 20);
  compare(systems());
}

TEST_CASE("textbooks: springs keep the bracket of their extension in energies and equations") { compare(springs()); }

TEST_CASE("textbooks: Routh's function and the reduced equation of the symmetric top are fractions with factors") {
  const mechanics::Mechanics m = mechanics::build_mechanics(
      read("m = 1\nl = 1\nI = 1\nC = 1\ng = 9.81\n",
           "[[body]]\nname = \"T\"\nmass = \"m\"\ninertia = { principal = [\"I\", \"I\", \"C\"] }\n"
           "rotation = { euler = \"313\", angles = [\"phi\", \"theta\", \"psi\"] }\nposition = \"l*T.e3\"\n" +
               weight_in_space));
  reading::DisplayForms forms(m);
  const std::vector<std::string> routh = texts(print::render_routh(m, forms.routh({0, 2})), "routh");
  CAPTURE(in_lines(routh));
  CHECK(contains(routh, "phi_dot = (p_phi - p_psi cos(theta))/(sin^2(theta) (m l^2 + I))"));
  CHECK(contains(routh,
                 "Routhian = 1/2 (m l^2 + I) theta_dot^2 - m l g cos(theta) - p_psi^2/(2 C) - "
                 "(p_phi - p_psi cos(theta))^2/(2 sin^2(theta) (m l^2 + I))"));
  CHECK(contains(routh,
                 "(m l^2 + I) theta_ddot - m l g sin(theta) + (p_psi - p_phi cos(theta)) (p_phi - p_psi "
                 "cos(theta))/(sin^3(theta) (m l^2 + I)) = 0"));
}

TEST_CASE("textbooks: the length of a spring between two pendulums has a letter") {
  const mechanics::Mechanics m = mechanics::build_mechanics(read(
      "m = 1\nL = 1\nk = 1\nd = 1\ng = 9.81\n",
      coordinates({"theta1", "theta2"}) + particle("A", "m", "\"L*sin(theta1)\", \"-L*cos(theta1)\", 0") +
          particle("B", "m", "\"d + L*sin(theta2)\", \"-L*cos(theta2)\", 0") + weight +
          "[[force]]\nname = \"spring\"\nspring = { stiffness = \"k\", length = \"d\", between = [\"A\", \"B\"] }\n"));
  const auto items =
      print::render(m, reading::derive_display_form(m, system::Approach::two), {"energies", "equations"});
  for (const char* key : {"energies", "equations", "explicit"}) {
    for (const std::string& line : texts(items, key)) CHECK(line.find("sqrt") == std::string::npos);
  }
  CHECK(texts(items, "energies").back() == "U~ = 1/2 k (s - d)^2 - m L g cos(theta1) - m L g cos(theta2)");
  CHECK(texts(items, "explicit")[0] ==
        "m L^2 theta1_ddot + m L g sin(theta1) + L k (L sin(theta1 - theta2) - d cos(theta1)) (s - d)/s = 0");
  const std::vector<std::string> parts = texts(items, "parts");
  REQUIRE(parts.size() == 1);
  CHECK(parts[0] == "s = sqrt(2 L d sin(theta2) - 2 L d sin(theta1) - 2 L^2 cos(theta1 - theta2) + 2 L^2 + d^2)");
}

TEST_CASE("textbooks: solved equations use the letter of a spring's length, and its bracket") {
  const mechanics::Mechanics m = mechanics::build_mechanics(
      read("m = 1\nk = 1\nl0 = 1\na = 1\n",
           "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\"] }\n"
           "[[point]]\nname = \"O\"\nposition = \"a*E1\"\n"
           "[[force]]\nspring = { stiffness = \"k\", length = \"l0\", between = [\"P\", \"O\"] }\n"));
  reading::DisplayForms forms(m);
  const reading::SolvedForm solved = forms.solved(reading::FrictionMode::given);
  const auto items = print::render_solved(m, solved);
  CHECK(texts(items, "solved") ==
        std::vector<std::string>{"x_ddot = -k (s - l0) (x - a)/(m s)", "y_ddot = -k y (s - l0)/(m s)"});
  CHECK(texts(items, "parts") == std::vector<std::string>{"s = sqrt(x^2 - 2 a x + y^2 + a^2)"});

  print::LengthLetters letters;  // a letter that was defined above is not defined again
  print::render(m, forms(system::Approach::two), {"equations"}, nullptr, &letters);
  CHECK(texts(print::render_solved(m, solved, &letters), "parts").empty());
}

TEST_CASE("textbooks: an entry of the mass matrix is written alike in both of its equations") {
  const mechanics::Mechanics m = mechanics::build_mechanics(
      read("m1 = 1\nm2 = 1\nm3 = 1\ng = 9.81\n", coordinates({"x", "y"}) + particle("A", "m1", "0, \"-x\", 0") +
                                                     particle("B", "m2", "1, \"x - y\", 0") +
                                                     particle("C", "m3", "2, \"x + y\", 0") + weight));
  const auto items = print::render(m, reading::derive_display_form(m, system::Approach::two), {"equations"});
  CHECK(texts(items, "equations") ==
        std::vector<std::string>{"d/dt((m1 + m2 + m3) x_dot + (m3 - m2) y_dot) - (m1 - m2 - m3) g = 0",
                                 "d/dt((m3 - m2) x_dot + (m2 + m3) y_dot) - (m2 - m3) g = 0"});
  CHECK(texts(items, "explicit") ==
        std::vector<std::string>{"(m1 + m2 + m3) x_ddot + (m3 - m2) y_ddot - (m1 - m2 - m3) g = 0",
                                 "(m3 - m2) x_ddot + (m2 + m3) y_ddot - (m2 - m3) g = 0"});
}

TEST_CASE(
    "textbooks: a rolling disk by its shape reads as by its point, without |sin|, unless a range says otherwise") {
  const auto lines_of = [](const std::string& contact, const std::string& range) {
    const mechanics::Mechanics m = mechanics::build_mechanics(
        read("m = 1\nR = 1\ng = 9.81\n", range +
                                             "[[body]]\nname = \"D\"\nmass = \"m\"\ninertia = { disk = \"R\" }\n"
                                             "rotation = { euler = \"313\", angles = [\"phi\", \"theta\", \"psi\"] }\n"
                                             "position = { cartesian = [\"x\", \"y\", \"z\"] }\n" +
                                             weight_in_space +
                                             "[[constraint]]\nname = \"rolling\"\nrolling = { body = \"D\", on = "
                                             "\"ground\", " +
                                             contact + " }\n"));
    const reading::DisplayForm form = reading::derive_display_form(m, system::Approach::one);
    std::vector<std::string> lines = texts(print::render(m, form, {"constraints"}), "constraints");
    for (const std::string& line : texts(print::render(m, form, {"equations"}), "equations")) lines.push_back(line);
    return lines;
  };
  const std::string shape = "shape = { disk = \"R\" }";
  const std::vector<std::string> lines = lines_of(shape, "");
  CAPTURE(in_lines(lines));
  CHECK(contains(lines, "Psi_3 = z - R sin(theta) = 0"));
  CHECK(lines == lines_of("at = \"-R*D.e2''\"", ""));
  const std::vector<std::string> wide = lines_of(shape, "[coordinates]\ntheta = { range = [\"-pi\", \"pi\"] }\n");
  CHECK(contains(wide, "Psi_3 = z - R abs(sin(theta)) = 0"));
  CHECK(contains(wide, "-R cos(theta) sign(sin(theta)) theta_dot + z_dot = 0"));
  for (const std::string& line : wide) CHECK(line.find("/abs") == std::string::npos);
}

TEST_CASE("textbooks: a root whose value a constraint gives is written with that value") {
  const auto lines_of = [](const std::string& constraint, const std::vector<std::string>& keys) {
    const mechanics::Mechanics m = mechanics::build_mechanics(
        read("m = 1\nL = { value = 1, positive = true }\nk = 1\ng = 9.81\n",
             "[[particle]]\nname = \"P\"\nmass = \"m\"\n"
             "position = { cartesian = [\"x\", \"y\", \"z\"] }\n" +
                 weight_in_space +
                 "[[force]]\nname = \"spring\"\nspring = { stiffness = \"k\", length = \"L/2\","
                 " between = [\"origin\", \"P\"] }\n"
                 "[[constraint]]\nname = \"rod\"\nholonomic = \"" +
                 constraint + "\"\n"));
    std::vector<std::string> lines;
    for (const auto& item : print::render(m, reading::derive_display_form(m, system::Approach::one), keys))
      lines.push_back(item.text);
    return lines;
  };
  for (const char* constraint : {"sqrt(x^2 + y^2 + z^2) - L", "2*L - 2*sqrt(z^2 + x^2 + y^2)"}) {
    const std::vector<std::string> lines = lines_of(constraint, {"equations", "constraints", "reactions"});
    CAPTURE(in_lines(lines));
    std::size_t roots = 0;
    for (const std::string& line : lines) roots += line.find("sqrt") != std::string::npos ? 1 : 0;
    CHECK(roots == 1);  // the constraint itself
  }
  const std::vector<std::string> lines = lines_of("sqrt(x^2 + y^2 + z^2) - L", {"equations"});
  CAPTURE(in_lines(lines));
  CHECK(contains(lines, "m x_ddot + 1/2 k x = lambda x/L"));
  // The length of the spring follows from the square as well; another length does not.
  CHECK(contains(lines_of("x^2 + y^2 + z^2 - L^2", {"equations"}), "m x_ddot + 1/2 k x = 2 lambda x"));
  bool has_root = false;
  for (const std::string& line : lines_of("x^2 + y^2 - L^2", {"equations"}))
    has_root = has_root || line.find("sqrt") != std::string::npos;
  CHECK(has_root);
}

TEST_CASE("textbooks: names of several letters stay apart in a product") {
  const mechanics::Mechanics m = mechanics::build_mechanics(read(
      "Ja = 1\nspin = 2\nm = 1\n", coordinates({"x"}) + particle("P", "m", "\"x\", 0, 0") + potential("Ja*spin*m*x")));
  std::string latex;
  for (const auto& item : print::render(m, reading::derive_display_form(m, system::Approach::one), {"energies"}))
    latex += item.latex + "\n";
  CAPTURE(latex);
  CHECK(latex.find("\\mathrm{Ja}\\, \\mathrm{spin}") != std::string::npos);
}
