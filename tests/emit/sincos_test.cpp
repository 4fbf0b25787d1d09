// SPDX-License-Identifier: GPL-3.0-or-later
// templates/kernels/sincos against CLN in 60 digits, through the compiler as users will.
#include <cln/real.h>
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "emit/examples.hpp"
#include "emit/kernels.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

using Packed = void (*)(double a, double b, double* sine, double* cosine);

bool same_bits(double a, double b) {
  return std::isnan(a) ? std::isnan(b) : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The kernel compiled with `flags`, its text changed by the caller where another processor or compiler is to be met.
struct Kernel {
  Folder folder;
  void* handle = nullptr;
  Packed packed = nullptr;
  explicit Kernel(const std::vector<std::string>& flags, const std::string& replace = "", const std::string& by = "") {
    std::string text = emit::sincos_kernel("k_", "static inline", "");
    for (std::size_t at = text.find(replace); !replace.empty() && at != std::string::npos;
         at = text.find(replace, at + by.size())) {
      text.replace(at, replace.size(), by);
    }
    const std::string source = folder.path + "/kernel.c", library = folder.path + "/kernel.so";
    // In a header: clang finds fault with what a source has and does not use, and one test does not use all.
    std::ofstream(folder.path + "/kernel.h") << "#include <float.h>\n#include <math.h>\n#include <string.h>\n" << text;
    std::ofstream(source) << "#include \"kernel.h\"\n"
                          << "void packed(double a, double b, double* sine, double* cosine);\n"
                             "void packed(double a, double b, double* sine, double* cosine)\n"
                             "{\n  k_sincos(a, b, sine, cosine);\n}\n";
    std::vector<std::string> command{EOMGEN_TEST_CC, "-std=c11", "-fPIC", "-shared", "-o", library};
    command.insert(command.end(), flags.begin(), flags.end());
    const std::string said = complaints(command, {source, "-lm"});
    CHECK(said == "");
    handle = ::dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    REQUIRE((handle != nullptr));
    packed = reinterpret_cast<Packed>(::dlsym(handle, "packed"));
    REQUIRE((packed != nullptr));
  }
  ~Kernel() {
    if (handle != nullptr) ::dlclose(handle);
  }
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  std::pair<double, double> operator()(double angle, double other = 0) const {
    double sine[2], cosine[2], exchanged[2], exchanged_cosine[2];
    packed(angle, other, sine, cosine);
    packed(other, angle, exchanged, exchanged_cosine);
    CHECK(same_bits(sine[0], exchanged[1]));
    CHECK(same_bits(cosine[0], exchanged_cosine[1]));
    return {sine[0], cosine[0]};
  }
};

/// The distance from the true value in units of its last place.
double ulps(double got, const cln::cl_R& exact) {
  const double nearest = std::abs(cln::double_approx(exact));
  const double unit = std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest;
  return cln::double_approx(cln::abs(numeric::exact(got) - exact) / numeric::exact(unit));
}
double worst(const Kernel& kernel, double angle) {
  const cln::cl_R x = cln::cl_float(numeric::exact(angle), cln::float_format(60));
  const auto [sine, cosine] = kernel(angle);
  return std::max(ulps(sine, cln::sin(x)), ulps(cosine, cln::cos(x)));
}

std::vector<double> angles() {
  std::vector<double> list;
  std::mt19937_64 random(1);
  for (const double reach : {1e-3, 0.8, 3.2, 20.0, 1e3, 65536.0}) {
    std::uniform_real_distribution<double> within(-reach, reach);
    for (int i = 0; i < 1500; ++i) list.push_back(within(random));
  }
  // Next to multiples of pi/4: where sines and cosines vanish, and where the reduction goes from one quarter to the
  // next.
  const cln::cl_R quarter = cln::pi(cln::float_format(60)) / 4;
  for (int k = 1; k * 0.7853981633974483 < 65536; k += k < 400 ? 1 : 41) {
    const double x = cln::double_approx(k * quarter);
    for (const double towards : {0.0, x, 1e9}) list.push_back(std::nextafter(x, towards));
  }
  return list;
}

std::vector<double> special() {
  const double inf = std::numeric_limits<double>::infinity(), tiny = std::numeric_limits<double>::denorm_min();
  return {0.0,     -0.0,     tiny,
          -tiny,   1e-310,   1e-30,
          65536.0, -65536.0, std::nextafter(65536.0, inf),
          1e5,     -1e5,     1e22,
          -1e22,   1e300,    std::numeric_limits<double>::max(),
          inf,     -inf,     std::nan("")};
}

}  // namespace

TEST_CASE("packed sincos: wrong by less than a unit in the last place up to 65536") {
  std::vector<std::vector<std::string>> flags = {{"-O2"}};
  // With fused multiplications and wide registers, where this machine has them.
  if (emit::run_process({EOMGEN_TEST_CC, "-march=native", "-E", "-x", "c", "/dev/null"}).status == 0)
    flags.push_back({"-O3", "-march=native"});
  for (const auto& set : flags) {
    const Kernel kernel(set);
    double largest = 0, where = 0;
    for (const double angle : angles()) {
      const double error = worst(kernel, angle);
      if (error > largest) largest = error, where = angle;
    }
    CAPTURE(where);
    CHECK(largest < tolerances::packed_sincos_ulps);
    CHECK(largest > 0.4);  // it is measured at all
  }
}

TEST_CASE(
    "packed sincos: zeros keep their sign, denormals are their own sine, what is large or not finite is the C "
    "library's") {
  const Kernel kernel({"-O2"});
  for (const double angle : special()) {
    CAPTURE(angle);
    const auto [sine, cosine] = kernel(angle);
    if (std::abs(angle) <= 65536) {
      CHECK(same_bits(kernel(-angle).first, -sine));
      CHECK(same_bits(kernel(-angle).second, cosine));
      const bool its_own_sine = std::abs(angle) < 1e-300;  // CLN's floats underflow there
      CHECK((its_own_sine ? same_bits(sine, angle) && cosine == 1
                          : worst(kernel, angle) < tolerances::packed_sincos_ulps));
    } else {
      CHECK(same_bits(sine, std::sin(angle)));
      CHECK(same_bits(cosine, std::cos(angle)));
    }
  }
}

TEST_CASE("packed sincos: the same bits in any company, with and without optimisation") {
  const Kernel kernel({"-O2"}), unoptimised({"-O0"});
  std::vector<double> all = angles();
  const std::vector<double> more = special();
  all.insert(all.end(), more.begin(), more.end());
  for (const double angle : all) {
    const auto [sine, cosine] = kernel(angle);
    for (const double other : {-3.0, 1e22, std::nan("")}) {
      CHECK(same_bits(kernel(angle, other).first, sine));
      CHECK(same_bits(kernel(angle, other).second, cosine));
    }
    CHECK(same_bits(unoptimised(angle).first, sine));
    CHECK(same_bits(unoptimised(angle).second, cosine));
  }
}

TEST_CASE(
    "packed sincos: without vector types, or where doubles are kept in wider registers, all is left to the C library") {
  const Kernel kernel({"-O2"}, "defined(__GNUC__) && defined(FLT_EVAL_METHOD)", "0");
  for (const double angle : {0.5, -2.0, 1e3, 1e22}) {
    CHECK(same_bits(kernel(angle).first, std::sin(angle)));
    CHECK(same_bits(kernel(angle).second, std::cos(angle)));
  }
}
