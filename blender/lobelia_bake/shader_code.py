"""Runs the shader code that `lobelia shader` prints, function by function, with values of any kind.

The code is in a small subset of GLSL (include/lobelia/shader_code.h of Lobelia): what a backend does with each operation
decides what comes out. Numbers gives numbers; the nodes of nodes.py give a network that computes the same.
"""
import re

TOKEN = re.compile(r"\s*(?:(\d+\.\d*(?:e[-+]?\d+)?|\d+)|([A-Za-z_]\w*)|([-+*/]=|<=|>=|==|!=|&&|\|\||\+\+|[-+*/<>=!?:;,.(){}\[\]]))")


class Unsupported(Exception):
    """Code beyond what can be translated; the message says what."""


def tokens_of(text):
    text = re.sub(r"//[^\n]*", "", text)
    tokens, at = [], 0
    while True:
        found = TOKEN.match(text, at)
        if not found:
            if text[at:].strip():
                raise Unsupported(f"shader code: {text[at:at + 20]!r} is not understood")
            return tokens
        number, name, sign = found.groups()
        tokens.append(("number", number) if number else ("name", name) if name else ("sign", sign))
        at = found.end()


class Program:
    """Functions of a text: name -> (parameter names, tokens of the body)."""

    def __init__(self, text):
        self.functions, self.coefficients = {}, 0
        tokens, i = tokens_of(text), 0
        while i < len(tokens):
            if tokens[i][1] == "struct":
                end = self._closing(tokens, tokens.index(("sign", "{"), i), "{", "}")
                inner = [token[1] for token in tokens[i:end]]
                if inner[1] == "Coefficients":
                    self.coefficients = int(inner[inner.index("[") + 1])
                i = end + 2
                continue
            name, opening = tokens[i + 1][1], i + 2
            closing = self._closing(tokens, opening, "(", ")")
            parameters = [tokens[k][1] for k in range(opening + 2, closing, 3)]
            end = self._closing(tokens, closing + 1, "{", "}")
            self.functions[name] = (parameters, tokens[closing + 2:end])
            i = end + 1

    @staticmethod
    def _closing(tokens, opening, left, right):
        depth = 0
        for i in range(opening, len(tokens)):
            depth += {left: 1, right: -1}.get(tokens[i][1], 0) if tokens[i][0] == "sign" else 0
            if depth == 0:
                return i
        raise Unsupported("shader code: a bracket is not closed")


class Run:
    """Runs functions of a program with a backend."""

    def __init__(self, program, backend, light):
        self.program, self.backend, self.light = program, backend, light

    def call(self, name, arguments):
        if name in ("float", "vec2", "vec3", "vec4"):
            return self.backend.construct(name, arguments)
        if name not in self.program.functions:
            return self.backend.builtin(name, arguments)
        parameters, body = self.program.functions[name]
        if name == "irradiance":
            arguments = [self.light, *arguments]
        return Body(self, dict(zip(parameters, arguments)), body).run()


class Body:
    """One call of a function: statements in a row, then a return."""

    def __init__(self, run, names, tokens):
        self.context, self.names, self.tokens, self.at = run, names, tokens, 0
        self.backend = run.backend

    def peek(self, offset=0):
        return self.tokens[self.at + offset][1] if self.at + offset < len(self.tokens) else None

    def take(self, expected=None):
        kind, text = self.tokens[self.at]
        if expected is not None and text != expected:
            raise Unsupported(f"shader code: {text!r} in place of {expected!r}")
        self.at += 1
        return text

    def run(self):
        while self.at < len(self.tokens):
            word = self.peek()
            if word == "return":
                self.take()
                return self.expression()
            if word in ("if", "for", "while"):
                raise Unsupported(f"its shader code has a branch ({word}), which nodes cannot follow")
            if word in ("float", "vec2", "vec3", "vec4", "bool") and self.peek(1) != "(":
                self.take()
                name = self.take()
                self.take("=")
                self.names[name] = self.expression()
            else:
                name, sign = self.take(), self.take()
                value = self.expression()
                self.names[name] = value if sign == "=" else self.backend.binary(sign[0], self.names[name], value)
            self.take(";")
        raise Unsupported("shader code: a function without a return")

    def expression(self):
        condition = self.level(0)
        if self.peek() != "?":
            return condition
        self.take()
        yes = self.expression()
        self.take(":")
        return self.backend.choose(condition, yes, self.expression())

    LEVELS = [("||",), ("&&",), ("<", ">", "<=", ">=", "==", "!="), ("+", "-"), ("*", "/")]

    def level(self, depth):
        if depth == len(self.LEVELS):
            return self.unary()
        left = self.level(depth + 1)
        while self.peek() in self.LEVELS[depth]:
            sign = self.take()
            left = self.backend.binary(sign, left, self.level(depth + 1))
        return left

    def unary(self):
        if self.peek() == "-":
            self.take()
            return self.backend.binary("-", 0.0, self.unary())
        value = self.primary()
        while self.peek() == ".":
            self.take()
            value = self.backend.component(value, self.take())
        return value

    def primary(self):
        kind, text = self.tokens[self.at]
        if text == "(":
            self.take()
            value = self.expression()
            self.take(")")
            return value
        self.take()
        if kind == "number":
            return float(text)
        if self.peek() == "(":
            self.take()
            arguments = []
            while self.peek() != ")":
                arguments.append(self.expression())
                if self.peek() == ",":
                    self.take()
            self.take()
            return self.context.call(text, arguments)
        if self.peek() == "." and self.peek(1) == "c" and self.peek(2) == "[":
            for _ in range(3):
                self.take()
            index = int(self.take())
            self.take("]")
            return self.names[text][index]
        return self.names[text]


class Numbers:
    """The backend of plain numbers: floats and tuples of them."""

    import math as _math

    @staticmethod
    def _each(function, *values):
        width = max((len(v) for v in values if isinstance(v, tuple)), default=0)
        if width == 0:
            return function(*values)
        spread = [v if isinstance(v, tuple) else (v,) * width for v in values]
        return tuple(function(*parts) for parts in zip(*spread))

    def binary(self, sign, a, b):
        return self._each({"+": lambda x, y: x + y, "-": lambda x, y: x - y, "*": lambda x, y: x * y,
                           "/": lambda x, y: x / y, "<": lambda x, y: x < y, ">": lambda x, y: x > y,
                           "<=": lambda x, y: x <= y, ">=": lambda x, y: x >= y, "&&": lambda x, y: x and y,
                           "||": lambda x, y: x or y}[sign], a, b)

    def choose(self, condition, yes, no):
        return yes if condition else no

    def component(self, value, name):
        return value["xyzw".index(name)]

    def construct(self, kind, arguments):
        width = {"float": 1, "vec2": 2, "vec3": 3, "vec4": 4}[kind]
        if width == 1:
            return arguments[0]
        return tuple(arguments) if len(arguments) == width else (arguments[0],) * width

    def builtin(self, name, arguments):
        math = self._math
        if name == "dot":
            return sum(x * y for x, y in zip(*arguments))
        if name == "length":
            return math.sqrt(sum(x * x for x in arguments[0]))
        if name == "normalize":
            return tuple(x / self.builtin("length", arguments) for x in arguments[0])
        if name == "cross":
            (a, b, c), (d, e, f) = arguments
            return (b * f - c * e, c * d - a * f, a * e - b * d)
        functions = {"min": min, "max": max, "clamp": lambda x, a, b: min(max(x, a), b), "abs": abs,
                     "mix": lambda a, b, t: a + (b - a) * t, "sign": lambda x: (x > 0) - (x < 0),
                     "floor": math.floor, "exp": lambda x: math.exp(min(x, 700)), "exp2": lambda x: 2.0 ** x,
                     "log": math.log, "log2": math.log2, "sqrt": math.sqrt, "inversesqrt": lambda x: 1 / math.sqrt(x),
                     "pow": lambda x, y: math.pow(x, y), "sin": math.sin, "cos": math.cos, "acos": math.acos,
                     "atan": math.atan2}
        if name not in functions:
            raise Unsupported(f"shader code: unknown function {name}")
        return self._each(functions[name], *arguments)
