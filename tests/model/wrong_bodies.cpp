// SPDX-License-Identifier: GPL-3.0-or-later
// Invalid bodies, frames, rotations and inertias.
#include "wrong_models.hpp"

namespace eomgen::model {
namespace {

// Line 6 is [[body]], 7 name, 8 mass, 9 inertia, 10 rotation.
std::string top(const std::vector<std::pair<std::string, std::string>>& edits, const std::string& more = "") {
  std::string text = R"(format = 1
[parameters]
m = "1 kg"
J = "2 kg*m^2"
g = "9.81 m/s^2"
[[body]]
name = "B"
mass = "m"
inertia = { principal = ["J", "J", "J"] }
rotation = { euler = "313", angles = ["phi", "theta", "psi"] }
[[force]]
moment = "2[N*m]*E3"
on = "B"
)";
  for (const auto& [from, to] : edits) text.replace(text.find(from), from.size(), to);
  return text + more;
}

constexpr const char* rotations_are =
    "write rotation = { euler = \"313\", angles = [\"phi\", \"theta\", \"psi\"] }, { axis = \"E3\", angle = \"phi\" }, "
    "{ euler_parameters = [..] }, { rodrigues = [..] } or { fixed = true }";
constexpr const char* inertias_are =
    "write inertia = { principal = [\"A\", \"B\", \"C\"] }, a symmetric [[..], [..], [..]], or a shape such as { "
    "sphere = \"R\" }";
constexpr const char* shapes_are =
    "write { sphere = \"R\" }, { box = [\"a\", \"b\", \"c\"] }, { cylinder = [\"R\", \"L\"] }, { disk = \"R\" }, { rod "
    "= \"L\" }, { arrow = [\"x\", \"y\", \"z\"] } or { mesh = [[\"x\", \"y\", \"z\"], ..] }";
constexpr const char* points_are =
    "give its points as [[\"x\", \"y\", \"z\"], ..], from 4 to 60 of them, or to 200 with faces";
constexpr const char* faces_are =
    "give each face as the numbers of its points in their order, [1, 2, 3], counted from 1";
const std::string angles = "{ euler = \"313\", angles = [\"phi\", \"theta\", \"psi\"] }";
const std::string equal_moments = "{ principal = [\"J\", \"J\", \"J\"] }";

}  // namespace

std::vector<WrongModel> wrong_bodies() {
  return {
      {"a drawing of nothing", top({}, "[draw]\nC = { sphere = \"1 m\" }\n"), "15:1",
       "[draw] names 'C', which is no particle or body", "particles and bodies are B"},
      {"a drawing without a shape", top({}, "[draw]\nB = { axis = \"e1\" }\n"), "15:5",
       "the drawing of 'B' has no shape", shapes_are},
      {"a drawing of two shapes", top({}, "[draw]\nB = { sphere = \"1 m\", disk = \"1 m\" }\n"), "15:30",
       "the drawing of 'B' is both 'sphere' and 'disk'", "draw one of them, or give an array of tables"},
      {"a box of two sides", top({}, "[draw]\nB = { box = [\"1 m\", \"2 m\"] }\n"), "15:13",
       "the drawing of 'B' has 2 lengths here", "give 3 of them"},
      {"a drawing that moves", top({}, "[draw]\nB = { sphere = \"phi\" }\n"), "15:17",
       "'phi' depends on coordinates, which a length in the drawing of 'B' cannot",
       "what is drawn is made of numbers and parameters"},
      {"a drawing of no size", top({}, "[draw]\nB = { sphere = 0 }\n"), "15:16",
       "a length in the drawing of 'B' is not greater than 0", "give a length"},
      {"a mesh of three points", top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0]] }\n"), "15:14",
       "the drawing of 'B' has 3 points", points_are},
      {"a mesh of pairs", top({}, "[draw]\nB = { mesh = [[0, 0], [1, 0], [0, 1], [1, 1]] }\n"), "15:15",
       "the drawing of 'B' has 2 lengths here", "give 3 of them"},
      {"a face without its point",
       top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[1, 2, 5]] }\n"), "15:76",
       "the drawing of 'B' has no point 5", "its points are 1 to 4"},
      {"a face of a line",
       top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[1, 2]] }\n"), "15:69",
       "a face in the drawing of 'B' has 2 points", faces_are},
      {"a mesh with a point without a value",
       top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [0, \"sqrt(-m*1[m^2/kg])\", 0], [0, 0, 1]] }\n"), "15:41",
       "a length in the drawing of 'B' has no value", "check the numbers that it is computed from"},
      {"a mesh of equal points", top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [\"1 m\", 0, 0]] }\n"),
       "15:48", "points 2 and 4 in the drawing of 'B' are equal", "leave one of them out"},
      {"a mesh of points on a line",
       top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 1, 1], [2, 2, 2], [-0.3, -0.3, -0.3]] }\n"), "15:14",
       "the points in the drawing of 'B' lie on a line", "give points of a polygon or of a solid"},
      {"a face with a point twice",
       top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[1, 1, 1]] }\n"), "15:73",
       "a face in the drawing of 'B' has point 1 twice", faces_are},
      {"a face on a line",
       top({}, "[draw]\nB = { mesh = [[0, 0, 0], [1, 0, 0], [3, 0, 0], [0, 0, 1]], faces = [[1, 2, 4], [1, 2, 3]] }\n"),
       "15:80", "the points of a face in the drawing of 'B' lie on a line", faces_are},
      {"faces of no mesh", top({}, "[draw]\nB = { sphere = \"1 m\", faces = [[1, 2, 3]] }\n"), "15:31",
       "the drawing of 'B' has faces, and no points for them", shapes_are},
      {"a mesh that is a sphere",
       top({}, "[draw]\nB = { sphere = \"1 m\", mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }\n"), "15:30",
       "the drawing of 'B' is both 'sphere' and 'mesh'", "draw one of them, or give an array of tables"},
      {"a drawing about no axis", top({}, "[draw]\nB = { disk = \"1 m\", axis = \"E3\" }\n"), "15:28",
       "there is no own axis 'E3'",
       "write axis = \"e1\", \"e2\" or \"e3\": its own axis that a cylinder, disk or rod is about"},
      {"a body without a rotation", top({{"rotation = " + angles + "\n", ""}}), "6:1", "'B' has no rotation",
       rotations_are},
      {"a body without inertia", top({{"inertia = " + equal_moments + "\n", ""}}), "6:1", "'B' has no inertia",
       inertias_are},
      {"a body without mass", top({{"mass = \"m\"\n", ""}}), "6:1", "'B' has no mass",
       "add mass = \"m\" or a value such as \"2 kg\""},
      {"a body whose mass changes", top({{"mass = \"m\"", "mass = \"m*t/1[s]\""}}), "8:11",
       "'t' depends on time, which the mass of 'B' cannot",
       "the mass of a body is made of numbers and parameters; that of a [[particle]] may depend on time"},
      {"an unknown set of angles", top({{"313", "311"}}), "10:22", "there are no Euler angles '311'",
       "the twelve sets are 121, 131, 212, 232, 313, 323, 123, 132, 213, 231, 312, 321"},
      {"two angles", top({{", \"psi\"]", "]"}}), "10:38", "'angles' has 2 entries", "give 3 of them"},
      {"angles of no set", top({{"euler = \"313\", ", ""}}), "10:12", "the rotation states no kind", rotations_are},
      {"two kinds of rotation", top({{"euler = \"313\"", "euler = \"313\", fixed = true"}}), "10:29",
       "a rotation is both 'euler' and 'fixed'", "keep one of them"},
      {"an axis with angles", top({{"euler = \"313\"", "axis = \"E3\""}}), "10:27",
       "'angles' does not belong to a rotation by 'axis'", rotations_are},
      {"an axis without an angle", top({{angles, "{ axis = \"E3\" }"}}), "10:12",
       "a rotation about an axis has no angle", "add angle = \"phi\""},
      {"an axis that moves",
       top({{angles, "{ axis = \"a*E3 + b*E1\", angle = \"c\" }"}}, "[coordinates]\na = {}\nb = {}\n"), "10:22",
       "'a' depends on coordinates, which the axis of the rotation of 'B' cannot",
       "the axis is fixed in the parent: make it of E1, E2, E3; relative_to = \"B\" names another parent"},
      {"an axis of space in a body that turns",
       top({}, "[[frame]]\nname = \"F\"\nrotation = { axis = \"E3\", angle = \"chi\" }\nrelative_to = \"B\"\n"),
       "16:21", "this axis is not fixed in the parent", "make it of B.e1, B.e2, B.e3 with constant components"},
      {"three Euler parameters", top({{angles, "{ euler_parameters = [\"a\", \"b\", \"c\"] }"}}), "10:33",
       "'euler_parameters' has 3 entries", "give 4 of them"},
      {"an Euler parameter that is no coordinate",
       top({{angles, "{ euler_parameters = [\"a\", \"b\", \"c\", \"0\"] }"}}), "10:49",
       "an Euler parameter is a coordinate of its own", "give it a name, such as \"e0\""},
      {"a rotation that is not fixed", top({{angles, "{ fixed = false }"}}), "10:22",
       "a rotation cannot be fixed = false", rotations_are},
      {"relative to a particle", top({{"rotation =", "relative_to = \"C\"\nrotation ="}}), "10:15",
       "there is no body or frame 'C'", "the bodies and frames are B"},
      {"relative to itself", top({{"rotation =", "relative_to = \"B\"\nrotation ="}}), "10:15",
       "'the axes of B' is defined by itself: the axes of B -> the axes of B",
       "break the circle: one of these names has to be given without the others"},
      {"an angle that is made of its own axes", top({{"\"psi\"]", "\"dot(B.e1, E1)\"]"}}), "10:60",
       "'the axes of B' is defined by itself: the axes of B -> the axes of B",
       "break the circle: one of these names has to be given without the others"},
      {"two moments of inertia", top({{"[\"J\", \"J\", \"J\"]", "[\"J\", \"J\"]"}}), "9:25",
       "'principal' has 2 entries", inertias_are},
      {"moments that no body has", top({{"[\"J\", \"J\", \"J\"]", "[1, 5, 2]"}}), "9:29",
       "a principal moment is larger than the other two together, as that of no body",
       "check the values and their units"},
      {"a negative length", top({{"principal = [\"J\", \"J\", \"J\"]", "sphere = -1"}}), "9:22",
       "a length in the inertia of 'B' is negative", "a radius or an edge is 0 or more"},
      {"a negative moment", top({{"[\"J\", \"J\", \"J\"]", "[1, -1, 2]"}}), "9:29", "a moment of inertia is negative",
       "it is a sum of masses times squares"},
      {"a negative moment in a parameter", top({{"J = \"2", "J = \"-2"}}), "4:5",
       "a moment of inertia, the parameter 'J', is negative", "it is a sum of masses times squares"},
      {"a negative moment about one axis", top({{equal_moments, "-1"}, {angles, "{ axis = \"E3\", angle = \"phi\" }"}}),
       "9:11", "a moment of inertia is negative", "it is a sum of masses times squares"},
      {"a matrix that is not symmetric", top({{equal_moments, "[[1, 0, 0.1], [0, 1, 0], [0.2, 0, 1]]"}}), "9:37",
       "the inertia of 'B' is not symmetric", "write the same expression on both sides of the diagonal"},
      {"a matrix of two rows", top({{equal_moments, "[[1, 0, 0], [0, 1, 0]]"}}), "9:11",
       "the inertia of 'B' is not an array of three rows of three", inertias_are},
      {"an unknown shape", top({{equal_moments, "{ spher = \"1 m\" }"}}), "9:13",
       "the inertia of 'B' has no key 'spher'", "did you mean 'sphere'?"},
      {"a cylinder without its length", top({{equal_moments, "{ cylinder = [\"1 m\"] }"}}), "9:24",
       "'cylinder' has 1 entries", "write cylinder = [\"R\", \"L\"]"},
      {"one moment of a body that turns about many axes", top({{equal_moments, "\"J\""}}), "9:11",
       "one moment of inertia is not enough: 'B' does not rotate about one fixed axis", inertias_are},
      {"a mass for an inertia", top({{"[\"J\", \"J\", \"J\"]", "[\"m\", \"J\", \"J\"]"}}), "9:27",
       "the units clash: a principal moment must be in kg*m^2, and this is in kg",
       "use another name here, or correct the unit of 'm' in line 3"},
      {"a moment on a particle",
       top({{"on = \"B\"", "on = \"P\""}}, "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = \"g*1[s^2]*E1\"\n"),
       "13:6", "'P' is a particle or point, which has no axes", "the bodies and frames are B"},
      {"a moment on the ground", top({{"on = \"B\"", "on = \"ground\""}}), "13:6",
       "a moment on the ground changes nothing", "name a body or frame"},
      {"a force for a moment", top({{"2[N*m]", "2[N]"}}), "12:11",
       "the units clash: this moment must be in J, and this is in N",
       "check the formula and the units of the names in it"},
      {"a lift on a frame",
       top({},
           "[[frame]]\nname = \"F\"\nrotation = { fixed = true }\n[[force]]\nmagnus = { on = \"F\", coefficient = 1 "
           "}\n"),
       "18:17", "this magnus acts on a body, and 'F' has no mass", "name a [[body]]"},
      {"gravity of order 1", top({}, "[[force]]\ncentral_gravity = { GM = 1, order = 1 }\n"), "15:37",
       "central_gravity has no order '1'", "write order = 0 or order = 2"},
      {"a fourth axis", top({}, "[definitions]\na = \"B.e4\"\n"), "15:6", "'B' has no part 'e4'",
       "the position of 'B' depends on no coordinate"},
      {"an axis after three angles", top({}, "[definitions]\na = \"B.e1'''\"\n"), "15:6", "'B' has no axis 'B.e1''''",
       "one prime stands for the axes after the first of its angles, two for those after the second"},
      {"an intermediate axis of one angle",
       top({{angles, "{ axis = \"E3\", angle = \"phi\" }"}}, "[definitions]\na = \"B.e1'\"\n"), "15:6",
       "'B' has no axis 'B.e1''", "primes are for intermediate axes of Euler angles"},
      {"a part of a frame",
       top({}, "[[frame]]\nname = \"F\"\nrotation = { fixed = true }\n[definitions]\na = \"F.position\"\n"), "18:6",
       "'F' has no part 'position'", "its parts are e1, e2, e3, omega, and g_q for the coordinates q of its rotation"},
      {"a frame as a vector",
       top({}, "[[frame]]\nname = \"F\"\nrotation = { fixed = true }\n[definitions]\na = \"F\"\n"), "18:6",
       "'F' is a frame, not a value",
       "name a parameter, coordinate, state, function, input, definition, particle or point"},
      {"the angular velocity of a particle", pendulum({}, "[definitions]\nw = \"omega(P)\"\n"), "13:12",
       "omega() takes the name of a body or frame", "write omega(B) with a [[body]] or [[frame]]"},
      {"a point on a frame",
       top({},
           "[[frame]]\nname = \"F\"\nrotation = { fixed = true }\n[[point]]\nname = \"A\"\non = \"F\"\nat = [1, 0, "
           "0]\n"),
       "19:6", "a point is on a body, and this has no centre of mass",
       "name a [[body]], or give position = \"<vector>\""},
      {"a point on a body and elsewhere",
       top({}, "[[point]]\nname = \"A\"\non = \"B\"\nat = [1, 0, 0]\nposition = \"1[m]*E1\"\n"), "18:12",
       "'A' is on a body and has a position too", "keep one of them"},
      {"a point somewhere on a body", top({}, "[[point]]\nname = \"A\"\non = \"B\"\n"), "14:1", "'A' has no at",
       "add at = [x, y, z] along the body's axes, from its centre of mass"},
      {"a contact nowhere on the body",
       top({}, "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", on = \"ground\" }\n"), "16:11",
       "this contact does not state where the body is touched",
       "write rolling = { body = \"B\", at = \"<vector>\", on = \"ground\" }, with shape = { sphere = \"R\" } or { "
       "disk = \"R\" } instead of 'at' if it is one"},
      {"a body that touches itself",
       top({}, "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", on = \"B\", at = 0 }\n"), "16:30",
       "'B' cannot touch itself", "name the other body, or \"ground\""},
      {"a contact with a frame",
       top({},
           "[[frame]]\nname = \"F\"\nrotation = { fixed = true }\n[[constraint]]\nname = \"c\"\nrolling = { body = "
           "\"B\", on = \"F\", at = 0 }\n"),
       "19:30", "'F' has no mass: contact of two bodies needs two",
       "name a [[body]], or write the plane: on = { point = .., normal = .. }"},
      {"a contact with a second place on a plane",
       top({}, "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", on = \"ground\", at = 0, at_b = 0 }\n"),
       "16:48", "'at_b' belongs to a contact of two bodies, and this is one with a plane",
       "remove it, or name the other body in 'on'"},
      {"a contact with a plane without a normal",
       top({}, "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", at = 0, on = { point = 0 } }\n"), "16:38",
       "a plane has no normal", "add normal = \"E3\", which points to the side of the body"},
      {"rolling under a law that never holds",
       top({},
           "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", at = 0, on = \"ground\" }\nfriction = { dynamic = "
           "1, law = \"smooth\", width = \"1 mm/s\" }\n"),
       "17:12", "under the smooth law 'c' creeps and never rolls",
       "write sliding = { .. } in place of rolling, or law = \"coulomb\""},
      {"rolling without friction that can be left",
       top({},
           "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", at = 0, on = \"ground\" }\nholds = "
           "\"unilateral\"\n"),
       "17:9", "the constraint 'c' can be left and has no friction, so that the tangential impulse is not defined",
       "give it friction = { static = \"..\", dynamic = \"..\" }: where it lands the body slides, and rolls when slip "
       "has ended; or write sliding for a smooth one"},
      {"rolling and sliding",
       top({}, "[[constraint]]\nname = \"c\"\nrolling = { body = \"B\", at = 0, on = \"ground\" }\nsliding = {}\n"),
       "17:1", "the constraint 'c' is both 'rolling' and 'sliding'", "write one [[constraint]] for each"},
      {"a name that Euler parameters need",
       top({{angles, "{ euler_parameters = [\"a\", \"b\", \"c\", \"d\"] }"},
            {"[parameters]\n", "[parameters]\nB_unit = 1\n"}}),
       "11:12", "'B_unit' is declared twice", "it is a parameter on line 3; all names share one scope: choose another"},
  };
}

}  // namespace eomgen::model
