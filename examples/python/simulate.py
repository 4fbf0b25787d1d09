"""The cart and its pendulum from Python: names, units, single functions, and a run that is C from start to end."""
import cart_pendulum as model

assert model.states == ("x", "theta", "x_dot", "theta_dot")
assert model.params == {"M": 2.0, "m": 0.5, "l": 0.8, "g": 9.81, "c": 0.1}
assert model.units["c"] == "N*s/m"
assert "theta" in model.__doc__

# A parameter by name; the others keep their defaults. At rest below, with a force on the cart: (M + m) x'' = F there.
dx = model.rhs(0, [0, 0, 0, 0], p={"m": 0.25}, u={"F": 9})
assert abs(dx[2] - 4.5) < 1e-14, dx
M, h = model.mass_matrix(0, [0, 0, 0, 0])
assert abs(M[0][0] - 2.5) < 1e-14 and abs(M[0][1] - 0.4) < 1e-14, M
for wrong in (lambda: model.rhs(0, [0, 0]), lambda: model.simulate(1, p={"mass": 1}), lambda: model.reactions(0, [0, 0, 0, 0])):
    try:
        wrong()
    except (ValueError, KeyError, NotImplementedError):
        continue
    raise AssertionError("accepted what makes no sense")

motion = model.simulate(10, rtol=1e-11, atol=1e-13, samples=101)
assert motion.outcome == "done" and len(motion.t) == 101 and motion.t[-1] == 10
energy = motion["energy"]
assert energy[-1] < energy[0]  # friction takes some
assert model.simulate(10, max_steps=5).outcome == "max_steps"
back = model.simulate(0, x0=motion.x[-1], t0=10, rtol=1e-11, atol=1e-13)
assert max(abs(a - b) for a, b in zip(back.x[-1], model.defaults["x"])) < 1e-8, back.x[-1]
for name, value in zip(model.states, motion.x[-1]):
    print(name, "%.12g" % value)
