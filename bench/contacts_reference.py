"""Motions with contacts in many digits, event by event: references of contacts_beside.py, independent of eomgen.

A model gives its mass matrix, forces and contacts. Between events the equations with the contacts that are closed are
integrated by Gragg's method with extrapolation, to 1e-46. Events are roots, found by integrating again from the start
of a step: a gap closes, a reaction ends, slip ends, friction reaches its limit. Impacts follow Moreau's law: a normal
speed of -e times the one before or more, and friction against the slip after the impact. States of the closed contacts
(open, sticks, slips either way) are tried one after another until all inequalities hold.
"""
import itertools

from mpmath import cos, mp, mpf, sin

mp.dps = 60
LOCAL = mpf(10) ** -46  # error of one step
ZERO = mpf(10) ** -26   # gaps, speeds and reactions below are zero at events
REST = mpf(10) ** -16   # bounces with less speed do not bounce: what is left of an infinite sequence
OPEN, STICK = "open", "stick"


class Contact:
    """One contact at a state: gap, rows of the speeds along its normal and its tangent, their derivatives by time."""

    def __init__(self, gap, normal, tangent, normal_bias=0, tangent_bias=0):
        self.gap, self.normal, self.tangent = gap, normal, tangent
        self.normal_bias, self.tangent_bias = mpf(normal_bias), mpf(tangent_bias)


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), mpf(0))


def solve(A, b):
    """Elimination with partial pivots; None where the matrix is singular."""
    n = len(b)
    A = [row[:] + [x] for row, x in zip(A, b)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(A[k][i]))
        if abs(A[p][i]) < mpf(10) ** -40:
            return None
        A[i], A[p] = A[p], A[i]
        for k in range(i + 1, n):
            if A[k][i]:
                f = A[k][i] / A[i][i]
                for j in range(i, n + 1):
                    A[k][j] -= f * A[i][j]
    x = [mpf(0)] * n
    for i in reversed(range(n)):
        x[i] = (A[i][n] - dot(A[i][i + 1:n], x[i + 1:])) / A[i][i]
    return x


class Motion:
    def __init__(self, model, q, v):
        self.model, self.q, self.v, self.t = model, list(q), list(v), mpf(0)
        self.mode, self.events = {}, []

    def with_contacts(self, contacts, mode, M, f, normal, tangent):
        """x with M x = f and forces of contacts; speeds or accelerations of closed ones along their rows are given."""
        n = len(f)
        columns, rows, right, owner = [], [], [], []
        for i, state in mode.items():
            if state == OPEN:
                continue
            c, mu = contacts[i], self.model.mu
            rows.append(c.normal)
            right.append(normal[i])
            if state == STICK:
                columns += [c.normal, c.tangent]
                rows.append(c.tangent)
                right.append(tangent[i])
                owner += [(i, 0), (i, 1)]
            else:
                columns.append([a - state * mu * b for a, b in zip(c.normal, c.tangent)])
                owner.append((i, 0))
        A = [list(M[k]) + [-column[k] for column in columns] for k in range(n)]
        A += [list(row) + [mpf(0)] * len(columns) for row in rows]
        x = solve(A, list(f) + right)
        if x is None:
            return None
        forces = {i: [mpf(0), mpf(0)] for i in mode}
        for (i, k), force in zip(owner, x[n:]):
            forces[i][k] = force
        return x[:n], forces

    def acceleration(self, q, v, mode, contacts=None):
        closed = [i for i, state in mode.items() if state != OPEN]
        if closed and contacts is None:
            contacts = self.model.contacts(q, v)
        M, f = self.model.dynamics(q, v)
        return self.with_contacts(contacts, mode, M, f, {i: -contacts[i].normal_bias for i in closed},
                                  {i: -contacts[i].tangent_bias for i in closed})

    def step(self, h):
        """State after h in the present mode: Gragg's midpoint rule with 2, 4, 6 ... steps, extrapolated in h^2."""
        n = len(self.q)
        start = self.q + self.v

        def rate(y):
            return y[n:] + self.acceleration(y[:n], y[n:], self.mode)[0]

        first = rate(start)
        table = []
        for j in range(1, 24):
            m = 2 * j
            s = h / m
            before, y = start, [a + s * b for a, b in zip(start, first)]
            for _ in range(m - 1):
                before, y = y, [a + 2 * s * b for a, b in zip(before, rate(y))]
            row = [[(a + b + s * c) / 2 for a, b, c in zip(before, y, rate(y))]]
            for k, old in enumerate(table):
                ratio = mpf(j) ** 2 / mpf(j - 1 - k) ** 2 - 1
                row.append([a + (a - b) / ratio for a, b in zip(row[k], old)])
            if table and max(abs(a - b) for a, b in zip(row[-1], table[-1])) < LOCAL:
                return row[-1][:n], row[-1][n:]
            table = row
        return None

    def watched(self, q, v):
        """Functions that are positive in the present mode, by (contact, what ends), and derivatives of gaps."""
        contacts = self.model.contacts(q, v)
        values, slopes = {}, {}
        forces = None
        for i, c in enumerate(contacts):
            state = self.mode.get(i, OPEN)
            if state == OPEN:
                values[i, "gap"], slopes[i, "gap"] = c.gap, dot(c.normal, v)
                continue
            if forces is None:
                forces = self.acceleration(q, v, self.mode, contacts)[1]
            normal, tangent = forces[i]
            values[i, "reaction"] = normal
            if state == STICK:
                values[i, "cone"] = self.model.mu * normal - abs(tangent)
            else:
                values[i, "slip"] = state * dot(c.tangent, v)
        return values, slopes

    def root(self, key, h):
        """Time from the start of the step until the function at `key`, negative after h, is zero."""
        def value(x):
            values, slopes = self.watched(*self.step(x))
            return values[key], slopes.get(key)

        other, x = h * mpf("0.9"), h
        f_other, (f, slope) = value(other)[0], value(x)
        for _ in range(100):
            new = x - f / slope if slope is not None else x - f * (x - other) / (f - f_other)
            other, f_other = x, f
            noise = 10 * LOCAL / abs(slope) if slope else 0  # of the gap, by the error of a step
            if abs(new - x) < mpf(10) ** -40 + mpf(10) ** -28 * abs(new) + noise:
                if not 0 < new <= h:
                    raise RuntimeError("root outside of its step")
                return new
            x = new
            f, slope = value(x)
            if f == f_other:
                return x
        raise RuntimeError("no root")

    def states(self, contacts, closed, ended, speeds_given, evaluate):
        """The first assignment of states to closed contacts for which all inequalities of contact and friction hold."""
        options = {}
        for i in closed:
            slip = dot(contacts[i].tangent, self.v)
            if (i, "reaction") in ended:
                options[i] = [OPEN]
            elif speeds_given and abs(slip) > ZERO:
                options[i] = [1 if slip > 0 else -1, OPEN]
            else:
                options[i] = ([] if (i, "cone") in ended else [STICK]) + [1, -1, OPEN]
        for choice in itertools.product(*options.values()):
            mode = dict(zip(options, choice))
            solved = evaluate(mode)
            if solved is None:
                continue
            x, forces = solved
            good = True
            for i, state in mode.items():
                normal, tangent = forces[i]
                if state == OPEN:
                    good = good and dot(contacts[i].normal, x) - self.least[i] > -ZERO
                elif state == STICK:
                    good = good and normal > 0 and abs(tangent) <= self.model.mu * normal
                else:
                    known = speeds_given and abs(dot(contacts[i].tangent, self.v)) > ZERO
                    slip = dot(contacts[i].tangent, x) + (contacts[i].tangent_bias if speeds_given else 0)
                    good = good and normal > 0 and (known or state * slip >= -ZERO)
            if good:
                return mode, x
        raise RuntimeError("no state of the contacts fulfils all inequalities")

    def at_event(self, ended):
        contacts = self.model.contacts(self.q, self.v)
        closed = [i for i, c in enumerate(contacts) if abs(c.gap) < ZERO]
        M, f = self.model.dynamics(self.q, self.v)
        speed = {i: dot(contacts[i].normal, self.v) for i in closed}
        if any(s < -ZERO for s in speed.values()):
            after = {i: (-self.model.restitution[i] * s if s < -REST else mpf(0)) for i, s in speed.items()}
            self.least = after
            momentum = [dot(row, self.v) for row in M]
            _, self.v = self.states(contacts, closed, set(), False, lambda mode: self.with_contacts(
                contacts, mode, M, momentum, after, {i: mpf(0) for i in closed}))
            contacts = self.model.contacts(self.q, self.v)
            ended = set()
        closed = [i for i in closed if abs(dot(contacts[i].normal, self.v)) < ZERO]
        self.least = {i: -contacts[i].normal_bias for i in closed}
        self.mode, _ = self.states(contacts, closed, ended, True,
                                   lambda mode: self.acceleration(self.q, self.v, mode, contacts))

    def first_step(self, longest):
        """Short flights after a bounce end within the step: three times the speed over the deceleration."""
        contacts = self.model.contacts(self.q, self.v)
        x = self.acceleration(self.q, self.v, self.mode, contacts)[0]
        for i, c in enumerate(contacts):
            speed, change = dot(c.normal, self.v), dot(c.normal, x) + c.normal_bias
            if abs(c.gap) < ZERO and speed > ZERO and change < 0:
                longest = min(longest, -3 * speed / change)
        return longest

    def run(self, end, longest):
        end, longest = mpf(end), mpf(longest)
        self.at_event(set())
        h = self.first_step(longest)
        while True:
            h = min(h, end - self.t)
            new = self.step(h)
            if new is None:
                h /= 2
                continue
            values, _ = self.watched(*new)
            crossed = [key for key, value in values.items() if value < 0 and not (key[1] == "gap" and value > -ZERO ** 2)]
            if crossed:
                h = min(self.root(key, h) for key in crossed)
                new = self.step(h)
                values, _ = self.watched(*new)
            self.q, self.v = new
            self.t += h
            if crossed:
                ended = {key for key, value in values.items() if abs(value) < ZERO and key in crossed}
                self.events.append((self.t, sorted(ended)))
                self.at_event(ended)
                h = self.first_step(longest)
            elif self.t >= end:
                return self
            else:
                h = longest


class SliderCrank:
    """models/slider_crank.toml by hand: a double pendulum, and a slider of free angle at its end."""
    m1, m2, m3, J1, J2, J3 = map(mpf, ("0.038", "0.038", "0.076", "7.4e-5", "5.9e-4", "2.7e-6"))
    l1, l2, a, b, c, g, mu = map(mpf, ("0.153", "0.306", "0.05", "0.025", "0.001", "9.81", "0.01"))
    restitution = [mpf("0.4")] * 4

    def dynamics(self, q, v):
        l1, l2, m1, m2, m3 = self.l1, self.l2, self.m1, self.m2, self.m3
        k = l1 * l2 * (m2 / 2 + m3)
        both, twist = k * cos(q[0] - q[1]), k * sin(q[0] - q[1])
        M = [[self.J1 + l1 ** 2 * (m1 / 4 + m2 + m3), both, mpf(0)],
             [both, self.J2 + l2 ** 2 * (m2 / 4 + m3), mpf(0)], [mpf(0), mpf(0), self.J3]]
        return M, [-twist * v[1] ** 2 - self.g * l1 * (m1 / 2 + m2 + m3) * cos(q[0]),
                   twist * v[0] ** 2 - self.g * l2 * (m2 / 2 + m3) * cos(q[1]), mpf(0)]

    def contacts(self, q, v):
        (s1, s2, s3), (c1, c2, c3) = map(sin, q), map(cos, q)
        l1, l2 = self.l1, self.l2
        found = []
        for side in (1, -1):
            for end in (-1, 1):
                rx, ry = end * self.a * c3 - side * self.b * s3, end * self.a * s3 + side * self.b * c3
                gap = self.b + self.c - side * (l1 * s1 + l2 * s2 + ry)
                squares = [v[0] ** 2, v[1] ** 2, v[2] ** 2]
                found.append(Contact(gap, [-side * l1 * c1, -side * l2 * c2, -side * rx], [-l1 * s1, -l2 * s2, -ry],
                                     side * dot(squares, [l1 * s1, l2 * s2, ry]),
                                     -dot(squares, [l1 * c1, l2 * c2, rx])))
        return found


class Woodpecker:
    """models/woodpecker.toml by hand: linear between events. Contacts: beak, lower, upper."""
    m_M, J_M, m_S, J_S, k, g, mu = map(mpf, ("3e-4", "5e-9", "4.5e-3", "7e-7", "0.0056", "9.81", "0.3"))
    l_M, l_G, l_S, h_M, h_S, r_0, r_M = map(mpf, ("0.01", "0.015", "0.0201", "0.0058", "0.02", "0.0025", "0.0031"))
    restitution = [mpf("0.5"), mpf(0), mpf(0)]

    def dynamics(self, q, v):
        m, l, G = self.m_S, self.l_M, self.l_G
        M = [[self.m_M + m, m * l, m * G], [m * l, self.J_M + m * l * l, m * l * G], [m * G, m * l * G, self.J_S + m * G * G]]
        twist = self.k * (q[2] - q[1])
        return M, [-self.g * (self.m_M + m), -self.g * m * l + twist, -self.g * m * G - twist]

    def contacts(self, q, v):
        zero, one, h_M = mpf(0), mpf(1), self.h_M
        edge = self.r_M - self.r_0 + h_M * q[1]
        beak = self.l_G - self.l_S
        return [Contact(self.l_M + beak - self.r_0 - self.h_S * q[2], [zero, zero, -self.h_S], [one, self.l_M, beak]),
                Contact(edge, [zero, h_M, zero], [one, self.r_M, zero]),
                Contact(2 * (self.r_M - self.r_0) - edge, [zero, -h_M, zero], [one, self.r_M, zero])]


def slider_crank(end):
    return Motion(SliderCrank(), [mpf(0)] * 3, [mpf(150), mpf(-75), mpf(0)]).run(end, "2e-4").q


def woodpecker(end):
    model = Woodpecker()
    start = [mpf(0), -(model.r_M - model.r_0) / model.h_M, mpf("-0.2788")]
    return Motion(model, start, [mpf("-0.3411"), mpf(0), mpf("-7.4583")]).run(end, "1e-3").q
