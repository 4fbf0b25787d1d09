// SPDX-License-Identifier: MIT
// Arguments and results of a step as a function. In: functions of a model in the form of the C ABI (docs/abi.md), and
// the arguments of a step. Out: the end of the step, and its derivatives. Matrices are stored by columns.
#pragma once

#include <cstddef>

namespace eom::discrete {

/// Returned if a derivative needs a function that the model lacks.
inline constexpr int code_no_function = -1;

/// Functions of a model. Any type with members of these names that can be called in this way may take its place. jac,
/// jac_p and jac_u are needed by derivatives only, functions of momenta by variational2 only. A null pointer stands for
/// none.
struct Functions {
  int (*rhs)(double t, const double* x, const double* p, const double* u, const int* mode, double* dx) = nullptr;
  int (*jac)(double t, const double* x, const double* p, const double* u, const int* mode, double* dfdx,
             double* dfdt) = nullptr;
  int (*jac_p)(double t, const double* x, const double* p, const double* u, const int* mode, double* dfdp) = nullptr;
  int (*jac_u)(double t, const double* x, const double* p, const double* u, const int* mode, double* dfdu) = nullptr;
  int (*momenta)(double t, const double* x, const double* p, const double* u, const int* mode, double* momenta,
                 double* rates) = nullptr;
  int (*momenta_jac)(double t, const double* x, const double* p, const double* u, const int* mode, double* dmdx,
                     double* dmdt) = nullptr;
  int (*momenta_jac_p)(double t, const double* x, const double* p, const double* u, const int* mode,
                       double* dmdp) = nullptr;
  int (*momenta_jac_u)(double t, const double* x, const double* p, const double* u, const int* mode,
                       double* dmdu) = nullptr;
};

/// Lengths of x, p and u.
struct Sizes {
  std::size_t states = 0, parameters = 0, inputs = 0;
  friend bool operator==(const Sizes&, const Sizes&) = default;
};

/// Arguments of a step from t to t + h, in the units of the model. Inputs and mode are held.
struct Arguments {
  double t = 0, h = 0;        // h may be negative
  const double* x = nullptr;  // the state at t: N
  const double* p = nullptr;  // parameters: P
  const double* u = nullptr;  // inputs: U; null: as the functions define it
  const int* mode = nullptr;  // docs/abi.md, "Modes"
};

/// Derivatives of the end x1 of a step. Null pointers are not computed. Arrays must not overlap with arguments.
struct Derivatives {
  double* x = nullptr;  // dx1/dx: N x N
  double* p = nullptr;  // dx1/dp: N x P; needs jac_p, or momenta_jac_p
  double* u = nullptr;  // dx1/du: N x U; needs jac_u, or momenta_jac_u
  double* t = nullptr;  // dx1/dt at fixed h: N
  double* h = nullptr;  // dx1/dh: N

  /// Whether any of them is computed.
  bool any() const { return x != nullptr || p != nullptr || u != nullptr || t != nullptr || h != nullptr; }
};

namespace detail {

// Calls of a model's functions with the held arguments of a step. They return its code.

template <class F>
int rhs(const F& f, const Arguments& at, double t, const double* x, double* dx) {
  return f.rhs(t, x, at.p, at.u, at.mode, dx);
}
template <class F>
int jac(const F& f, const Arguments& at, double t, const double* x, double* dfdx, double* dfdt) {
  if constexpr (requires { f.jac == nullptr; })
    if (f.jac == nullptr) return code_no_function;
  return f.jac(t, x, at.p, at.u, at.mode, dfdx, dfdt);
}
template <class F>
int jac_p(const F& f, const Arguments& at, double t, const double* x, double* dfdp) {
  if constexpr (requires { f.jac_p == nullptr; })
    if (f.jac_p == nullptr) return code_no_function;
  return f.jac_p(t, x, at.p, at.u, at.mode, dfdp);
}
template <class F>
int jac_u(const F& f, const Arguments& at, double t, const double* x, double* dfdu) {
  if constexpr (requires { f.jac_u == nullptr; })
    if (f.jac_u == nullptr) return code_no_function;
  return f.jac_u(t, x, at.p, at.u, at.mode, dfdu);
}

// Types without members for momenta have none.

/// m: momenta, then rates.
template <class F>
int momenta(const F& f, const Arguments& at, double t, const double* x, double* m, std::size_t n) {
  if constexpr (!requires { f.momenta(t, x, at.p, at.u, at.mode, m, m); }) {
    return code_no_function;
  } else {
    if constexpr (requires { f.momenta == nullptr; })
      if (f.momenta == nullptr) return code_no_function;
    return f.momenta(t, x, at.p, at.u, at.mode, m, m + n);
  }
}
template <class F>
int momenta_jac(const F& f, const Arguments& at, double t, const double* x, double* dmdx, double* dmdt) {
  if constexpr (!requires { f.momenta_jac(t, x, at.p, at.u, at.mode, dmdx, dmdt); }) {
    return code_no_function;
  } else {
    if constexpr (requires { f.momenta_jac == nullptr; })
      if (f.momenta_jac == nullptr) return code_no_function;
    return f.momenta_jac(t, x, at.p, at.u, at.mode, dmdx, dmdt);
  }
}
template <class F>
int momenta_jac_p(const F& f, const Arguments& at, double t, const double* x, double* dmdp) {
  if constexpr (!requires { f.momenta_jac_p(t, x, at.p, at.u, at.mode, dmdp); }) {
    return code_no_function;
  } else {
    if constexpr (requires { f.momenta_jac_p == nullptr; })
      if (f.momenta_jac_p == nullptr) return code_no_function;
    return f.momenta_jac_p(t, x, at.p, at.u, at.mode, dmdp);
  }
}
template <class F>
int momenta_jac_u(const F& f, const Arguments& at, double t, const double* x, double* dmdu) {
  if constexpr (!requires { f.momenta_jac_u(t, x, at.p, at.u, at.mode, dmdu); }) {
    return code_no_function;
  } else {
    if constexpr (requires { f.momenta_jac_u == nullptr; })
      if (f.momenta_jac_u == nullptr) return code_no_function;
    return f.momenta_jac_u(t, x, at.p, at.u, at.mode, dmdu);
  }
}

}  // namespace detail

}  // namespace eom::discrete
