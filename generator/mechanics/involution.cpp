// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/involution.hpp"

#include <cln/rational.h>

#include <algorithm>
#include <stdexcept>

#include "mechanics/small.hpp"
#include "numeric/elimination.hpp"
#include "symbolic/sample.hpp"
#include "symbolic/series.hpp"

namespace eomgen::mechanics {
namespace {

using cln::cl_R;
using Vector = std::vector<cl_R>;
using Matrix = std::vector<Vector>;  // by rows
using MatrixSeries = std::vector<Matrix>;

constexpr int bracket_digits = 50, zero_digits = 20;  // of a direction outside the span of earlier ones
constexpr int regular_digits = 30;                    // of a pivot
constexpr std::size_t most_entries = 200000;          // of the derivatives of all forms

cl_R dot(const Vector& a, const Vector& b) {
  cl_R sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum = sum + a[i] * b[i];
  return sum;
}

/// Adds the normalised part of a vector outside the span of orthonormal ones, unless it is 0. The fields and their
/// samples are of the order of 1, so that a vector of this smallness is a rounding error.
bool add_direction(std::vector<Vector>& basis, Vector v) {
  const cl_R length = cln::sqrt(dot(v, v));
  if (length < small(regular_digits)) return false;
  for (int turn = 0; turn < 2; ++turn) {
    for (const Vector& e : basis) {
      const cl_R part = dot(e, v);
      for (std::size_t i = 0; i < v.size(); ++i) v[i] = v[i] - part * e[i];
    }
  }
  const cl_R rest = cln::sqrt(dot(v, v));
  if (rest < length * small(zero_digits)) return false;
  for (cl_R& x : v) x = x / rest;
  basis.push_back(std::move(v));
  return true;
}

numeric::Matrix<cl_R> dense(const Matrix& A) {
  numeric::Matrix<cl_R> result(A.size(), A.empty() ? 0 : A[0].size());
  for (std::size_t i = 0; i < result.rows; ++i) {
    for (std::size_t j = 0; j < result.cols; ++j) result(i, j) = A[i][j];
  }
  return result;
}

/// Columns in which the rows are regular, by elimination with complete pivoting; none if the rows are dependent.
std::vector<std::size_t> pivots(const Matrix& A) {
  const numeric::Elimination<cl_R> factors(dense(A), small(zero_digits), numeric::Pivoting::complete);
  if (factors.rank() < A.size()) return {};
  std::vector<std::size_t> columns = factors.pivot_columns();
  std::sort(columns.begin(), columns.end());
  return columns;
}

Matrix inverse(const Matrix& A) {
  const std::size_t n = A.size();
  const numeric::Elimination<cl_R> factors(dense(A), small(regular_digits), numeric::Pivoting::complete);
  if (factors.rank() < n) throw std::domain_error("singular");
  numeric::Matrix<cl_R> unit(n, n);
  for (std::size_t i = 0; i < n; ++i) unit(i, i) = 1;
  const numeric::Matrix<cl_R> X = factors.solve(unit);
  Matrix result(n, Vector(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) result[i][j] = X(i, j);
  }
  return result;
}

/// The forms along an admissible curve, and the curve's variation, as power series.
class Path {
 public:
  Path(OneFormSpace& space, const std::vector<OneForm>& forms, std::size_t point)
      : space_(space), n_(space.variables().size()), rows_(forms.size()), point_(point) {
    std::vector<Ref> roots;
    for (const OneForm& form : forms) roots.insert(roots.end(), form.begin(), form.end());
    for (std::size_t k = 0; k < rows_; ++k) {
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t l = 0; l < n_; ++l) {
          const Ref slope = space.dag().is_zero(forms[k][i]) ? space.dag().zero() : space.derivative(forms[k][i], l);
          if (space.dag().is_zero(slope)) continue;
          slopes_.push_back({k, i, l});
          roots.push_back(slope);
        }
      }
    }
    const std::vector<Symbol> symbols = space.dag().symbols(roots);
    const auto integral = [](const Symbol& s) { return s.kind == symbolic::SymbolKind::integral; };
    if (std::any_of(symbols.begin(), symbols.end(), integral)) throw std::domain_error("an integral of time");
    series_.emplace(space.dag(), std::move(roots), bracket_digits);
    x_.emplace_back();
    for (const Symbol& variable : space.variables()) x_.back().push_back(space.value(variable, point));
    extend();
    dependent_ = pivots(A_[0]);
    if (dependent_.size() != rows_) throw std::domain_error("dependent");
    for (std::size_t i = 0; i < n_; ++i) {
      if (std::find(dependent_.begin(), dependent_.end(), i) == dependent_.end()) independent_.push_back(i);
    }
    Matrix regular(rows_, Vector(rows_));
    for (std::size_t k = 0; k < rows_; ++k) {
      for (std::size_t p = 0; p < rows_; ++p) regular[k][p] = A_[0][k][dependent_[p]];
    }
    inverse_ = inverse(regular);
  }

  /// Coefficients 0..order of the forms, and one more of the curve.
  void go_to(std::size_t order) {
    while (A_.size() <= order) {
      step_to(A_.size());
      extend();
    }
  }

  /// d omega of form k at the start, per pair of variables.
  Matrix curl(std::size_t k) const {
    Matrix result(n_, Vector(n_, cl_R(0)));
    for (std::size_t s = 0; s < slopes_.size(); ++s) {
      const auto& [row, i, l] = slopes_[s];
      if (row != k) continue;
      const cl_R& value = (*series_)[rows_ * n_ + s][0];
      result[l][i] = result[l][i] + value;
      result[i][l] = result[i][l] - value;
    }
    return result;
  }

  /// Fields that span the kernel, each 1 in one independent variable.
  std::vector<MatrixSeries> fields(std::size_t order) {
    go_to(order);
    std::vector<MatrixSeries> result;
    for (const std::size_t j : independent_) {
      MatrixSeries right;
      for (std::size_t k = 0; k <= order; ++k) {
        Matrix column(rows_, Vector(1));
        for (std::size_t row = 0; row < rows_; ++row) column[row][0] = -A_[k][row][j];
        right.push_back(std::move(column));
      }
      const MatrixSeries part = solved(right);
      MatrixSeries field;
      for (std::size_t k = 0; k <= order; ++k) {
        field.emplace_back(n_, Vector(1, cl_R(0)));
        for (std::size_t p = 0; p < rows_; ++p) field.back()[dependent_[p]][0] = part[k][p][0];
        if (k == 0) field.back()[j][0] = 1;
      }
      result.push_back(std::move(field));
    }
    return result;
  }

  /// F of the variation d' = F d along the curve, rows of the dependent variables: -A_p^-1 (dA/dx_l x').
  MatrixSeries variation(std::size_t order) {
    go_to(order);
    step_to(order + 1);
    MatrixSeries right;
    for (std::size_t k = 0; k <= order; ++k) right.emplace_back(rows_, Vector(n_, cl_R(0)));
    for (std::size_t s = 0; s < slopes_.size(); ++s) {
      const auto& [row, i, l] = slopes_[s];
      const std::vector<cl_R>& c = (*series_)[rows_ * n_ + s];
      for (std::size_t k = 0; k <= order; ++k) {
        for (std::size_t a = 0; a <= k; ++a)
          right[k][row][l] = right[k][row][l] - c[a] * cl_R(static_cast<long>(k - a + 1)) * x_[k - a + 1][i];
      }
    }
    return solved(right);
  }

  const std::vector<std::size_t>& dependent() const { return dependent_; }

 private:
  void extend() {
    const std::size_t k = A_.size();
    const auto lookup = [&](const Symbol& symbol, std::size_t order) -> cl_R {
      const auto found = std::find(space_.variables().begin(), space_.variables().end(), symbol);
      if (found != space_.variables().end())
        return x_[order][static_cast<std::size_t>(found - space_.variables().begin())];
      return order == 0 ? space_.value(symbol, point_) : cl_R(0);
    };
    series_->extend(lookup);
    Matrix A(rows_, Vector(n_));
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t i = 0; i < n_; ++i) A[row][i] = (*series_)[row * n_ + i][k];
    }
    A_.push_back(std::move(A));
  }

  void step_to(std::size_t order) {
    while (x_.size() <= order) step();
  }

  // A x' = 0, with prescribed independent variables.
  void step() {
    const std::size_t k = x_.size() - 1;
    Vector next(n_, cl_R(0));
    for (const std::size_t j : independent_) {
      next[j] = cln::cl_float(
          cl_R(symbolic::sample({symbolic::SymbolKind::auxiliary, static_cast<std::uint32_t>(j), 0}, 7 + k) -
               symbolic::Rational(7) / 10),
          cln::float_format(bracket_digits));
    }
    Vector right(rows_, cl_R(0));
    for (std::size_t row = 0; row < rows_; ++row) {
      for (const std::size_t j : independent_)
        right[row] = right[row] - cl_R(static_cast<long>(k + 1)) * A_[0][row][j] * next[j];
      for (std::size_t i = 1; i <= k; ++i)
        right[row] = right[row] - cl_R(static_cast<long>(k + 1 - i)) * dot(A_[i][row], x_[k + 1 - i]);
    }
    for (std::size_t p = 0; p < rows_; ++p)
      next[dependent_[p]] = dot(inverse_[p], right) / cl_R(static_cast<long>(k + 1));
    x_.push_back(std::move(next));
  }

  /// Solves A_p X = right, coefficient by coefficient.
  MatrixSeries solved(const MatrixSeries& right) const {
    MatrixSeries X;
    for (std::size_t k = 0; k < right.size(); ++k) {
      Matrix rest = right[k];
      const std::size_t width = rest.empty() ? 0 : rest[0].size();
      for (std::size_t i = 1; i <= k; ++i) {
        for (std::size_t row = 0; row < rows_; ++row) {
          for (std::size_t p = 0; p < rows_; ++p) {
            const cl_R& a = A_[i][row][dependent_[p]];
            if (cln::zerop(a)) continue;
            for (std::size_t w = 0; w < width; ++w) rest[row][w] = rest[row][w] - a * X[k - i][p][w];
          }
        }
      }
      Matrix next(rows_, Vector(width, cl_R(0)));
      for (std::size_t p = 0; p < rows_; ++p) {
        for (std::size_t row = 0; row < rows_; ++row) {
          if (cln::zerop(inverse_[p][row])) continue;
          for (std::size_t w = 0; w < width; ++w) next[p][w] = next[p][w] + inverse_[p][row] * rest[row][w];
        }
      }
      X.push_back(std::move(next));
    }
    return X;
  }

  struct Slope {
    std::size_t form, entry, by;
  };
  OneFormSpace& space_;
  std::size_t n_, rows_, point_;
  std::vector<Slope> slopes_;
  std::optional<symbolic::PowerSeries> series_;
  std::vector<Vector> x_;  // coefficients of the curve
  MatrixSeries A_;
  std::vector<std::size_t> dependent_, independent_;
  Matrix inverse_;
};

}  // namespace

bool Orbit::is_integrable(const Vector& form) const {
  const cl_R length = cln::sqrt(dot(form, form));
  return std::all_of(directions_.begin(), directions_.end(),
                     [&](const Vector& v) { return cln::abs(dot(form, v)) <= length * small(zero_digits); });
}

std::optional<bool> fails_frobenius(OneFormSpace& space, const std::vector<OneForm>& forms, std::size_t point) {
  try {
    Path path(space, forms, point);
    const std::vector<MatrixSeries> fields = path.fields(0);
    const Matrix curl = path.curl(forms.size() - 1);
    for (std::size_t a = 0; a < fields.size(); ++a) {
      for (std::size_t b = a + 1; b < fields.size(); ++b) {
        cl_R sum = 0;
        for (std::size_t i = 0; i < curl.size(); ++i) {
          for (std::size_t j = 0; j < curl.size(); ++j)
            sum = sum + fields[a][0][i][0] * curl[i][j] * fields[b][0][j][0];
        }
        if (cln::abs(sum) > small(30)) return true;
      }
    }
    return false;
  } catch (const std::exception&) {  // no values there, or dependent
    return std::nullopt;
  }
}

// Let M_0 be the fields and M_(k+1) = M_k' - F M_k along a curve of generic controls. The values of all M_k at the
// start span the tangent space of the orbit; the rank grows with k until it is complete.
std::optional<Orbit> orbit(OneFormSpace& space, const std::vector<OneForm>& forms, std::size_t point) {
  const std::size_t n = space.variables().size();
  if (forms.empty() || forms.size() * n * n > most_entries) return std::nullopt;
  try {
    Path path(space, forms, point);
    for (std::size_t order = 2;; order *= 2) {
      std::vector<MatrixSeries> fields = path.fields(order);
      const MatrixSeries F = path.variation(order);
      std::vector<Vector> basis;
      bool complete = false;
      for (std::size_t k = 0; k <= order && !complete; ++k) {
        complete = true;
        for (const MatrixSeries& field : fields) {
          Vector v(n);
          for (std::size_t i = 0; i < n; ++i) v[i] = field[0][i][0];
          if (add_direction(basis, std::move(v))) complete = false;
        }
        for (MatrixSeries& field : fields) {
          MatrixSeries next;
          for (std::size_t o = 0; o + 1 < field.size(); ++o) {
            Matrix value(n, Vector(1, cl_R(0)));
            for (std::size_t i = 0; i < n; ++i) value[i][0] = cl_R(static_cast<long>(o + 1)) * field[o + 1][i][0];
            for (std::size_t p = 0; p < F[o].size(); ++p) {
              for (std::size_t a = 0; a <= o; ++a) {
                for (std::size_t l = 0; l < n; ++l)
                  value[path.dependent()[p]][0] = value[path.dependent()[p]][0] - F[a][p][l] * field[o - a][l][0];
              }
            }
            next.push_back(std::move(value));
          }
          field = std::move(next);
        }
      }
      if (complete || basis.size() == n || order > forms.size()) return Orbit(n, std::move(basis));
    }
  } catch (const std::exception&) {  // no values there, or dependent
    return std::nullopt;
  }
}

}  // namespace eomgen::mechanics
