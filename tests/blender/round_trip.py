"""Inside Blender, in background mode: makes a scene, bakes it by the add-on, renders the lightmaps by Cycles, and compares
with `lobelia render` of the same camera and with Cycles' own path tracing.
    blender --background --factory-startup --python tests/blender/round_trip.py -- LOBELIA FOLDER"""
import math
import subprocess
import sys
from pathlib import Path

import bpy
import numpy
from mathutils import Vector

root = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "blender"))
import lobelia_bake  # noqa: E402
from lobelia_bake import exr, lightmaps, world  # noqa: E402

program, work = sys.argv[sys.argv.index("--") + 1:][:2]
width, height = 160, 120
failures = 0


def check(holds, what):
    global failures
    print(("ok: " if holds else "FAIL: ") + what)
    failures += not holds


def material(name, color):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    shader = m.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Roughness"].default_value = 1
    specular = shader.inputs.get("Specular") or shader.inputs.get("Specular IOR Level")
    specular.default_value = 0
    return m


def make_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0, 0, 0, 1)
    white, red = material("white", (0.7, 0.7, 0.7)), material("red", (0.6, 0.1, 0.1))
    # A room that is seen from within, and a block in it.
    bpy.ops.mesh.primitive_cube_add(size=4, location=(0, 0, 2))
    room = bpy.context.object
    room.name = "room"
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.flip_normals()
    bpy.ops.object.mode_set(mode="OBJECT")
    room.data.materials.append(white)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0.7, 0.8, 0.5), rotation=(0, 0, 0.5))
    block = bpy.context.object
    block.name = "block"
    block.data.materials.append(red)
    area = bpy.data.lights.new("area", "AREA")
    area.energy, area.shape, area.size, area.size_y = 60, "RECTANGLE", 1.0, 0.6
    lamp = bpy.data.objects.new("area", area)
    lamp.location = (-0.4, 0.2, 3.9)
    point = bpy.data.lights.new("point", "POINT")
    point.energy, point.shadow_soft_size = 20, 0.0
    bulb = bpy.data.objects.new("point", point)
    bulb.location = (1.2, -1.2, 2.5)
    camera_data = bpy.data.cameras.new("camera")
    camera = bpy.data.objects.new("camera", camera_data)
    camera.location, camera.rotation_euler = (0, -1.9, 1.9), (math.radians(80), 0, 0)
    camera_data.angle = math.radians(75)
    for o in (lamp, bulb, camera):
        scene.collection.objects.link(o)
    scene.camera = camera
    return room, block


def cycles(samples, path):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples, scene.cycles.use_denoising = samples, False
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 9
    scene.cycles.sample_clamp_indirect = 0
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.image_settings.exr_codec = "ZIP"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return picture(path)


def picture(path):
    channels = exr.read_channels(path)
    return numpy.stack([channels[k] for k in "RGB"], 2)


def psnr(a, b):
    """Over all pixels, cut at the 98th percentile of b, which is the peak."""
    peak = numpy.percentile(b, 98)
    off = numpy.mean((numpy.minimum(a, peak) - numpy.minimum(b, peak)) ** 2)
    return 10 * math.log10(peak * peak / max(off, 1e-20))


lobelia_bake.register()
room, block = make_scene()
path_traced = cycles(256, f"{work}/cycles.exr")
lobelia_bake.program_of = lambda context: program
bpy.context.scene.lobelia.size, bpy.context.scene.lobelia.samples = 256, 1024
for codec in ("sh2/moments/convolution", "ahd/moments/punctual"):
    lightmaps.restore([room, block])
    for o in (room, block):
        o.select_set(True)
    if codec.startswith("sh2"):
        check(bpy.ops.lobelia.uvs() == {"FINISHED"}, "lightmap UVs")
    bpy.context.scene.lobelia.codec = codec
    folder = f"{work}/{codec.split('/')[0]}"
    bpy.context.scene.lobelia.folder = folder
    for o in bpy.context.scene.objects:
        o.select_set(o in (room, block))
    check(bpy.ops.lobelia.bake() == {"FINISHED"}, f"bake with {codec}")
    baked = cycles(64, f"{folder}.exr")
    subprocess.run([program, "render", folder, "--size", f"{width}x{height}", "--samples", "256", "-o", f"{folder}-render.exr"],
                   check=True)
    value = psnr(baked, picture(f"{folder}-render.exr"))
    check(value > 40, f"{codec}: lightmaps by Cycles against lobelia render, PSNR {value:.1f} dB")
    if codec.startswith("sh2"):
        inside = numpy.median(baked / numpy.maximum(path_traced, 1e-3))
        check(abs(inside - 1) < 0.03, f"brightness over Cycles' own path tracing, median {inside:.3f}")
lightmaps.restore([room, block])


def check_world():
    """The world's image, written for --env, against Cycles looking in four directions."""
    scene, size = bpy.context.scene, (64, 32)
    pixels = numpy.ones((size[1], size[0], 4), numpy.float32)
    around = 2 * math.pi * (numpy.arange(size[0]) + 0.5) / size[0]
    pixels[:, :, 0], pixels[:, :, 1] = 1 + numpy.cos(around), 1 + numpy.sin(around)
    pixels[:, :, 2] = ((numpy.arange(size[1]) + 0.5) / size[1])[:, None]
    image = bpy.data.images.new("sky", *size, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    tree = scene.world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs[0], tree.nodes["Background"].inputs[0])
    tree.nodes["Background"].inputs[1].default_value = 2
    check(world.write_environment(scene.world, f"{work}/world.exr") == (True, []), "the world's image is written")
    written = picture(f"{work}/world.exr")
    for o in scene.objects:
        o.hide_render = o.type != "CAMERA"
    scene.camera.data.angle = 0.02
    for direction in ((1, 0, 0), (0, 1, 0), (-1, 0.2, 0.3), (0.3, -1, -0.5)):
        x, y, z = v = Vector(direction).normalized()
        scene.camera.rotation_euler = v.to_track_quat("-Z", "Y").to_euler()
        seen = cycles(4, f"{work}/seen.exr").mean((0, 1))
        # Our mapping of glTF's (x, z, -y), docs/conventions.md.
        u, row = (1 + math.atan2(x, y) / math.pi) / 2, math.acos(z) / math.pi
        texel = written[min(int(row * size[1]), size[1] - 1), min(int(u * size[0]), size[0] - 1)]
        check(numpy.abs(texel - seen).max() < 0.15, f"the world along {direction}: {texel} written, {seen} by Cycles")


check_world()
check([s.material.name for s in room.material_slots] == ["white"], "the original materials are back")
bpy.context.scene.lobelia.codec = "sh2/moment/convolution"
for o in bpy.context.scene.objects:
    o.select_set(o in (room, block))
try:
    refused = bpy.ops.lobelia.bake()
except RuntimeError as error:
    refused = str(error)
check("moment" in str(refused), f"a wrong codec is told: {refused}".strip())
print(f"{failures} failed")
sys.exit(1 if failures else 0)
