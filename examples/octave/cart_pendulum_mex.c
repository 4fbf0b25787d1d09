/* [x, p] = cart_pendulum_mex() gives the start and the parameters of the default scene,
 * dx = cart_pendulum_mex(t, x, p) the right-hand side. */
#include "cart_pendulum.h"
#include "mex.h"

static void require(int ok, const char* what) {
  if (!ok) mexErrMsgTxt(what);
}

void mexFunction(int results, mxArray* result[], int arguments, const mxArray* argument[]) {
  if (arguments == 0) {
    double x[cart_pendulum_states], p[cart_pendulum_parameters];
    cart_pendulum_defaults(x, p);
    result[0] = mxCreateDoubleMatrix(cart_pendulum_states, 1, mxREAL);
    for (int i = 0; i < cart_pendulum_states; ++i) mxGetPr(result[0])[i] = x[i];
    if (results < 2) return;
    result[1] = mxCreateDoubleMatrix(cart_pendulum_parameters, 1, mxREAL);
    for (int i = 0; i < cart_pendulum_parameters; ++i) mxGetPr(result[1])[i] = p[i];
    return;
  }
  require(arguments == 3 && mxIsDouble(argument[1]) && mxIsDouble(argument[2]),
          "usage: dx = cart_pendulum_mex(t, x, p)");
  require(mxGetNumberOfElements(argument[1]) == cart_pendulum_states, "x has 4 entries: x, theta and their rates");
  require(mxGetNumberOfElements(argument[2]) == cart_pendulum_parameters, "p has 5 entries: M, m, l, g, c");
  result[0] = mxCreateDoubleMatrix(cart_pendulum_states, 1, mxREAL);
  require(cart_pendulum_rhs(mxGetScalar(argument[0]), mxGetPr(argument[1]), mxGetPr(argument[2]), 0, 0,
                            mxGetPr(result[0])) == 0,
          "the mass matrix is singular");
}
