# SPDX-License-Identifier: GPL-3.0-or-later
"""Mechanisms as others write them, as texts: those of docs/benchmarks.md, "Mechanisms written as others write them". They contain numbers in place of names, as such files do.

    python3 bench/mechanism_models.py NAME > model.toml
"""
import sys

import growth_models
from growth_models import scene

DOWN = '\n[[force]]\ngravity = "-9.81*E3"\n'


def listed(values):
    return "[" + ", ".join(f'"{v}"' if isinstance(v, str) else str(v) for v in values) + "]"


def cartesian(names):
    return f"{{ cartesian = {listed(names)} }}"


def parameters_of_turn(name):
    """Euler parameters, named after the body."""
    return f"{{ euler_parameters = {listed(f'{name}_{k}' for k in range(4))} }}"


def angles_of_turn(name, euler="312"):
    return f'{{ euler = "{euler}", angles = {listed(f"{name}_{k}" for k in "abc")} }}'


def own_place(name):
    return cartesian(f"{name}_{k}" for k in "xyz")


def about(axis, angle):
    return f'{{ axis = "{axis}", angle = "{angle}" }}'


def body(name, mass, inertia, position, rotation, parent=None):
    inertia = f"{{ principal = {listed(inertia)} }}" if isinstance(inertia, tuple) else inertia
    position = f'"{position}"' if not position.startswith("{") else position
    relative = f'relative_to = "{parent}"\n' if parent else ""
    return f'\n[[body]]\nname = "{name}"\nmass = {listed([mass])[1:-1]}\ninertia = {inertia}\nposition = {position}\n{relative}rotation = {rotation}\n'


def joint(name, kind, bodies, at, axis=None):
    text = f'\n[[joint]]\nname = "{name}"\ntype = "{kind}"\nbodies = {listed(bodies)}\nat = {listed([at])[1:-1] if isinstance(at, str) else listed(at)}\n'
    return text + (f"axis = {listed([axis])[1:-1] if isinstance(axis, str) else listed(axis)}\n" if axis else "")


def constraint(name, **what):
    (kind, value), = what.items()
    return f'\n[[constraint]]\nname = "{name}"\n{kind} = ' + (value if value.startswith("{") else f'"{value}"') + "\n"


def rolling(name, of, at):
    return constraint(name, rolling=f'{{ body = "{of}", at = "{at}", on = "ground" }}')


def kept(name):
    """A mechanism that tests linearise."""
    return (growth_models.ROOT / "tests" / "linear" / "models" / f"{name}.toml").read_text()


def with_guess(initial, guess, end=1):
    return scene(initial, end) + f"guess = {{ {guess} }}\n"


def free_body(constraints="", omega="[0.3, 0.2, 1]"):
    """An asymmetric body, free."""
    return "format = 1\n" + body("B", 1.5, (1, 2, 2.5), cartesian("xyz"), parameters_of_turn("e")) + constraints + scene({'"B.omega"': omega, "x_dot": 1, "y_dot": 0.5})


def suslov():
    """Suslov's problem, with an additional position: omega . e3 = 0."""
    return free_body(constraint("s", velocity="dot(omega(B), B.e3)"), "[0.3, 0.2, 0]")


def rolling_disk():
    disk = body("disk", 0.5, "{ disk = 0.2 }", cartesian("xyz"), parameters_of_turn("e"))
    return "format = 1\n" + disk + DOWN + constraint("contact", rolling='{ body = "disk", shape = { disk = 0.2 }, on = "ground" }') + scene({"e_0": 0.8, "e_1": 0.6, '"disk.omega"': "[0, 0.1, 6]"}, 2)


def rattleback():
    """An ellipsoid whose axes of inertia are turned against its own; it spins."""
    return kept("rattleback").split("[scene.default]")[0].rstrip() + "\n" + scene({"e0": 0.999, "e1": 0.02, "e2": 0.01, '"B.omega"': "[0.01, 0.02, 2]"}, 2)


def eccentric_ellipsoid():
    """An ellipsoid with arbitrary centre of mass and axes of inertia."""
    text = rattleback()
    inertia = 'inertia = [["0.01 kg*m^2", "0.001 kg*m^2", "0.0004 kg*m^2"], ["0.001 kg*m^2", "0.02 kg*m^2", "-0.0015 kg*m^2"], ["0.0004 kg*m^2", "-0.0015 kg*m^2", "0.022 kg*m^2"]]'
    text = "\n".join(inertia if line.startswith("inertia") else line for line in text.split("\n"))
    for old, new in (('"0.03 m"', '"0.15 m"'), ('"0.02 m"', '"0.1 m"'), ("+ 0.01*B.e3", "+ 0.01*B.e1 + 0.02*B.e2 - 0.01*B.e3")):
        text = text.replace(old, new)
    return text


def bicycle():
    """The benchmark bicycle in nine coordinates."""
    return kept("bicycle")


def bicycle_of_four_bodies():
    """The same, each body with its own coordinates, on three pins."""
    return kept("bicycle_of_four_bodies")


# Bricard's orthogonal loop along the edges of a cube: corners, and the directions of the hinges there.
CORNERS = [(0, 0, 0), (0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 0, 1), (1, 0, 0)]
HINGES = [(0, 0, 1), (1, 0, 0), (0, -1, 0), (0, 0, -1), (-1, 0, 0), (0, 1, 0)]


def vector(components, axes="E{}"):
    return " ".join(f"{c:+g}*" + axes.format(k + 1) for k, c in enumerate(components) if c) or "origin"


def bar(k):
    """Middle and direction of the bar from corner k to the next."""
    one, two = CORNERS[k], CORNERS[(k + 1) % 6]
    return [(a + b) / 2 for a, b in zip(one, two)], [b - a for a, b in zip(one, two)]


def bricard_of_bodies():
    """Five bars in Euler parameters with their own positions, six pins."""
    text, start = "format = 1\n", {}
    for k in range(1, 6):
        middle, along = bar(k)
        text += body(f"b{k}", 1, tuple(0.001 if a else 0.09 for a in along), own_place(f"b{k}"), parameters_of_turn(f"b{k}"))
        start |= {f"b{k}_{axis}": value for axis, value in zip("xyz", middle)}
    for k in range(6):
        bodies = [f"b{k}" if 0 < k < 6 else "ground" for k in ((k - 1) % 6, k)]
        text += joint(f"j{k}", "pin", bodies, vector(CORNERS[k]), vector(HINGES[k]))
    return text + DOWN + scene(start)


def bricard_of_angles():
    """Five bars, each turned against the one before; a pin closes the loop."""
    text, end = "format = 1\n", vector(CORNERS[1])
    for k in range(1, 6):
        _, along = bar(k)
        parent = f"b{k - 1}" if k > 1 else None
        arm = vector([a / 2 for a in along], f"b{k}.e{{}}")
        text += body(f"b{k}", 1, tuple(0.001 if a else 0.09 for a in along), f"{end} {arm}", about(vector(HINGES[k], f"{parent}.e{{}}" if parent else "E{}"), f"q{k}"), parent)
        text += f'\n[[point]]\nname = "P{k}"\nposition = "b{k} {arm}"\n'
        end = f"P{k}"
    return text + DOWN + joint("closed", "pin", ["b5", "ground"], vector(CORNERS[0]), vector(HINGES[0])) + scene({f"q{k}": 0 for k in range(1, 6)})


def bricard_of_distances():
    """Particles at both ends of each bar and a point on each hinge, at distances."""
    points = [(f"{letter}{k}", [c + h * (letter == "Q") for c, h in zip(CORNERS[k], HINGES[k])], k < 2) for k in range(6) for letter in "PQ"]
    text, start, seen = "format = 1\n", {}, set()
    for name, at, held in points:
        text += f'\n[[point]]\nname = "{name}"\nposition = {listed(at)}\n' if held else f'\n[[particle]]\nname = "{name}"\nmass = 1\nposition = {own_place(name)}\n'
        start |= {} if held else {f"{name}_{axis}": value for axis, value in zip("xyz", at)}
    for k in range(1, 6):
        of = [points[i % 12] for i in range(2 * k, 2 * k + 4)]
        for i, (p, at, held) in enumerate(of):
            for q, there, too in of[:i]:
                if not (held and too) and (p, q) not in seen and (q, p) not in seen:
                    seen.add((p, q))
                    text += constraint(f"d{p}{q}", holonomic=f"dot({p} - {q}, {p} - {q}) - {sum((a - b) ** 2 for a, b in zip(at, there))}")
    return text + DOWN + scene(start)


def bricard_of_products():
    """Directions of the hinges as coordinates, and scalar products between them; bars along their vector products."""
    names = [f"{axis}{k}" for k in range(2, 6) for axis in "xyz"]
    text = "format = 1\n\n[coordinates]\n" + "".join(f"{name} = {{}}\n" for name in names) + '\n[definitions]\na0 = "E3"\na1 = "E1"\nP0 = "E2"\n'
    text += "".join(f'a{k} = "x{k}*E1 + y{k}*E2 + z{k}*E3"\n' for k in range(2, 6))
    text += "".join(f'P{k} = "P{k - 1} {"-+"[k % 2 == 0]} cross(a{k}, a{k + 1})"\n' for k in range(1, 5))
    for k in range(1, 5):
        text += f'\n[[particle]]\nname = "M{k}"\nmass = 1\nposition = "P{k}"\n\n[[particle]]\nname = "N{k}"\nmass = 1\nposition = "P{k} + a{k + 1}"\n'
    text += "".join(constraint(f"unit{k}", holonomic=f"dot(a{k}, a{k}) - 1") for k in range(2, 6))
    text += "".join(constraint(f"right{k}", holonomic=f"dot(a{k}, a{(k + 1) % 6})") for k in range(1, 6))
    return text + constraint("closed", holonomic="P4 - cross(a5, a0)") + DOWN + scene({name: HINGES[int(name[1])]["xyz".index(name[0])] for name in names})


def ball_in_a_bowl(place, rest, start, guess):
    """A ball that rolls in a bowl, in Euler parameters."""
    ball = body("ball", 1, "{ sphere = 0.1 }", place, parameters_of_turn("e"))
    return "format = 1\n" + rest.replace("BALL", ball) + DOWN + with_guess(start | {'"ball.omega"': "[1, 2, 3]"}, guess, 2)


def bowl_in_spherical_coordinates():
    return ball_in_a_bowl('{ spherical = [0.9, "phi", "theta"] }', "BALL" + constraint("rolls", velocity="velocity(ball) + cross(omega(ball), 0.1*unit(ball))"), {"phi": 2.6, "theta": 0.3}, "e_0 = 1")


def bowl_in_cartesian_coordinates():
    """The middle of the ball on a sphere, and no slip in three components, one of which is redundant."""
    rest = constraint("on_bowl", holonomic="x^2 + y^2 + z^2 - 0.9^2") + constraint("rolls", velocity="velocity(ball) + cross(omega(ball), ball/9)")
    return ball_in_a_bowl(cartesian("xyz"), "BALL" + rest, {"x": 0.4, "y": 0.1}, "z = -0.8")


def bowl_as_a_surface():
    """The middle of the ball on a paraboloid."""
    rest = '\n[definitions]\nn = "unit(E3 - 2*x*E1 - y*E2)"\n' + constraint("rolls", velocity="velocity(ball) - cross(omega(ball), 0.1*n)")
    return ball_in_a_bowl(cartesian(["x", "y", "x^2 + y^2/2"]), "BALL" + rest, {"x": 0.4, "y": 0.1}, "e_0 = 1")


def bowl_as_a_body():
    bowl = body("bowl", 1, "{ sphere = 1 }", "origin", "{ fixed = true }")
    rest = bowl + constraint("rolls", rolling='{ body = "ball", on = "bowl", shape = { sphere = 0.1 }, shape_b = { hollow = 1 } }')
    return ball_in_a_bowl(cartesian("xyz"), "BALL" + rest, {"x": 0.4, "y": 0.1}, "z = -0.8")


def car(n):
    """A car whose front wheels are steered, with n trailers, by velocity constraints."""
    text = "format = 1\n" + body("car", 1000, '"1500"', cartesian("xy"), about("E3", "th0"))
    text += '\n[[frame]]\nname = "steered"\nrelative_to = "car"\nrotation = { axis = "E3", angle = "steer" }\n\n[[point]]\nname = "A0"\nposition = "car - 1.2*car.e1"\n\n[[point]]\nname = "front"\nposition = "car + 1.3*car.e1"\n'
    for k in range(1, n + 1):
        text += body(f"T{k}", 500 + 20 * k, f'"{600 + 30 * k}"', f"A{k - 1} - 1.5*T{k}.e1", about("E3", f"th{k}")) + f'\n[[point]]\nname = "A{k}"\nposition = "T{k} - 0.4*T{k}.e1"\n'
    text += constraint("front_wheels", velocity="dot(velocity(front), steered.e2)") + constraint("axle0", velocity="dot(velocity(A0), car.e2)")
    text += "".join(constraint(f"axle{k}", velocity=f"dot(velocity(A{k}), T{k}.e2)") for k in range(1, n + 1))
    text += '\n[[force]]\non = "car"\nforce = "500*car.e1"\n\n[[force]]\ntorsion = { angle = "steer", stiffness = 100, coefficient = 20 }\n\n[coordinates]\nsteer = "rad"\n'
    return text + "\n[energy]\nkinetic = \"(steer_dot + th0_dot)^2\"\n" + scene({"steer": 0.3, "x_dot": 2} | {f"th{k}": round(0.1 * k, 1) for k in range(n + 1)}, 2)


def truck():
    """A steered truck with three trailers: five axles, seven coordinates."""
    return car(3)


def rocket_car():
    """A body on two axles, the front one a body that turns against it, each with wheels that turn; thrust along the front."""
    text = "format = 1\n\n[inputs]\nF = { default = 10 }\nT = { default = 0 }\n\n[coordinates]\nqf = \"rad\"\n" + body("Ab", 10, '"2"', cartesian("xy"), about("E3", "q0")) + body("Af", 2, '"0.4"', "Ab + 1*Ab.e1 + 0.5*Ab.e1", about("E3", "q0 + qf"))
    text += body("ob", 2, '"0.4"', "Ab - 1*Ab.e1", about("E3", "q0"))
    for name, of in (("l", "Af"), ("r", "Af"), ("bl", "ob"), ("br", "ob")):
        side = "+" if name.endswith("l") else "-"
        text += body("w" + name, 1, (0.01, 0.02, 0.01), f"{of} {side} 0.4*{of}.e2 + 0.2*E3", about(f"{of}.e2", "u" + name), of)
        text += constraint("roll_" + name, velocity=f"dot(velocity(w{name}), {of}.e1) - 0.2*u{name}_dot")
    text += constraint("across_front", velocity="dot(velocity(Af), Af.e2)") + constraint("across_rear", velocity="dot(velocity(ob), ob.e2)")
    return text + '\n[[force]]\non = "Af"\nforce = "F*Af.e1"\n\n[[force]]\nmoment = "T*E3"\non = "Af"\n\n[[force]]\nmoment = "-T*E3"\non = "Ab"\n' + scene({"q0": 0.1, "qf": 0.2, "x_dot": 1}, 2)


def wheels_on_one_axle(height="z"):
    """Two wheels on an axle, by rolling. The conditions of the second for height and sideways slip repeat those of the first."""
    text = f'format = 1\n\n[[point]]\nname = "hub"\nposition = {cartesian(["x", "y", height])}\n' + body("axle", 5, (0.1, 0.5, 0.5), "hub + 0.1*axle.e1", about("E3", "th"))
    for name, side in (("left", "+"), ("right", "-")):
        text += body(name, 2, (0.05, 0.09, 0.05), f"hub {side} 0.5*axle.e2", about("axle.e2", "p_" + name), "axle") + rolling("roll_" + name, name, "-0.3*E3")
    return text + (DOWN if height == "z" else "") + scene({"x_dot": 1, "th_dot": 0.5, "th": 0}, 2)


def wheels_at_constant_height():
    return wheels_on_one_axle(0.3)


def upright_disk():
    """A disk that stays upright rolls at constant height."""
    disk = body("disk", 1, "{ disk = 0.2 }", cartesian(["x", "y", 0.2]), about("f.e3", "p"), "f")
    frame = '\n[[frame]]\nname = "g"\nrotation = { axis = "E3", angle = "th" }\n\n[[frame]]\nname = "f"\nrelative_to = "g"\nrotation = { axis = "g.e1", angle = "90 deg" }\n'
    return "format = 1\n" + frame + disk + constraint("contact", rolling='{ body = "disk", shape = { disk = 0.2 }, on = "ground" }') + scene({"x_dot": 1, "th_dot": 0.5}, 2)


def on_ball_joints(turn):
    """Five bodies with their own coordinates on ball joints."""
    text = "format = 1\n"
    for k in range(1, 6):
        text += body(f"b{k}", 1, (0.1, 0.12, 0.02), own_place(f"b{k}"), turn(f"b{k}"))
        text += joint(f"j{k}", "ball", ["ground" if k == 1 else f"b{k - 1}", f"b{k}"], ["origin" if k == 1 else f"b{k - 1} - 0.5*b{k - 1}.e3", f"b{k} + 0.5*b{k}.e3"])
    return text + DOWN


def bodies_on_ball_joints():
    return on_ball_joints(parameters_of_turn) + scene({"b1_1": 0.1, "b2_2": 0.2, "b3_1": 0.3, "b4_2": 0.1, "b5_1": 0.2})


def bodies_on_ball_joints_in_angles():
    return on_ball_joints(lambda name: angles_of_turn(name, "321")) + scene({"b1_b": 0.1, "b2_c": 0.2, "b3_b": 0.3, "b4_c": 0.1, "b5_b": 0.2})


def bennett():
    """Bennett's loop: two arms about fixed hinges, a coupler on a pin at the first and, in scalar products, on the second."""
    text = 'format = 1\n\n[parameters]\na = "1 m"\nalpha = "0.7 rad"\nbeta = "1.1 rad"\nb = "a*sin(beta)/sin(alpha)"\n'
    hinge = "cos({1})*{0}.e3 + sin({1})*cross({0}.e1, {0}.e3)"
    text += body("one", "1 kg", (0.01, 0.1, 0.1), "b/2*one.e1", about("E3", "p"))
    text += '\n[[frame]]\nname = "ground2"\nrotation = { axis = "E1", angle = "alpha" }\n'
    text += body("two", "1 kg", (0.01, 0.1, 0.1), "a*E1 + b/2*two.e1", about("ground2.e3", "s"), "ground2")
    text += body("coupler", "1 kg", (0.01, 0.08, 0.08), own_place("c"), parameters_of_turn("c"))
    text += joint("pin", "pin", ["one", "coupler"], ["one + b/2*one.e1", "coupler - a/2*coupler.e1"], [hinge.format("one", "beta"), "coupler.e3"])
    text += '\n[definitions]\nQ = "two + b/2*two.e1"\nP = "one + b/2*one.e1"\nh = "' + hinge.format("two", "beta") + '"\n'
    text += constraint("length", holonomic="dot(Q - P, Q - P) - a^2") + constraint("twist", holonomic="dot(coupler.e3, h) - cos(alpha)")
    text += constraint("across", holonomic="dot(Q - P, h)") + constraint("end", holonomic="Q - coupler - a/2*coupler.e1")
    text = text.replace("cross(one.e1, one.e3)", "(-1)*one.e2").replace("cross(two.e1, two.e3)", "(-1)*two.e2")
    return text + DOWN.replace("9.81", "9.81 ").replace("9.81 *", "9.81[m/s^2]*") + with_guess({"p": 0.5, "p_dot": 1}, "s = 1.58, c_0 = 0.43, c_1 = 0.45, c_2 = -0.27, c_3 = 0.74, c_x = 1.1, c_y = 0.86, c_z = 0.45")


def platform():
    """A platform on six legs, five of which are driven; the sixth is a spring with a damper."""
    text = "format = 1\n\n[functions]\n" + "".join(f'len{k} = "1.2 + 0.05*sin({1 + 0.1 * k:.1f}*t)"\n' for k in range(1, 6))
    text += body("plate", 20, (1, 1.2, 2), cartesian("xyz"), '{ euler = "321", angles = ["psi", "theta", "phi"] }') + DOWN
    for k, (foot, top) in enumerate(zip((-15, 15, 105, 135, 225, 255), (-45, 45, 75, 165, 195, 285)), 1):
        text += f'\n[[point]]\nname = "f{k}"\nposition = ["cos({foot}[deg])", "sin({foot}[deg])", 0]\n\n[[point]]\nname = "p{k}"\non = "plate"\nat = ["0.6*cos({top}[deg])", "0.6*sin({top}[deg])", 0]\n'
        spring = f'\n[[force]]\nspring_damper = {{ between = ["p{k}", "f{k}"], stiffness = 5000, length = 1.2, coefficient = 50 }}\n'
        text += constraint(f"leg{k}", holonomic=f"norm(p{k} - f{k}) - len{k}") if k < 6 else spring
    return text + with_guess({"phi": 0}, "z = 1", 2)


MECHANISMS = {
    "free_body": free_body,
    "suslov": suslov,
    "rolling_disk": rolling_disk,
    "rattleback": rattleback,
    "eccentric_ellipsoid": eccentric_ellipsoid,
    "bicycle": bicycle,
    "bicycle_of_four_bodies": bicycle_of_four_bodies,
    "bricard_of_bodies": bricard_of_bodies,
    "bricard_of_angles": bricard_of_angles,
    "bricard_of_distances": bricard_of_distances,
    "bricard_of_products": bricard_of_products,
    "bennett": bennett,
    "bowl_in_spherical_coordinates": bowl_in_spherical_coordinates,
    "bowl_in_cartesian_coordinates": bowl_in_cartesian_coordinates,
    "bowl_as_a_surface": bowl_as_a_surface,
    "bowl_as_a_body": bowl_as_a_body,
    "truck_of_five_axles": truck,
    "car_with_4_trailers": lambda: car(4),
    "car_with_5_trailers": lambda: car(5),
    "car_with_6_trailers": lambda: car(6),
    "rocket_car": rocket_car,
    "wheels_on_one_axle": wheels_on_one_axle,
    "wheels_at_constant_height": wheels_at_constant_height,
    "upright_disk": upright_disk,
    "bodies_on_ball_joints": bodies_on_ball_joints,
    "bodies_on_ball_joints_in_angles": bodies_on_ball_joints_in_angles,
    "platform": platform,
    "rods_on_conical_joints": lambda: growth_models.rods(3),
}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in MECHANISMS:
        sys.exit(f"usage: mechanism_models.py {'|'.join(MECHANISMS)}")
    print(MECHANISMS[sys.argv[1]](), end="")
