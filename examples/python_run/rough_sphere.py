"""A particle on a rough sphere from Python: the default scene, which leaves the sphere, and one that comes to rest. Both reproduce
the numbers of `eomgen run`, whose tables are the arguments."""
import csv
import os
import sys

import P5_rough_sphere as model


def compare(run, path):
    with open(path) as file:
        rows = [row for row in csv.reader(file) if not row[0].startswith("#")]
    names, table = rows[0], rows[1:]
    assert run.outcome == "done", (run.outcome, run.detail)
    assert len(table) == len(run.t), (len(table), len(run.t))
    for column, name in enumerate(names):
        found = run.t if name == "t" else run[name]
        assert [float(row[column]) for row in table] == list(found), name
    print(run, "as eomgen run, to the last digit:", ", ".join("%s at %s" % (kind, name) for _, kind, name in run.events))


assert model.contacts == ("sphere",)

# A compiled runtime that is named has to exist.
library = os.environ.get("EOMGEN_LIBRARY")
os.environ["EOMGEN_LIBRARY"] = "nowhere"
try:
    model.run()
except ImportError as error:
    assert "EOMGEN_LIBRARY" in str(error), error
else:
    raise AssertionError("another runtime was taken than the one that is named")
del os.environ["EOMGEN_LIBRARY"]
if library is not None:
    os.environ["EOMGEN_LIBRARY"] = library

leaves = model.run()
compare(leaves, sys.argv[1])
assert [kind for _, kind, _ in leaves.events] == ["lose_contact"] and leaves.power_balance < 1e-8 and leaves.error < 1e-6

stops = model.run(3, x0={"phi": 0.15, "theta": 3.5, "phi_dot": 0, "theta_dot": 3}, p={"mu_s": 0.8, "mu_d": 0.5}, every=0.006)
compare(stops, sys.argv[2])
assert "stick" in [kind for _, kind, _ in stops.events]

# The functions depend on the mode: friction decelerates the sliding particle, but not away from the sphere.
x = model.defaults["x"]
assert list(model.rhs(0, x, mode=model.info["mode_states"][-1])) != list(model.rhs(0, x, mode=[1]))

apart = model.run(0.1, x0={"R": 1.5})  # above the sphere
assert apart["mode.sphere"][0] == apart["mode.sphere"][-1] and apart["reaction.sphere"][0] == 0

for wrong in (lambda: model.run(solver="fast"), lambda: model.run(x0=[1]), lambda: model.run(every=0), lambda: model.run(float("nan")),
              lambda: model.simulate(1)):
    try:
        wrong()
    except (ValueError, NotImplementedError):
        continue
    raise AssertionError("accepted what makes no sense")
