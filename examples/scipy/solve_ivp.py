"""The generated right-hand side and Jacobian in SciPy's implicit solver Radau."""
import numpy
from scipy.integrate import solve_ivp

import cart_pendulum as model

solution = solve_ivp(model.rhs, (0, 10), model.defaults["x"], method="Radau", jac=model.jac, rtol=1e-9, atol=1e-11)
assert solution.success, solution.message

# The same with a heavier pendulum and a force, by DOP853 and by the module's own integrator.
p, u = {"m": 1.0}, {"F": 0.5}
heavier = solve_ivp(model.rhs, (0, 5), model.defaults["x"], args=(p, u), method="DOP853", rtol=1e-11, atol=1e-12,
                    t_eval=numpy.linspace(0, 5, 11))
motion = model.simulate(5, p=p, u=u, rtol=1e-11, atol=1e-12, t_eval=numpy.linspace(0, 5, 11))
assert isinstance(motion.x, numpy.ndarray) and motion.x.shape == (11, 4)
assert numpy.abs(motion.x - heavier.y.T).max() < 1e-8, motion.x - heavier.y.T

# The Jacobian against difference quotients.
x, step = numpy.array([0.1, 0.4, -0.3, 0.7]), 1e-6
quotients = numpy.array([(model.rhs(0, x + step * e) - model.rhs(0, x - step * e)) / (2 * step) for e in numpy.eye(4)]).T
assert numpy.abs(model.jac(0, x) - quotients).max() < 1e-7

for name, value in zip(model.states, solution.y[:, -1]):
    print(name, "%.12g" % value)
