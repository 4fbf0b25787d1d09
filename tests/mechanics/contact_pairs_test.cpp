// SPDX-License-Identifier: GPL-3.0-or-later
// Every pair of a shape and what it touches: gap, normal velocity and slip of the material points against distances
// that a search finds and against differences of poses. No formula of the generator is used.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <tuple>

#include "error.hpp"
#include "mechanics/mechanics.hpp"
#include "model/contact_shapes.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;

namespace {

using V = std::array<double, 3>;
V operator+(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V operator-(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V operator*(double s, const V& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const V& a) { return std::sqrt(dot(a, a)); }

/// A body: position and Euler parameters.
struct Pose {
  std::array<double, 7> q{};

  V turned(const V& v) const {  // Rodrigues' formula: v + 2 e x (e x v + e0 v)
    const V e{q[4], q[5], q[6]};
    const auto cross = [](const V& a, const V& b) {
      return V{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    return v + 2.0 * cross(e, cross(e, v) + q[3] * v);
  }
  V at(const V& v) const { return V{q[0], q[1], q[2]} + turned(v); }
  V back(const V& p) const {
    Pose inverse = *this;
    for (std::size_t k = 4; k < 7; ++k) inverse.q[k] = -q[k];
    return inverse.turned(p - V{q[0], q[1], q[2]});
  }
};

/// The least value of a convex function.
double least(const std::function<double(double)>& f, double low, double high, double* at = nullptr) {
  for (int i = 0; i < 90; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  if (at != nullptr) *at = (low + high) / 2;
  return f((low + high) / 2);
}

/// What the test knows of a shape: in its body, the core as points of two numbers, and the radius about it.
struct Shape {
  const char* text;
  double radius;
  double length = 0, disk = 0;
  V point{};

  V core(double s, double t) const {  // s, t in [-1, 1]
    return point + V{disk * s, disk * t * std::sqrt(1 - s * s), length / 2 * s};
  }
};
const Shape heel{"points = { heel = \"0.3*A.e1 - 0.1*A.e2 + 0.2*A.e3\" }", 0, 0, 0, {0.3, -0.1, 0.2}},
    ball{"sphere = 0.3", 0.3}, capsule{"capsule = [0.2, 0.9]", 0.2, 0.9}, disk{"disk = 0.6", 0, 0, 0.6};

/// The nearest point of a core by a convex distance, and that distance.
double nearest(const Shape& shape, const Pose& pose, const std::function<double(const V&)>& distance, V& found) {
  double s = 0, t = 0;
  const auto row = [&](double at, double* where) {
    if (shape.disk == 0) return distance(pose.at(shape.core(at, 0)));
    return least([&](double x) { return distance(pose.at(shape.core(at, x))); }, -1, 1, where);
  };
  if (shape.disk > 0 || shape.length > 0) least([&](double at) { return row(at, nullptr); }, -1, 1, &s);
  const double result = row(s, &t);
  found = pose.at(shape.core(s, t));
  return result;
}

/// The other side: its text, and the distance of a point from it. `inside`: a shell.
struct Other {
  std::string text;
  std::function<double(const V&, const Pose&)> distance;
  bool moves = false, inside = false;
};

constexpr double R = 0.7, half_angle = 0.5;
const V centre{0.2, 0.1, -0.1};

double from_line(const V& p) {  // through `centre` along E1 + E3, by a search
  return least([&](double s) { return norm(p - centre - s * V{1, 0, 1}); }, -20, 20) - R;
}
double from_cone(const V& p) {  // the tip at `centre`, open along -E3
  const V d = p - centre;
  const double rho = std::hypot(d[0], d[1]), h = -d[2];
  const double apart =
      least([&](double t) { return std::hypot(rho - t * std::sin(half_angle), h - t * std::cos(half_angle)); }, 0, 20);
  return std::atan2(rho, h) < half_angle ? -apart : apart;
}
double from_shape(const Shape& shape, const V& p, const Pose& pose) {
  V unused;
  return nearest(
             shape, pose, [&](const V& at) { return norm(p - at); }, unused) -
         shape.radius;
}

Other obstacle(const std::string& name) {
  if (name == "sphere")
    return {"{ sphere = 0.7, centre = \"0.2*E1 + 0.1*E2 - 0.1*E3\" }",
            [](const V& p, const Pose&) { return norm(p - centre) - R; }};
  if (name == "hollow")
    return {"{ hollow = 5, centre = \"0.2*E1 + 0.1*E2 - 0.1*E3\" }",
            [](const V& p, const Pose&) { return 5 - norm(p - centre); }, false, true};
  if (name == "cylinder")
    return {"{ cylinder = 0.7, point = \"0.2*E1 + 0.1*E2 - 0.1*E3\", axis = \"2*E1 + 2*E3\" }",
            [](const V& p, const Pose&) { return from_line(p); }};
  if (name == "cone")
    return {"{ cone = 0.5, apex = \"0.2*E1 + 0.1*E2 - 0.1*E3\", axis = \"-2*E3\" }",
            [](const V& p, const Pose&) { return from_cone(p); }};
  return {"", nullptr};
}
Other of_body(const Shape& shape) {
  return {fmt::format("\"B\"\nshape_b = {{ {} }}", shape.text),
          [shape](const V& p, const Pose& pose) { return from_shape(shape, p, pose); }, true};
}

std::string model_of(const std::string& contact) {
  const auto body = [](const std::string& n) {
    return fmt::format(
        "[[body]]\nname = \"{0}\"\nmass = 2\ninertia = {{ principal = [0.1, 0.2, 0.3] }}\nposition = {{ cartesian = "
        "[\"x{0}\", \"y{0}\", \"z{0}\"] }}\nrotation = {{ euler_parameters = [\"p{0}\", \"q{0}\", \"r{0}\", \"s{0}\"] "
        "}}\n",
        n);
  };
  return "format = 1\n" + body("A") + body("B") + "[[contact]]\nname = \"c\"\n" + contact +
         "\nfriction = { static = 0.5, dynamic = 0.4 }\n";
}
std::string model_of(const Shape& shape, const Other& other) {
  const std::string text = shape.point[0] == 0 ? fmt::format("shape = {{ {} }}", shape.text) : shape.text;
  return model_of(fmt::format("body = \"A\"\n{}\non = {}", text, other.text));
}

struct Motion {
  Pose a, b;
  std::array<double, 14> rates{};

  std::pair<Pose, Pose> after(double t) const {
    std::pair<Pose, Pose> result{a, b};
    for (std::size_t k = 0; k < 7; ++k) result.first.q[k] += t * rates[k], result.second.q[k] += t * rates[7 + k];
    for (Pose* pose : {&result.first, &result.second}) {
      double square = 0;
      for (std::size_t k = 3; k < 7; ++k) square += pose->q[k] * pose->q[k];
      for (std::size_t k = 3; k < 7; ++k) pose->q[k] /= std::sqrt(square);
    }
    return result;
  }
};
Motion random_motion(std::mt19937& random, double spread) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Motion m;
  for (std::size_t k = 0; k < 7; ++k) m.a.q[k] = uniform(random), m.b.q[k] = uniform(random);
  for (std::size_t k = 0; k < 3; ++k) m.a.q[k] *= spread;
  m.rates = {};
  std::tie(m.a, m.b) = m.after(0);
  for (double& rate : m.rates) rate = uniform(random);
  for (std::size_t body = 0; body < 2; ++body) {  // rates of Euler parameters are across them
    const Pose& pose = body == 0 ? m.a : m.b;
    double along = 0;
    for (std::size_t k = 3; k < 7; ++k) along += pose.q[k] * m.rates[7 * body + k];
    for (std::size_t k = 3; k < 7; ++k) m.rates[7 * body + k] -= along * pose.q[k];
  }
  return m;
}

using Named = std::map<std::string, double>;

/// Values of expressions in this motion. nearest: of coordinates that follow a nearest point.
std::vector<double> values(const mechanics::Mechanics& m, const std::vector<symbolic::Ref>& of, const Motion& motion,
                           const Named& nearest = {}) {
  static const std::string letters = "xyzpqrs";
  return symbolic::evaluate(*m.dag, of, [&](const symbolic::Symbol& s) -> double {
    if (s.kind != symbolic::SymbolKind::coordinate) return std::nan("");
    const std::string& name = m.model->coordinates[s.index].name;
    const auto found = nearest.find(name);
    if (found != nearest.end()) return s.order == 0 ? found->second : 0;
    const std::size_t k = letters.find(name[0]) + (name[1] == 'B' ? 7 : 0);
    if (s.order == 1) return motion.rates[k];
    return k < 7 ? motion.a.q[k] : motion.b.q[k - 7];
  });
}

struct Seen {
  double gap, normal_velocity;
  V slip;
};
Seen by_generator(const mechanics::Mechanics& m, const mechanics::Contact& contact, const Motion& motion,
                  const Named& nearest = {}) {
  std::vector<symbolic::Ref> of{m.constraints[contact.constraints[0]].psi};
  for (const symbolic::Ref f : m.constraints[contact.constraints[0]].gradient) of.push_back(f);
  for (const symbolic::Ref w : contact.slip) of.push_back(w);
  for (const auto& t : contact.directions) of.insert(of.end(), t.begin(), t.end());
  const std::vector<double> v = values(m, of, motion, nearest);
  const std::size_t n = m.q.size();
  std::vector<symbolic::Ref> rates(m.qdot.begin(), m.qdot.end());
  const std::vector<double> qdot = values(m, rates, motion, nearest);
  Seen result{v[0], 0, {}};
  for (std::size_t i = 0; i < n; ++i) result.normal_velocity += v[1 + i] * qdot[i];
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) result.slip[axis] += v[1 + n + k] * v[3 + n + 3 * k + axis];
  return result;
}
/// The nearest of the contacts of a pair, as the generator states it.
Seen by_generator(const mechanics::Mechanics& m, const Motion& motion) {
  Seen result{1e9, 0, {}};
  for (const mechanics::Contact& contact : m.contacts) {
    const Seen seen = by_generator(m, contact, motion);
    if (seen.gap < result.gap) result = seen;
  }
  return result;
}

/// By a search for the nearest points, whose velocities are differences of poses.
Seen by_search(const Shape& shape, const Other& other, const Motion& motion) {
  const auto distance = [&](const V& p) { return other.distance(p, motion.b); };
  V p;
  double gap = 1e9;
  if (!other.inside) {
    gap = nearest(shape, motion.a, distance, p);
  } else {  // the farthest of the ends, of the point, or of many points of the rim
    const int count = shape.disk > 0 ? 4000 : 2;
    double best = 0;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * M_PI * i / count;
      const auto at = [&](double x) {
        return motion.a.at(shape.disk > 0 ? V{shape.disk * std::cos(x), shape.disk * std::sin(x), 0}
                                          : shape.core(i == 0 ? -1 : 1, 0));
      };
      if (distance(at(angle)) >= gap) continue;
      gap = distance(at(angle)), best = angle, p = at(angle);
      if (shape.disk > 0) {
        least([&](double x) { return distance(at(x)); }, angle - 0.01, angle + 0.01, &best);
        gap = distance(at(best)), p = at(best);
      }
    }
  }
  V n{};
  const double h = 1e-5;
  for (std::size_t k = 0; k < 3; ++k) {
    V step{};
    step[k] = h;
    n[k] = (distance(p + step) - distance(p - step)) / (2 * h);
  }
  const V own = p - shape.radius * n, met = p - gap * n, a = motion.a.back(own), b = motion.b.back(met);
  const auto [a1, b1] = motion.after(h);
  const auto [a0, b0] = motion.after(-h);
  V v = 1 / (2 * h) * (a1.at(a) - a0.at(a));
  if (other.moves) v = v - 1 / (2 * h) * (b1.at(b) - b0.at(b));
  return {gap - shape.radius, dot(n, v), v - dot(n, v) * n};
}

int compare(const std::string& text, const Shape& shape, const Other& other, double spread) {
  CAPTURE(text);
  const mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(text, "c.toml"));
  std::mt19937 random(7);
  int compared = 0;
  for (int i = 0; i < 60 && compared < 20; ++i) {
    const Motion motion = random_motion(random, spread);
    const Seen expected = by_search(shape, other, motion), seen = by_generator(m, motion);
    if (expected.gap < 0.02) continue;  // shapes that overlap have no nearest points
    ++compared;
    CAPTURE(i);
    CHECK(std::abs(seen.gap - expected.gap) < 1e-10);
    CHECK(std::abs(seen.normal_velocity - expected.normal_velocity) < 2e-5);  // places of least distances: 1e-7
    CHECK(norm(seen.slip - expected.slip) < 2e-5);
  }
  return compared;
}

/// The rim of a disk, whose nearest point a coordinate follows.
int compare_rim(const std::string& text, const Shape& shape, const Other& other) {
  CAPTURE(text);
  const mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(text, "c.toml"));
  std::mt19937 random(7);
  int compared = 0;
  for (int i = 0; i < 60 && compared < 20; ++i) {
    const Motion motion = random_motion(random, 3);
    const auto at = [&](double x) {
      return other.distance(motion.a.at({shape.disk * std::cos(x), shape.disk * std::sin(x), 0}), motion.b);
    };
    double best = 0;
    for (int k = 0; k < 400; ++k)
      if (at(0.0157 * k) < at(best)) best = 0.0157 * k;
    least(at, best - 0.02, best + 0.02, &best);
    if (at(best) < 0.02) continue;
    ++compared;
    const Shape touching{"", 0, 0, 0, {shape.disk * std::cos(best), shape.disk * std::sin(best), 0}};
    const Seen expected = by_search(touching, other, motion);
    const Named nearest{{"c_1_phi", best}, {"c_1_room", 0}};
    const Seen seen = by_generator(m, m.contacts[0], motion, nearest);
    CAPTURE(i);
    CHECK(std::abs(seen.gap - expected.gap) < 1e-10);
    CHECK(std::abs(seen.normal_velocity - expected.normal_velocity) < 2e-5);
    CHECK(norm(seen.slip - expected.slip) < 2e-5);
    CHECK(std::abs(values(m, {m.constraints[0].psi}, motion, nearest)[0]) < 1e-6);
  }
  return compared;
}

double height(double x, double y) { return 0.3 * std::sin(2 * x) + 0.2 * y * y; }

/// Where a part of a shape that comes down along E3 meets the surface, and how far above it is.
struct Landing {
  double above, x, y, angle;
};
Landing land(const Shape& shape, const V& part, const Pose& pose) {
  const V c = pose.at(part);
  if (shape.disk > 0) {
    const auto rim = [&](double angle) {
      return pose.at({shape.disk * std::cos(angle), shape.disk * std::sin(angle), 0});
    };
    const auto above = [&](double angle) { return rim(angle)[2] - height(rim(angle)[0], rim(angle)[1]); };
    double best = 0;
    for (int i = 0; i < 1000; ++i)
      if (above(0.00628 * i) < above(best)) best = 0.00628 * i;
    const double result = least(above, best - 0.01, best + 0.01, &best);
    return {result, rim(best)[0], rim(best)[1], best};
  }
  const double r = shape.radius;
  double s = 0, t = 0;
  const auto above = [&](double u, double v) {
    return c[2] - height(c[0] + u, c[1] + v) - std::sqrt(std::max(0.0, r * r - u * u - v * v));
  };
  const auto row = [&](double u, double* at) {
    const double w = std::sqrt(r * r - u * u);
    return r == 0 ? above(0, 0) : least([&](double v) { return above(u, v); }, -w, w, at);
  };
  if (r > 0) least([&](double u) { return row(u, nullptr); }, -r, r, &s);
  const double result = row(s, &t);
  return {result, c[0] + s, c[1] + t, 0};
}

bool is_refused(const std::string& text, const char* what) {
  try {
    model::read_model_text(text, "c.toml");
  } catch (const Error& error) {
    return std::string(error.what()).find(what) != std::string::npos && !error.remedy().empty();
  }
  return false;
}

}  // namespace

TEST_CASE("contacts: gap and slip of every shape on every obstacle are those that a search finds") {
  for (const model::Obstacle& kind : model::obstacles()) {
    if (kind.nearest == nullptr) continue;
    const Other other = obstacle(kind.name);
    REQUIRE(other.distance != nullptr);
    for (const Shape& shape : {heel, ball, capsule, disk}) {
      const bool by_rim = shape.disk > 0 && kind.name != std::string("sphere") && !other.inside;
      if (by_rim) {
        CHECK(compare_rim(model_of(shape, other), shape, other) >= 10);
      } else {
        CHECK(compare(model_of(shape, other), shape, other, 3) >= 10);
      }
    }
  }
}

TEST_CASE("contacts: gap and slip of every shape on a shape of another body are those that a search finds") {
  std::size_t with_core = 0;
  for (const model::BodyShape& kind : model::body_shapes()) with_core += kind.core != nullptr ? 1 : 0;
  CHECK(with_core == 3);  // ball, capsule and disk below
  for (const Shape& shape : {heel, ball, capsule, disk}) {
    for (const Shape& met : {ball, capsule, disk}) {
      const Other other = of_body(met);
      const bool is_thin = met.radius + shape.radius == 0, is_rod_on_disk = met.disk > 0 && shape.length > 0;
      if (is_thin || is_rod_on_disk) {
        CHECK(is_refused(model_of(shape, other), "no closed form"));
      } else if (shape.disk > 0 && met.length > 0) {
        CHECK(compare_rim(model_of(shape, other), shape, other) >= 10);
      } else {
        CHECK(compare(model_of(shape, other), shape, other, 2) >= 10);
      }
    }
  }
}

TEST_CASE("contacts: pairs of capsules, balls and other shapes have the same gaps and slips, with friction") {
  const Other rod = of_body(capsule), round = of_body(ball);
  CHECK(compare(model_of("capsules = { A = [0.2, 0.9], B = 0.3 }"), capsule, round, 2) >= 10);
  CHECK(compare(model_of("capsules = { A = 0.3, B = [0.2, 0.9] }"), ball, rod, 2) >= 10);
  CHECK(compare(model_of("spheres = [\"A\", \"B\"]\nradius = 0.3"), ball, round, 2) >= 10);
  CHECK(compare(model_of("shapes = { A = { disk = 0.6 }, B = { sphere = 0.3 } }"), disk, round, 2) >= 10);
  CHECK(is_refused(model_of("shapes = { A = { cone = [1, 2] }, B = { sphere = 0.3 } }"), "touches planes only"));
}

TEST_CASE("contacts: shapes touch a surface z = f(x, y) where they meet it on their way down") {
  const Other surface{"{ surface = \"0.3*sin(2*x) + 0.2*y^2\" }", nullptr};
  for (const Shape& shape : {heel, ball, capsule, disk}) {
    const std::string text = model_of(shape, surface);
    CAPTURE(text);
    const mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(text, "c.toml"));
    REQUIRE(m.contacts.size() == (shape.length > 0 ? 2 : 1));
    std::mt19937 random(7);
    for (int i = 0; i < 15; ++i) {
      for (std::size_t k = 0; k < m.contacts.size(); ++k) {
        Motion motion = random_motion(random, 1);
        const V part = shape.length > 0 ? V{0, 0, k == 0 ? 0.45 : -0.45} : shape.point;
        const Landing landing = land(shape, part, motion.a);
        motion.a.q[2] -= landing.above;
        const double h = 1e-5, x = landing.x, y = landing.y;
        V n{-(height(x + h, y) - height(x - h, y)) / (2 * h), -(height(x, y + h) - height(x, y - h)) / (2 * h), 1};
        n = 1 / norm(n) * n;
        const V met{x, y, height(x, y)}, own = motion.a.back(met);
        const V v = 1 / (2 * h) * (motion.after(h).first.at(own) - motion.after(-h).first.at(own));
        const std::string name = m.contacts[k].name;
        const Named nearest{{name + "_x", x}, {name + "_y", y}, {name + "_phi", landing.angle}, {name + "_room", 0}};
        const Seen seen = by_generator(m, m.contacts[k], motion, nearest);
        CAPTURE(i);
        CHECK(std::abs(seen.gap) < 1e-9);
        const double slope = shape.point[0] == 0 ? 1 : 1 / n[2];  // the gap of points is their height
        CHECK(std::abs(seen.normal_velocity - slope * dot(n, v)) < 2e-5);
        CHECK(norm(seen.slip - (v - dot(n, v) * n)) < 2e-5);
        for (const mechanics::Constraint& c : m.constraints) {
          if (c.name.find(name) != 0 || c.unilateral) continue;
          const double psi = values(m, {c.psi}, motion, nearest)[0];
          if (c.name == name + "_near") {
            CHECK(psi < 0);  // less the room, which is positive
          } else {
            CHECK(std::abs(psi) < 1e-6);
          }
        }
      }
    }
  }
}
