"""A bake's pages as images, and materials that show them."""
import json
import subprocess
from pathlib import Path

import bpy
import numpy

from . import exr
from .nodes import irradiance_group

UV_NAME = "Lightmap"
ORIGINAL = "lobelia_original"


def page_images(folder, page, count):
    """An image of each coefficient, RGB, in Blender's memory."""
    channels = exr.read_channels(Path(folder) / page["file"])
    images = []
    for i in range(count):
        planes = [channels[f"c{i}.{k}"] for k in "RGB"]
        height, width = planes[0].shape
        name = f"{Path(folder).name} {Path(page['file']).stem} c{i}"
        image = bpy.data.images.get(name)
        if image is not None:
            bpy.data.images.remove(image)
        image = bpy.data.images.new(name, width, height, alpha=False, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        pixels = numpy.ones((height, width, 4), numpy.float32)
        for k in range(3):
            pixels[:, :, k] = planes[k][::-1]  # Blender's rows begin at the bottom
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        images.append(image)
    return images


def lit_material(original, group):
    """A copy of a material that shows its base colour under the lightmap, and its own emission."""
    material = bpy.data.materials.new((original.name if original else "none") + " baked")
    material[ORIGINAL] = original.name if original else ""
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    make, link = tree.nodes.new, tree.links.new
    output, emission = make("ShaderNodeOutputMaterial"), make("ShaderNodeEmission")
    lightmap, geometry = make("ShaderNodeGroup"), make("ShaderNodeNewGeometry")
    lightmap.node_tree = group
    link(geometry.outputs["Normal"], lightmap.inputs["Normal"])
    base, own, strength = (0.8, 0.8, 0.8, 1), (0, 0, 0, 1), 0.0
    if original and original.use_nodes:
        shader = next((n for n in original.node_tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
        if shader:
            own_socket = shader.inputs.get("Emission") or shader.inputs.get("Emission Color")
            base, own = tuple(shader.inputs["Base Color"].default_value), tuple(own_socket.default_value)
            strength = shader.inputs["Emission Strength"].default_value
            _copy_picture(shader.inputs["Base Color"], tree, "base")
            _copy_normal(shader.inputs["Normal"], tree, lightmap.inputs["Normal"])
    product = make("ShaderNodeVectorMath")
    product.operation = "MULTIPLY"
    link(lightmap.outputs["Irradiance"], product.inputs[0])
    picture = tree.nodes.get("base")
    if picture:
        link(picture.outputs["Color"], product.inputs[1])
    else:
        product.inputs[1].default_value = base[:3]
    scale = make("ShaderNodeVectorMath")
    scale.operation = "SCALE"
    scale.inputs["Scale"].default_value = 1 / numpy.pi
    link(product.outputs["Vector"], scale.inputs[0])
    total = make("ShaderNodeVectorMath")
    total.operation = "ADD"
    link(scale.outputs["Vector"], total.inputs[0])
    total.inputs[1].default_value = [c * strength for c in own[:3]]
    link(total.outputs["Vector"], emission.inputs["Color"])
    link(emission.outputs["Emission"], output.inputs["Surface"])
    return material


def _copy_picture(socket, tree, name):
    if not socket.is_linked or socket.links[0].from_node.type != "TEX_IMAGE":
        return
    node = tree.nodes.new("ShaderNodeTexImage")
    node.name, node.image = name, socket.links[0].from_node.image


def _copy_normal(socket, tree, target):
    """A normal map from a picture, as the original has it."""
    if not socket.is_linked or socket.links[0].from_node.type != "NORMAL_MAP":
        return
    original = socket.links[0].from_node
    color = original.inputs["Color"]
    if not color.is_linked or color.links[0].from_node.type != "TEX_IMAGE":
        return
    node, picture = tree.nodes.new("ShaderNodeNormalMap"), tree.nodes.new("ShaderNodeTexImage")
    node.uv_map, node.inputs["Strength"].default_value = original.uv_map, original.inputs["Strength"].default_value
    picture.image = color.links[0].from_node.image
    tree.links.new(picture.outputs["Color"], node.inputs["Color"])
    tree.links.new(node.outputs["Normal"], target)


def show(folder, program, objects):
    """Gives objects the lightmaps of a bake. Returns how many got one."""
    manifest = json.loads((Path(folder) / "bake.json").read_text())
    codec = manifest["codec"]
    # The bake's own code knows the frame of its coefficients; a bake without textures has none.
    own = sorted(Path(folder).glob("decode.*.glsl"))
    code = own[0].read_text() if own else subprocess.run(
        [program, "shader", codec["name"]], check=True, capture_output=True, text=True).stdout
    by_name = {entry["name"]: entry for entry in manifest["objects"]}
    groups, materials, shown = {}, {}, 0
    for o in objects:
        entry = by_name.get(o.name)
        if entry is None or entry.get("page") is None:
            continue
        page = entry["page"]
        place = (*entry["uv_scale"], *entry["uv_offset"])
        if place != tuple(o.data.get("lobelia_place", (1, 1, 0, 0))):
            _place_uvs(o, place)
            o.data["lobelia_place"] = place
        if page not in groups:
            images = page_images(folder, manifest["layout"]["pages"][page], codec["coefficients"])
            groups[page] = irradiance_group(f"{Path(folder).name} page {page}", code, images, UV_NAME, codec["frame"] == "tangent")
        for slot in o.material_slots:
            key = (slot.material, page)
            if key not in materials:
                materials[key] = lit_material(slot.material, groups[page])
            slot.material = materials[key]
        shown += 1
    return shown


def _place_uvs(o, place):
    """Moves lightmap UVs to their place on the page; v is turned over in Blender."""
    su, sv, ou, ov = place
    for loop in o.data.uv_layers[UV_NAME].data:
        u, v = loop.uv
        loop.uv = (su * u + ou, 1 - (sv * (1 - v) + ov))


def restore(objects):
    """Gives objects their own materials back."""
    for o in objects:
        for slot in o.material_slots:
            if slot.material and ORIGINAL in slot.material:
                slot.material = bpy.data.materials.get(slot.material[ORIGINAL])
