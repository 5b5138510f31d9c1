"""The scene as a .glb file in radiometric units, with what Blender's own exporter drops or scales mended."""
import json
import math
import struct

import bpy
from mathutils import Vector

AREA_PREFIX = "lobelia area light "


def to_gltf(v):
    """z up to y up."""
    return [v[0], v[2], -v[1]]


def light_nodes(lights):
    """KHR_lights_punctual entries and their nodes, in watts: W/sr, and W/m^2 for suns."""
    entries, nodes = [], []
    for light in lights:
        data = light.data
        kind = {"POINT": "point", "SPOT": "spot", "SUN": "directional"}.get(data.type)
        if kind is None:
            continue
        # Blender's power P is the flux of a whole sphere, of a spot too; a sun's strength is its irradiance.
        intensity = data.energy if kind == "directional" else data.energy / (4 * math.pi)
        entry = {"type": kind, "name": light.name, "intensity": intensity, "color": list(data.color)}
        if kind == "spot":
            outer = data.spot_size / 2
            entry["spot"] = {"outerConeAngle": min(outer, math.pi / 2), "innerConeAngle": min(outer * (1 - data.spot_blend), outer * 0.999)}
        if kind == "directional":
            entry["extras"] = {"angular_radius": data.angle / 2}
        else:
            entry["extras"] = {"radius": data.shadow_soft_size}
        axis = -Vector(to_gltf(light.matrix_world.to_3x3() @ Vector((0, 0, -1)))).normalized()
        side = Vector((0, 1, 0)).cross(axis) if abs(axis.y) < 0.9 else Vector((1, 0, 0)).cross(axis)
        side.normalize()
        up = axis.cross(side)
        place = to_gltf(light.matrix_world.translation)
        matrix = [*side, 0, *up, 0, *axis, 0, *place, 1]
        nodes.append({"name": light.name, "matrix": matrix, "extensions": {"KHR_lights_punctual": {"light": len(entries)}}})
        entries.append(entry)
    return entries, nodes


def area_quads(lights, collection):
    """Temporary quads for area lights, which glTF does not have: (object, radiance) each."""
    quads = []
    for light in lights:
        data = light.data
        if data.type != "AREA":
            continue
        x = data.size / 2
        y = (data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size) / 2
        mesh = bpy.data.meshes.new(AREA_PREFIX + light.name)
        # Seen from where the lamp shines, -z, counter-clockwise.
        mesh.from_pydata([(-x, -y, 0), (-x, y, 0), (x, y, 0), (x, -y, 0)], [], [(0, 1, 2, 3)])
        material = bpy.data.materials.new(AREA_PREFIX + light.name)
        material.use_backface_culling = True
        mesh.materials.append(material)
        quad = bpy.data.objects.new(AREA_PREFIX + light.name, mesh)
        quad.matrix_world = light.matrix_world
        collection.objects.link(quad)
        area = 4 * x * y * (math.pi / 4 if data.shape in ("DISK", "ELLIPSE") else 1)
        radiance = data.energy / (math.pi * area) * (math.pi / 4 if data.shape in ("DISK", "ELLIPSE") else 1)
        quads.append((quad, [radiance * c for c in data.color]))
    return quads


def read_glb(path):
    with open(path, "rb") as file:
        data = file.read()
    length, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + length]), data[20 + length:]


def write_glb(path, document, rest):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A))
        file.write(text + rest)


def export_scene(path, objects):
    """Writes the objects, all lights that are visible in renders, and the cameras. Returns warnings."""
    scene, warnings = bpy.context.scene, []
    # Objects that a script has just made or moved have old matrices until then.
    bpy.context.view_layer.update()
    lights = [o for o in scene.objects if o.type == "LIGHT" and not o.hide_render]
    for light in lights:
        if light.data.use_nodes and any(n.type == "TEX_IES" for n in light.data.node_tree.nodes):
            warnings.append(f"{light.name}: IES profiles are not read by Lobelia; the light shines evenly")
    quads = area_quads(lights, scene.collection)
    radiances = {quad.data.materials[0].name: radiance for quad, radiance in quads}
    selected, active = list(bpy.context.selected_objects), bpy.context.view_layer.objects.active
    try:
        bpy.ops.object.select_all(action="DESELECT")
        for o in [*objects, *(quad for quad, _ in quads), *(o for o in scene.objects if o.type == "CAMERA")]:
            o.select_set(True)
        bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", use_selection=True, export_lights=False,
                                  export_cameras=True, export_apply=True, export_yup=True)
    finally:
        for quad, _ in quads:
            mesh, material = quad.data, quad.data.materials[0]
            bpy.data.objects.remove(quad)
            bpy.data.meshes.remove(mesh)
            bpy.data.materials.remove(material)
        bpy.ops.object.select_all(action="DESELECT")
        for o in selected:
            o.select_set(True)
        bpy.context.view_layer.objects.active = active

    document, rest = read_glb(path)
    used = set(document.get("extensionsUsed", []))
    for material in document.get("materials", []):
        radiance = radiances.get(material.get("name"))
        if radiance is None:
            continue
        strength = max(1.0, *radiance)
        material["pbrMetallicRoughness"] = {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}
        material["emissiveFactor"] = [c / strength for c in radiance]
        material.setdefault("extensions", {})["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        used.add("KHR_materials_emissive_strength")
        material.pop("doubleSided", None)
    entries, nodes = light_nodes(lights)
    if entries:
        document.setdefault("extensions", {})["KHR_lights_punctual"] = {"lights": entries}
        used.add("KHR_lights_punctual")
        for node in nodes:
            document.setdefault("nodes", []).append(node)
            document["scenes"][document.get("scene", 0)].setdefault("nodes", []).append(len(document["nodes"]) - 1)
    if used:
        document["extensionsUsed"] = sorted(used)
    write_glb(path, document, rest)
    return warnings
