// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/small_vector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "symbolic/monomials.hpp"
#include "symbolic/small_numbers.hpp"

using namespace eomgen::symbolic;

namespace {

struct Power {
  std::uint32_t atom = 0;
  std::int32_t exponent = 1;
  friend auto operator<=>(const Power&, const Power&) = default;
};
using Powers = SmallVector<Power, 2>;

Powers ascending(std::uint32_t first, std::uint32_t count) {
  Powers result;
  for (std::uint32_t i = 0; i < count; ++i) result.push_back({first + i, 1});
  return result;
}

}  // namespace

TEST_CASE("a small vector keeps its elements when it outgrows its inline storage, is copied, moved and assigned") {
  for (std::uint32_t count = 0; count < 9; ++count) {
    const Powers list = ascending(3, count);
    std::vector<Power> expected;
    for (std::uint32_t i = 0; i < count; ++i) expected.push_back({3 + i, 1});
    const auto holds = [&](const Powers& held) {
      return held.size() == count && std::equal(held.begin(), held.end(), expected.begin(), expected.end());
    };
    CHECK(holds(list));
    Powers copy = list;
    CHECK(holds(copy));
    const Powers moved = std::move(copy);
    CHECK(holds(moved));
    for (std::uint32_t other = 0; other < 9; ++other) {
      Powers assigned = ascending(7, other);
      assigned = list;
      CHECK(holds(assigned));
      Powers taken = ascending(7, other);
      taken = Powers(list);
      CHECK(holds(taken));
      taken.push_back({99, 2});
      CHECK(taken.size() == count + 1);
      CHECK(taken.back() == Power{99, 2});
      taken.truncate(count);
      CHECK(taken == list);
    }
  }
}

TEST_CASE("small vectors are ordered lexicographically") {
  CHECK(ascending(1, 2) < ascending(1, 3));
  CHECK(ascending(1, 3) < ascending(2, 1));
  CHECK_FALSE(ascending(1, 3) < ascending(1, 3));
}

TEST_CASE("products of powers add exponents and drop factors that cancel") {
  const Powers a{{1, 2}, {4, -1}, {7, 3}}, b{{1, 1}, {2, 5}, {4, 1}, {9, 1}};
  CHECK(product_of_powers<&Power::atom>(a, b) == Powers{{1, 3}, {2, 5}, {7, 3}, {9, 1}});
  CHECK(product_of_powers<&Power::atom>(a, b, -2) == Powers{{2, -10}, {4, -3}, {7, 3}, {9, -2}});
  CHECK(product_of_powers<&Power::atom>(a, a, -1).empty());
  CHECK(product_of_powers<&Power::atom>(a, {}) == a);
}

TEST_CASE("numbers are compared correctly whether CLN stores them in the word or behind a pointer") {
  const Rational large = cln::expt(Rational(7), cln::cl_I(40)), half = Rational(1) / 2,
                 wide = cln::expt(Rational(2), cln::cl_I(60));
  const std::vector<Rational> numbers{0,      1,         -1,           2,        half, -half, large,
                                      -large, large + 1, half / large, wide - 1, -wide};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      const Rational other = numbers[j] + numbers[i] - numbers[i];  // the same value, made anew
      CHECK(same(numbers[i], other) == (i == j));
      if (i == j) CHECK(hash_of(numbers[i]) == hash_of(other));
      CHECK(same(plus(numbers[i], numbers[j]), numbers[i] + numbers[j]));
      CHECK(times(numbers[i], numbers[j]) == numbers[i] * numbers[j]);
      if (j != 0) CHECK(quotient(numbers[i], numbers[j]) == numbers[i] / numbers[j]);
    }
  }
  CHECK(is_zero(half - half));
  CHECK(is_one(large / large));
  CHECK(is_minus_one(-large / large));
  CHECK(is_unit(half + half));
  CHECK_FALSE(is_unit(half));
}
