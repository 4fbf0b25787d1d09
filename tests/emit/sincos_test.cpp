// SPDX-License-Identifier: GPL-3.0-or-later
// templates/kernels/sincos compared with CLN in 60 digits, compiled as users do.
#include <cln/real.h>
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "emit/examples.hpp"
#include "emit/kernels.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

/// Limit of angles; larger ones use the C library.
template <class Real>
constexpr Real far = sizeof(Real) == 4 ? 2048 : 65536;

template <class Real>
bool same_bits(Real a, Real b) {
  return std::isnan(a) ? std::isnan(b) : a == b && std::signbit(a) == std::signbit(b);
}

/// The kernel compiled with `flags`. The caller may change its text to simulate another processor or compiler.
template <class Real>
struct Kernel {
  Folder folder;
  void* handle = nullptr;
  void (*packed)(Real a, Real b, Real* sine, Real* cosine) = nullptr;
  explicit Kernel(const std::vector<std::string>& flags, const std::string& replace = "", const std::string& by = "") {
    const char* real = sizeof(Real) == 4 ? "float" : "double";
    std::string text = emit::sincos_kernel("k_", "static inline", "", sizeof(Real) == 4);
    for (std::size_t at = text.find(replace); !replace.empty() && at != std::string::npos;
         at = text.find(replace, at + by.size())) {
      text.replace(at, replace.size(), by);
    }
    const std::string source = folder.path + "/kernel.c", library = folder.path + "/kernel.so";
    // In a header, because clang warns about unused functions of a source file, and no test uses all of them.
    std::ofstream(folder.path + "/kernel.h") << "#include <float.h>\n#include <math.h>\n#include <string.h>\n" << text;
    std::ofstream(source) << "#include \"kernel.h\"\n"
                          << fmt::format(
                                 "void packed({0} a, {0} b, {0}* sine, {0}* cosine);\n"
                                 "void packed({0} a, {0} b, {0}* sine, {0}* cosine)\n"
                                 "{{\n  k_sincos(a, b, sine, cosine);\n}}\n",
                                 real);
    std::vector<std::string> command{EOMGEN_TEST_CC, "-std=c11", "-fPIC", "-shared", "-o", library};
    command.insert(command.end(), flags.begin(), flags.end());
    const std::string said = compiler_diagnostics(command, {source, "-lm"});
    CHECK(said == "");
    handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    REQUIRE((handle != nullptr));
    packed = reinterpret_cast<decltype(packed)>(::dlsym(handle, "packed"));
    REQUIRE((packed != nullptr));
  }
  ~Kernel() {
    if (handle != nullptr) ::dlclose(handle);
  }
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  std::pair<Real, Real> operator()(Real angle, Real other = 0) const {
    Real sine[2], cosine[2], exchanged[2], exchanged_cosine[2];
    packed(angle, other, sine, cosine);
    packed(other, angle, exchanged, exchanged_cosine);
    CHECK(same_bits(sine[0], exchanged[1]));
    CHECK(same_bits(cosine[0], exchanged_cosine[1]));
    return {sine[0], cosine[0]};
  }
};

/// The error in units of the last place.
template <class Real>
double ulps(Real got, const cln::cl_R& exact) {
  const Real nearest = std::abs(static_cast<Real>(cln::double_approx(exact)));
  const Real unit = std::nextafter(nearest, std::numeric_limits<Real>::infinity()) - nearest;
  return cln::double_approx(cln::abs(numeric::exact(static_cast<double>(got)) - exact) /
                            numeric::exact(static_cast<double>(unit)));
}
template <class Real>
double worst(const Kernel<Real>& kernel, Real angle) {
  const cln::cl_R x = cln::cl_float(numeric::exact(static_cast<double>(angle)), cln::float_format(60));
  const auto [sine, cosine] = kernel(angle);
  return std::max(ulps(sine, cln::sin(x)), ulps(cosine, cln::cos(x)));
}

template <class Real>
std::vector<Real> angles() {
  std::vector<Real> list;
  std::mt19937_64 random(1);
  for (const double reach : {1e-3, 0.8, 3.2, 20.0, 1e3, static_cast<double>(far<Real>)}) {
    std::uniform_real_distribution<double> within(-reach, reach);
    for (int i = 0; i < 1500; ++i) list.push_back(static_cast<Real>(within(random)));
  }
  // Near multiples of pi/4: there sines and cosines vanish, and the reduction changes quarters.
  const cln::cl_R quarter = cln::pi(cln::float_format(60)) / 4;
  for (int k = 1; k * 0.7853981633974483 < static_cast<double>(far<Real>); k += k < 400 ? 1 : 41) {
    const Real x = static_cast<Real>(cln::double_approx(k * quarter));
    for (const Real towards : {Real{0}, x, Real{1e9}}) list.push_back(std::nextafter(x, towards));
  }
  return list;
}

template <class Real>
std::vector<Real> special() {
  using Limits = std::numeric_limits<Real>;
  const Real inf = Limits::infinity(), tiny = Limits::denorm_min(), reach = far<Real>;
  return {Real{0},
          -Real{0},
          tiny,
          -tiny,
          Limits::min() / 4,
          Real(1e-30),
          reach,
          -reach,
          std::nextafter(reach, inf),
          2 * reach,
          -2 * reach,
          Real(1e22),
          -Real(1e22),
          Limits::max() / 8,
          Limits::max(),
          inf,
          -inf,
          Limits::quiet_NaN()};
}

}  // namespace

TEST_CASE_TEMPLATE("packed sincos: the error is below one unit in the last place up to the limit", Real, double,
                   float) {
  std::vector<std::vector<std::string>> flags = {{"-O2"}};
  // With fused multiply-add and wide registers if this machine has them.
  if (emit::run_process({EOMGEN_TEST_CC, "-march=native", "-E", "-x", "c", "/dev/null"}).status == 0)
    flags.push_back({"-O3", "-march=native"});
  for (const auto& set : flags) {
    const Kernel<Real> kernel(set);
    double largest = 0;
    Real where = 0;
    for (const Real angle : angles<Real>()) {
      const double error = worst(kernel, angle);
      if (error > largest) largest = error, where = angle;
    }
    CAPTURE(where);
    CHECK(largest < tolerances::packed_sincos_ulps);
    CHECK(largest > 0.4);  // the measurement is not trivial
  }
}

TEST_CASE_TEMPLATE(
    "packed sincos: zeros keep their sign, denormals are their own sine, what is large or not finite is the C "
    "library's",
    Real, double, float) {
  const Kernel<Real> kernel({"-O2"});
  for (const Real angle : special<Real>()) {
    CAPTURE(angle);
    const auto [sine, cosine] = kernel(angle);
    if (std::abs(angle) <= far<Real>) {
      CHECK(same_bits(kernel(-angle).first, -sine));
      CHECK(same_bits(kernel(-angle).second, cosine));
      const bool its_own_sine = std::abs(angle) < std::numeric_limits<Real>::min();  // CLN's floats underflow here
      CHECK((its_own_sine ? same_bits(sine, angle) && cosine == 1
                          : worst(kernel, angle) < tolerances::packed_sincos_ulps));
    } else {
      CHECK(same_bits(sine, std::sin(angle)));
      CHECK(same_bits(cosine, std::cos(angle)));
    }
  }
}

TEST_CASE_TEMPLATE("packed sincos: the bits do not depend on the other angle or on optimisation", Real, double, float) {
  const Kernel<Real> kernel({"-O2"}), unoptimised({"-O0"});
  std::vector<Real> all = angles<Real>();
  const std::vector<Real> more = special<Real>();
  all.insert(all.end(), more.begin(), more.end());
  for (const Real angle : all) {
    const auto [sine, cosine] = kernel(angle);
    for (const Real other : {Real(-3), Real(1e22), std::numeric_limits<Real>::quiet_NaN()}) {
      CHECK(same_bits(kernel(angle, other).first, sine));
      CHECK(same_bits(kernel(angle, other).second, cosine));
    }
    CHECK(same_bits(unoptimised(angle).first, sine));
    CHECK(same_bits(unoptimised(angle).second, cosine));
  }
}

TEST_CASE_TEMPLATE(
    "packed sincos: without vector types, or where numbers are kept in wider registers, all is left to the C library",
    Real, double, float) {
  const Kernel<Real> kernel({"-O2"}, "defined(__GNUC__) && defined(FLT_EVAL_METHOD)", "0");
  for (const Real angle : {Real(0.5), Real(-2), Real(1e3), Real(1e22)}) {
    CHECK(same_bits(kernel(angle).first, std::sin(angle)));
    CHECK(same_bits(kernel(angle).second, std::cos(angle)));
  }
}
