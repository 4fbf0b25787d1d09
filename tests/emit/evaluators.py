# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluators of emitted Julia and Modelica, for machines without Julia or a Modelica compiler.

julia(path) returns the names of the module: its statements are translated to Python one by one. modelica(path) returns
a Model: its declarations and equations are read, and der() of every state is computed from them. Both accept only the
forms that the targets write, and fail for anything else.
"""

import ctypes
import keyword
import math
import operator
import re
import sys


def quotient(a, b):
    """a/b as in C, which has quotients of 0."""
    if b != 0:
        return a / b
    return math.nan if a == 0 or a != a else math.copysign(math.inf, a) * math.copysign(1.0, b)


class Double(float):
    """A number of double precision."""


class Single(float):
    """A number of single precision. Operations round, also those with a Python float."""

    def __new__(cls, value):
        return float.__new__(cls, ctypes.c_float(float(value)).value)


for name, operation in (("add", operator.add), ("sub", operator.sub), ("mul", operator.mul), ("truediv", quotient)):
    for real in (Double, Single):
        setattr(real, f"__{name}__", lambda a, b, f=operation, r=real: r(f(float(a), float(b))))
        setattr(real, f"__r{name}__", lambda a, b, f=operation, r=real: r(f(float(b), float(a))))
for real in (Double, Single):
    real.__neg__ = lambda a, r=real: r(-float(a))
    real.__abs__ = lambda a, r=real: r(abs(float(a)))


def function(of):
    """A function of the module math with the precision of its first argument; NaN outside of its domain."""

    def value(*arguments):
        real = Single if isinstance(arguments[0], Single) else Double
        try:
            return real(of(*map(float, arguments)))
        except ValueError:
            return real(math.nan)
        except OverflowError:
            return real(math.inf)

    return value


FUNCTIONS = {name: function(getattr(math, name)) for name in (
    "sqrt", "log", "exp", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")}
power = function(math.pow)

# Julia


class Array(list):
    """A Julia array: entries from 1 on."""

    real = Double

    def __getitem__(self, index):
        value = list.__getitem__(self, self.place(index))
        return Double(value) if type(value) is float else value

    def __setitem__(self, index, value):
        list.__setitem__(self, self.place(index), self.real(value))

    def place(self, index):
        if not 1 <= index <= len(self):
            raise IndexError(index)
        return index - 1


class Constructor:
    """Float64[1.0, 2.0] and Float64(x)."""

    def __init__(self, real):
        self.real = real

    def __getitem__(self, values):
        return Array(self.real(v) for v in (values if isinstance(values, tuple) else (values,)))

    def __call__(self, value):
        return self.real(value)


def fill(array, value):
    for k in range(1, len(array) + 1):
        array[k] = value


JULIA = {
    **FUNCTIONS, "power": power, "abs": abs, "max": max, "min": min, "round": round, "length": len,
    "NaN": math.nan, "Inf": math.inf, "NaN32": Single(math.nan), "Inf32": Single(math.inf), "nothing": None,
    "true": True, "false": False,
    "Float64": Constructor(Double), "Float32": Constructor(Single), "Int": Constructor(int),
    "String": Constructor(str), "zeros": lambda n: Array([0.0] * n), "fill_b": fill,
    "ifelse": lambda c, a, b: a if c else b, "oftype": lambda a, value: type(a)(value), "one": lambda a: type(a)(1),
    "mod": lambda a, b: a % b, "eachindex": lambda a: range(1, len(a) + 1),
    "atan": lambda *a: FUNCTIONS["atan"](*a) if len(a) == 1 else FUNCTIONS["atan2"](*a),
}


def split_strings(line):
    """The code of a line with its strings replaced by \x00k\x00, and the strings."""
    strings, code, k = [], "", 0
    while k < len(line):
        if line[k] == "#":
            break
        if line[k] == '"':
            end = k + 1
            while line[end] != '"':
                if line[end] == "$":
                    raise SyntaxError("interpolation: " + line)
                end += 2 if line[end] == "\\" else 1
            strings.append(line[k + 1:end].replace("\\$", "$"))
            code += f"\0{len(strings) - 1}\0"
            k = end + 1
            continue
        code += line[k]
        k += 1
    return code.rstrip(), strings


def translated(code):
    """An expression of Julia as one of Python."""
    code = re.sub(r"(?<![\w.])(\d[\d.]*)f(-?\d+)", r'Float32("\1e\2")', code)
    code = re.sub(r"(Float64|Float32|Int|String)\[\]", r"\1[()]", code)
    code = re.sub(r"(\w)!\(", r"\1_b(", code)
    code = re.sub(r"!(?=\()", " not ", code)
    code = code.replace("!==", " is not ").replace("===", " is ").replace("||", " or ").replace("&&", " and ")
    code = re.sub(r"(\w+)\^(\w+)", r"power(\1, \2)", code)
    return code.replace("; ", ", ") if "(" in code else code


PYTHON_ONLY = set(keyword.kwlist) - {"if", "for", "in", "return"}


def julia(path):
    body, depth, ends, module = [], 0, [], None
    for line in open(path, encoding="ascii"):
        code, strings = split_strings(line.rstrip("\n"))
        code = re.sub(r"\b[A-Za-z]+\b", lambda word: word[0] + "_" * (word[0] in PYTHON_ONLY), code.strip())
        if not code or code.startswith("export "):
            continue
        if code.startswith("module "):
            module = code.split()[1]
            ends.append("module")
            continue
        if code == "end":
            if ends.pop() != "module":
                depth -= 1
            continue
        head = re.fullmatch(r"function (\w+)(!?)\((.*)\)", code)
        condition = re.fullmatch(r"if (.*)", code)
        loop = re.fullmatch(r"for (\w+) in (.*)", code)
        early = re.fullmatch(r"(.*) (&&|\|\|) (return .*|fill!.*)", code)
        if head:
            python = f"def {head[1]}{'_b' if head[2] else ''}({head[3].replace('; ', ', ').lstrip(', ')}):"
        elif condition:
            python = f"if {translated(condition[1])}:"
        elif loop:
            python = f"for {loop[1]} in {translated(loop[2])}:"
        elif early:
            test = translated(early[1])
            done = early[3] if early[3].startswith("return") else translated(early[3])
            done = "return " + translated(done[7:]) if done.startswith("return ") else done
            python = f"if {'not ' if early[2] == '||' else ''}({test}): {done}"
        elif code.startswith("return "):
            python = "return " + translated(code[7:])
        elif re.match(r"(const )?\w+(\[\d+\])? = |\w+!\(", code):
            python = translated(code.removeprefix("const "))
        else:
            raise SyntaxError(line)
        for k, string in enumerate(strings):
            python = python.replace(f"\0{k}\0", repr(string))
        body.append("  " * depth + python)
        if head or condition or loop:
            depth += 1
            ends.append("block")
            body.append("  " * depth + "pass")  # an empty block is one of Julia too
    if ends or depth or module is None:
        raise SyntaxError("the module does not end")
    names = dict(JULIA)
    exec(compile("\n".join(body), path, "exec"), names)
    return names


# Modelica

TOKEN = re.compile(r"\s*(?:(\d+\.?\d*(?:e-?\d+)?)|([A-Za-z]\w*)|(<=|>=|==|<>|[-+*/^<>(),]))")
MODELICA = {**FUNCTIONS, "power": power, "abs": abs}
COMPARISONS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq}


class Expression:
    """The grammar of Modelica's expressions, as far as the target writes it."""

    def __init__(self, text, values):
        self.values, self.at, self.tokens = values, 0, []
        place = 0
        while place < len(text.rstrip()):
            match = TOKEN.match(text, place)
            if not match:
                raise SyntaxError(text[place:])
            self.tokens.append(match[1] or match[2] or match[3])
            place = match.end()
        self.tokens.append("")

    def value(self):
        result = self.logical()
        if self.tokens[self.at]:
            raise SyntaxError(" ".join(self.tokens[self.at:]))
        return result

    def take(self, *wanted):
        if self.tokens[self.at] in wanted:
            self.at += 1
            return self.tokens[self.at - 1]
        return None

    def require(self, token):
        if not self.take(token):
            raise SyntaxError(f"{token} is missing before {self.tokens[self.at]}")

    def logical(self):
        if self.take("if"):
            condition = self.logical()
            self.require("then")
            yes = self.logical()
            self.require("else")
            no = self.logical()
            return yes if condition else no
        if self.take("not"):
            return not self.primary()
        left = self.sum()
        comparison = self.take(*COMPARISONS)
        return COMPARISONS[comparison](left, self.sum()) if comparison else left

    def sum(self):
        sign = self.take("+", "-")  # before the first term only: a + -b is no expression
        result = -self.product() if sign == "-" else self.product()
        while operation := self.take("+", "-"):
            term = self.product()
            result = result + term if operation == "+" else result - term
        return result

    def product(self):
        result = self.primary()
        while operation := self.take("*", "/"):
            factor = self.primary()
            result = result * factor if operation == "*" else quotient(result, factor)
        return result

    def primary(self):
        result = self.atom()
        return power(result, self.atom()) if self.take("^") else result

    def atom(self):
        if self.take("("):
            result = self.logical()
            self.require(")")
            return result
        token = self.tokens[self.at]
        self.at += 1
        if token[:1].isdigit():
            return float(token)
        if token in MODELICA:
            self.require("(")
            arguments = [self.logical()]
            while self.take(","):
                arguments.append(self.logical())
            self.require(")")
            return MODELICA[token](*arguments)
        return self.values[token]


class Model:
    def __init__(self, path):
        text = open(path, encoding="ascii").read()
        self.parameters, self.inputs, self.states, self.constants = {}, {}, {}, {}
        self.units, self.equations, names, intermediate, section = {}, [], set(), set(), None
        string = r'"(?:[^"\\]|\\.)*"'
        text = re.sub(r"  function power\n.*?  end power;\n", "", text, flags=re.S)
        for line in text.split("\n"):
            line = re.sub(rf"^((?:[^\"/]|{string}|/(?!/))*)//.*$", r"\1", line).strip()
            if not line:
                continue
            if head := re.fullmatch(rf"model (\w+)(?: {string})?", line):
                self.name, section = head[1], "public"
            elif line in ("protected", "equation"):
                section = line
            elif line == f"end {self.name};":
                section = "end"
            elif re.fullmatch(r"annotation\(experiment\(StartTime = [-\d.e]+\)\);", line) and section == "equation":
                pass
            elif section in ("public", "protected"):
                found = re.fullmatch(rf"(parameter |input |constant |)Real (\w+)(\((?:[^()\"]|{string})*\))?"
                                     rf"(?: = ([-\d.e]+))?(?: {string})?;", line)
                if not found or found[2] in names:
                    raise SyntaxError(line)
                kind, name, attributes, value = found[1], found[2], found[3] or "", found[4]
                names.add(name)
                start = re.search(r"start = ([-\d.e]+)", attributes)
                unit = re.search(r'unit = "([^"]*)"', attributes)
                self.units[name] = unit[1] if unit else ""
                if kind in ("parameter ", "constant "):
                    (self.parameters if kind == "parameter " else self.constants)[name] = float(value)
                elif kind == "input ":
                    self.inputs[name] = float(start[1])
                elif start:
                    if "fixed = true" not in attributes:
                        raise SyntaxError(line)
                    self.states[name] = float(start[1])
                else:
                    intermediate.add(name)
            elif section == "equation":
                found = re.fullmatch(rf"(?:(der)\((\w+)\)|(\w+)) = (.*);|assert\((.*), ({string})\);", line)
                if not found:
                    raise SyntaxError(line)
                self.equations.append((bool(found[1]), found[2] or found[3], found[4] or found[5]))
            else:
                raise SyntaxError(line)
        if section != "end":
            raise SyntaxError("the model does not end")
        defined = [(derivative, name) for derivative, name, _ in self.equations if name]
        balanced = sorted([(True, name) for name in self.states] + [(False, name) for name in intermediate])
        if sorted(defined) != balanced:
            raise SyntaxError("equations and unknowns do not match")

    def derivatives(self, t, x, p, u):
        """(dx, code): 1 if an assertion fails."""
        values = {"time": float(t), **self.constants}
        for names, array in ((self.states, x), (self.parameters, p), (self.inputs, u if len(u) else [*self.inputs.values()])):
            values.update(zip(names, map(float, array), strict=True))
        result = {}
        for derivative, name, expression in self.equations:
            value = Expression(expression, values).value()
            if name is None and not value:
                return list(result.values()), 1
            if name is not None:
                (result if derivative else values)[name] = value
        return [result[name] for name in self.states], 0


def modelica(path):
    return Model(path)


def off(got, expected):
    """The largest difference, of the largest entry."""
    if len(expected) == 0:
        return 0.0
    largest = max(1e-300, max(abs(v) for v in expected))
    difference = max(abs(float(a) - b) for a, b in zip(got, expected, strict=True)) / largest
    return difference if difference == difference else 1.0


if __name__ == "__main__":
    print(julia(sys.argv[1])["selftest"]())
