"""Node groups that evaluate a codec: the shader code of `lobelia shader`, as nodes that Cycles and Eevee both have."""
import bpy

from .shader_code import Numbers, Program, Run, Unsupported


class Socket:
    """A value in a node tree: of width 1 or 3."""

    def __init__(self, socket, width):
        self.socket, self.width = socket, width


def is_number(value):
    return isinstance(value, (int, float, bool, tuple))


def width_of(value):
    return value.width if isinstance(value, Socket) else 3 if isinstance(value, tuple) else 1


class Nodes:
    """The backend of shader_code.Run that makes nodes; operations on numbers alone stay numbers."""

    MATH = {"+": "ADD", "-": "SUBTRACT", "*": "MULTIPLY", "/": "DIVIDE", "<": "LESS_THAN", ">": "GREATER_THAN",
            "<=": "LESS_THAN", ">=": "GREATER_THAN", "min": "MINIMUM", "max": "MAXIMUM", "abs": "ABSOLUTE",
            "sign": "SIGN", "floor": "FLOOR", "exp": "EXPONENT", "sqrt": "SQRT", "inversesqrt": "INVERSE_SQRT",
            "pow": "POWER", "sin": "SINE", "cos": "COSINE", "acos": "ARCCOSINE", "atan": "ARCTAN2"}
    VECTOR = {"+": "ADD", "-": "SUBTRACT", "*": "MULTIPLY", "/": "DIVIDE", "min": "MINIMUM", "max": "MAXIMUM",
              "abs": "ABSOLUTE", "floor": "FLOOR", "sin": "SINE", "cos": "COSINE", "cross": "CROSS_PRODUCT",
              "normalize": "NORMALIZE"}

    def __init__(self, tree):
        self.tree, self.numbers, self.count = tree, Numbers(), 0

    def node(self, kind):
        node = self.tree.nodes.new(kind)
        node.location = (180 * (self.count % 12), -160 * (self.count // 12))
        self.count += 1
        return node

    def plug(self, value, socket):
        if isinstance(value, Socket):
            self.tree.links.new(value.socket, socket)
        elif socket.type == "VALUE":
            socket.default_value = float(value)
        else:
            socket.default_value = value if isinstance(value, tuple) else (float(value),) * 3

    def math(self, operation, *arguments):
        node = self.node("ShaderNodeMath")
        node.operation = operation
        for value, socket in zip(arguments, node.inputs):
            self.plug(value, socket)
        return Socket(node.outputs[0], 1)

    def vector(self, operation, *arguments):
        node = self.node("ShaderNodeVectorMath")
        node.operation = operation
        for value, socket in zip(arguments, [s for s in node.inputs if s.type == "VECTOR"]):
            self.plug(value, socket)
        scalar = operation in ("DOT_PRODUCT", "LENGTH")
        return Socket(node.outputs["Value" if scalar else "Vector"], 1 if scalar else 3)

    def scaled(self, vector, factor):
        node = self.node("ShaderNodeVectorMath")
        node.operation = "SCALE"
        self.plug(vector, node.inputs[0])
        self.plug(factor, node.inputs["Scale"])
        return Socket(node.outputs["Vector"], 3)

    def spread(self, value):
        """A vector of a scalar."""
        return self.construct("vec3", [value]) if width_of(value) == 1 and not is_number(value) else value

    def binary(self, sign, a, b):
        if is_number(a) and is_number(b):
            return self.numbers.binary(sign, a, b)
        if sign in ("&&", "||"):
            return self.math("MULTIPLY" if sign == "&&" else "MAXIMUM", a, b)
        if width_of(a) == width_of(b) == 1:
            return self.math(self.MATH[sign], a, b)
        if sign == "*" and 1 in (width_of(a), width_of(b)):
            return self.scaled(b, a) if width_of(a) == 1 else self.scaled(a, b)
        return self.vector(self.VECTOR[sign], self.spread(a), self.spread(b))

    def choose(self, condition, yes, no):
        if is_number(condition):
            return yes if condition else no
        if width_of(yes) == 1 and width_of(no) == 1:
            # no + (yes - no) condition, where one that is infinite must not spoil the other: none of them is.
            return self.binary("+", no, self.binary("*", self.binary("-", yes, no), condition))
        raise Unsupported("shader code: a choice between vectors")

    def component(self, value, name):
        if is_number(value):
            return self.numbers.component(value, name)
        node = self.node("ShaderNodeSeparateXYZ")
        self.plug(value, node.inputs[0])
        return Socket(node.outputs["xyz".index(name)], 1)

    def construct(self, kind, arguments):
        if all(is_number(value) for value in arguments):
            return self.numbers.construct(kind, arguments)
        if kind == "float":
            return arguments[0]
        if kind != "vec3":
            raise Unsupported(f"shader code: {kind}, which nodes do not have")
        node = self.node("ShaderNodeCombineXYZ")
        for value, socket in zip(arguments if len(arguments) == 3 else arguments * 3, node.inputs):
            self.plug(value, socket)
        return Socket(node.outputs[0], 3)

    def builtin(self, name, arguments):
        if all(is_number(value) for value in arguments):
            return self.numbers.builtin(name, arguments)
        if name == "dot":
            return self.vector("DOT_PRODUCT", *arguments)
        if name == "length":
            return self.vector("LENGTH", *arguments)
        if name == "clamp":
            return self.builtin("min", [self.builtin("max", arguments[:2]), arguments[2]])
        if name == "mix":
            a, b, t = arguments
            return self.binary("+", a, self.binary("*", self.binary("-", b, a), t))
        if name == "exp2":
            return self.builtin("pow", [2.0, arguments[0]])
        if name in ("log", "log2"):
            return self._each(lambda x: self.math("LOGARITHM", x, 2.718281828459045 if name == "log" else 2.0), arguments)
        if max(width_of(value) for value in arguments) == 1:
            return self.math(self.MATH[name], *arguments)
        if name in self.VECTOR:
            return self.vector(self.VECTOR[name], *[self.spread(value) for value in arguments])
        return self._each(lambda *parts: self.math(self.MATH[name], *parts), arguments)

    def _each(self, function, arguments):
        """A function of scalars, component by component."""
        if max(width_of(value) for value in arguments) == 1:
            return function(*arguments)
        parts = []
        for name in "xyz":
            parts.append(function(*[self.component(v, name) if width_of(v) == 3 else v for v in arguments]))
        return self.construct("vec3", parts)


def irradiance_group(name, code, images, uv_map, tangent):
    """Makes a node group with the output Irradiance, E [W/m^2] at the input Normal, which is in the world.

    code: of `lobelia shader CODEC`; images: one of each coefficient, RGB; tangent: directions in the tangent frame.
    """
    program = Program(code)
    if len(images) != program.coefficients:
        raise Unsupported(f"{len(images)} images, but {program.coefficients} coefficients")
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    if hasattr(group, "interface"):
        group.interface.new_socket("Normal", in_out="INPUT", socket_type="NodeSocketVector")
        group.interface.new_socket("Irradiance", in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        group.inputs.new("NodeSocketVector", "Normal")
        group.outputs.new("NodeSocketColor", "Irradiance")
    backend = Nodes(group)
    inside, outside = backend.node("NodeGroupInput"), backend.node("NodeGroupOutput")
    uv = backend.node("ShaderNodeUVMap")
    uv.uv_map = uv_map
    light = []
    for image in images:
        texture = backend.node("ShaderNodeTexImage")
        texture.image, texture.interpolation, texture.extension = image, "Linear", "EXTEND"
        group.links.new(uv.outputs[0], texture.inputs[0])
        # A colour as a vector, negative values too.
        split = backend.node("ShaderNodeVectorMath")
        split.operation = "ADD"
        group.links.new(texture.outputs["Color"], split.inputs[0])
        light.append(Socket(split.outputs["Vector"], 3))

    def gltf(vector):
        """z up to y up: (x, y, z) becomes (x, z, -y)."""
        x, y, z = (backend.component(vector, name) for name in "xyz")
        return backend.construct("vec3", [x, z, backend.binary("*", y, -1.0)])

    normal = gltf(Socket(inside.outputs["Normal"], 3))
    run = Run(program, backend, light)
    if tangent:
        geometry = backend.node("ShaderNodeNewGeometry")
        normal = run.call("to_tangent", [gltf(Socket(geometry.outputs["Normal"], 3)), normal])
    backend.plug(run.call("irradiance", [normal]), outside.inputs["Irradiance"])
    return group
