// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/stability.hpp"

#include <algorithm>

#include "symbolic/calculus.hpp"

namespace eomgen::linear {

const char* name(Stability stability) {
  switch (stability) {
    case Stability::stable: return "stable";
    case Stability::unstable: return "unstable";
    case Stability::unknown: break;
  }
  return "unknown";
}

std::string in_words(Stability stability) {
  return (stability == Stability::unknown ? "stability " : "") + std::string(name(stability));
}

namespace {

constexpr int zero_digits = 60;  // zero of numbers with more than 100 known digits

std::vector<std::size_t> retained_entries(const Linearisation& l) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < l.symmetry.retained.size(); ++k) {
    if (l.symmetry.retained[k]) result.push_back(k);
  }
  return result;
}

Precise largest(const Matrix<Precise>& A) {
  Precise result(0);
  for (const Precise& x : A.a) result = std::max(result, magnitude(x));
  return result;
}

/// Whether all pivots of a symmetric matrix, in order of magnitude, have one sign.
bool is_definite(Matrix<Precise> H) {
  const Precise scale = largest(H);
  if (H.rows == 0) return true;
  bool positive = false;
  std::vector<std::size_t> left(H.rows);
  std::iota(left.begin(), left.end(), std::size_t{0});
  for (std::size_t step = 0; step < H.rows; ++step) {
    const auto pivot = std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return magnitude(H(a, a)) < magnitude(H(b, b));
    });
    const std::size_t k = *pivot;
    if (!(magnitude(H(k, k)) > tiny<Precise>(zero_digits) * scale)) return false;
    if (step > 0 && positive != cln::plusp(H(k, k))) return false;
    positive = cln::plusp(H(k, k));
    left.erase(pivot);
    for (const std::size_t i : left) {
      const Precise factor = H(i, k) / H(k, k);
      for (const std::size_t j : left) H(i, j) = H(i, j) - factor * H(k, j);
    }
  }
  return true;
}

}  // namespace

StabilityTest::StabilityTest(const Flow& flow, symbolic::Dag& dag, const std::vector<Quantity>& energies,
                             const std::vector<Quantity>& momenta)
    : flow_(flow) {
  const auto function = [&](const std::string& name, Ref expression) -> Function {
    std::vector<Ref> gradient{expression};
    for (const Symbol& s : flow.symbols()) gradient.push_back(symbolic::partial_derivative(dag, s)(expression));
    return {name, flow.tape(gradient)};
  };
  for (const Quantity& q : energies) energies_.push_back(function(q.name, q.expression));
  for (const Quantity& q : momenta) momenta_.push_back(function(q.name, q.expression));
  for (const Ref phi : flow.phi_expressions()) constraints_.push_back(function("", phi));
}

StabilityTest::Slopes StabilityTest::slopes(const Function& function, const Linearisation& l) const {
  const std::size_t size = flow_.entries();
  const ValueAndJacobian<Precise> s = flow_.value_and_jacobian(function.gradient, l.z, l.setting);
  Slopes result{Matrix<Precise>(1, size), Matrix<Precise>(size, size)};
  for (std::size_t i = 0; i < size; ++i) {
    result.first(0, i) = s.value[i + 1];
    for (std::size_t j = 0; j < size; ++j) result.second(i, j) = s.jacobian(i + 1, j);
  }
  return result;
}

// F = E - sum mu I with dF = 0 on the constraints. Along a curve on them, d2F = z'^T (F'' - sum kappa phi'') z', with
// dF = sum kappa dphi.
bool StabilityTest::definite(const Linearisation& l, const std::vector<std::size_t>& columns,
                             const Function& energy) const {
  const std::size_t size = flow_.entries();
  Matrix<Precise> whole(size, l.symmetry.chart.independent.size());
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t k = 0; k < whole.cols; ++k) whole(i, k) = l.tangent(i, k);
  }
  const Matrix<Precise> T = columns_of(whole, columns);
  Slopes F = slopes(energy, l);
  Matrix<Precise> along;  // derivatives of the used momenta by the retained entries
  std::vector<Slopes> taken;
  for (const Function& momentum : momenta_) {
    const Slopes I = slopes(momentum, l);
    const Matrix<Precise> all = I.first * whole, kept = I.first * T;
    for (std::size_t k = 0; k < all.cols; ++k) {
      // It may be conserved but depend on a coordinate that the motion does not depend on. Then it is no quantity of
      // the reduced motion.
      if (std::find(columns.begin(), columns.end(), k) == columns.end() &&
          magnitude(all(0, k)) > tiny<Precise>(zero_digits) * (Precise(1) + largest(all)))
        goto next;
    }
    if (const Matrix<Precise> more = stacked(along, kept);
        Elimination<Precise>(more, tiny<Precise>(zero_digits), tiny<Precise>(zero_digits)).rank() == more.rows) {
      along = more;
      taken.push_back(I);
    }
  next:;
  }
  if (!taken.empty()) {
    const Matrix<Precise> mu =
        Elimination<Precise>(transposed(along), tiny<Precise>(zero_digits), tiny<Precise>(zero_digits))
            .solve(transposed(F.first * T));
    for (std::size_t a = 0; a < taken.size(); ++a) {
      for (std::size_t i = 0; i < F.first.a.size(); ++i) F.first.a[i] = F.first.a[i] - mu(a, 0) * taken[a].first.a[i];
      for (std::size_t i = 0; i < F.second.a.size(); ++i)
        F.second.a[i] = F.second.a[i] - mu(a, 0) * taken[a].second.a[i];
    }
  }
  if (largest(F.first * whole) > tiny<Precise>(zero_digits) * (Precise(1) + largest(F.first)))
    return false;  // not critical
  if (!constraints_.empty()) {
    std::vector<Slopes> phi;
    Matrix<Precise> normals;
    for (const Function& constraint : constraints_) {
      phi.push_back(slopes(constraint, l));
      normals = stacked(normals, phi.back().first);
    }
    const Matrix<Precise> kappa =
        Elimination<Precise>(transposed(normals), tiny<Precise>(zero_digits), tiny<Precise>(zero_digits))
            .solve(transposed(F.first));
    for (std::size_t a = 0; a < phi.size(); ++a) {
      for (std::size_t i = 0; i < F.second.a.size(); ++i)
        F.second.a[i] = F.second.a[i] - kappa(a, 0) * phi[a].second.a[i];
    }
  }
  Matrix<Precise> W = T;
  if (!taken.empty())
    W = T * Elimination<Precise>(along, tiny<Precise>(zero_digits), tiny<Precise>(zero_digits)).null_space();
  return is_definite(transposed(W) * F.second * W);
}

std::optional<std::size_t> steady_family_dimension(const Flow& flow, const Linearisation& steady,
                                                   const Matrix<Precise>& retained) {
  const Matrix<Precise> directions =
      Elimination<Precise>(retained, tiny<Precise>(zero_digits), tiny<Precise>(zero_digits)).null_space();
  const std::vector<std::size_t> entries = retained_entries(steady);
  const Matrix<Precise> T = columns_of(steady.tangent, entries) * directions;
  for (std::size_t d = 0; d < directions.cols; ++d) {
    Precise size(0);
    for (std::size_t i = 0; i + 1 < T.rows; ++i)
      size = std::max(size, magnitude(T(i, d)) / (Precise(1) + magnitude(steady.z[i])));
    State<Precise> start = steady.z;
    const Precise step = tiny<Precise>(3) / size;
    for (std::size_t i = 0; i + 1 < T.rows; ++i) start[i] = start[i] + step * T(i, d);
    const auto found = solve_steady_state(flow, steady.symmetry, start, steady.setting);
    if (!found) return std::nullopt;
    for (std::size_t i = 0; i + 1 < T.rows; ++i) {  // no falling back: the correction is of second order in the step
      if (magnitude((*found)[i] - start[i]) > step * size / Precise(4) * (Precise(1) + magnitude(steady.z[i])))
        return std::nullopt;
    }
  }
  return directions.cols;
}

StabilityVerdict StabilityTest::operator()(const Linearisation& l) const {
  const std::vector<std::size_t> entries = retained_entries(l);
  const Matrix<Precise> A = columns_of(rows_of(l.A, entries), entries);
  const Spectrum s = spectrum(A, l.known);
  const auto rises = [](const Eigenvalue& e) { return e.is_in_binary64 && e.re > e.error; };
  const auto falls = [](const Eigenvalue& e) { return e.is_in_binary64 && e.re < -e.error; };
  if (std::any_of(s.values.begin(), s.values.end(), rises))
    return {Stability::unstable, "an eigenvalue has a positive real part"};
  const auto falling = static_cast<std::size_t>(std::count_if(s.values.begin(), s.values.end(), falls));
  if (falling + s.zeros == s.values.size()) {
    if (s.zeros == 0) return {Stability::stable, "all eigenvalues have negative real parts"};
    const auto along = falling > 0 ? steady_family_dimension(flow_, l, A) : std::nullopt;
    if (along && *along == s.zeros)
      return {Stability::stable,
              "a family of steady motions that attracts: all other eigenvalues have negative real parts"};
  }
  for (const Function& energy : energies_) {
    bool decides = false;
    try {
      decides = definite(l, entries, energy);
    } catch (const std::domain_error&) {  // it has no second variation here
    }
    if (decides)
      return {Stability::stable, "the second variation of '" + energy.name + "' at fixed momenta is definite"};
  }
  return {Stability::unknown,
          "no eigenvalue has a positive real part, and no conserved quantity that is known decides"};
}

}  // namespace eomgen::linear
