"""The world's background as a latitude-longitude image for `lobelia bake --env`."""
import bpy
import numpy


def _background(world):
    """The background node that the active output shows, or None."""
    if not world.node_tree:
        return None
    output = world.node_tree.get_output_node("CYCLES")
    surface = output.inputs["Surface"] if output else None
    node = surface.links[0].from_node if surface and surface.is_linked else None
    return node if node and node.type == "BACKGROUND" else None


def _picture(socket):
    """Pixels of an environment texture in linear colour, rows from the bottom; None if nodes change it."""
    node = socket.links[0].from_node
    plain = node.type == "TEX_ENVIRONMENT" and node.image and node.projection == "EQUIRECTANGULAR"
    if not plain or node.inputs["Vector"].is_linked or not node.image.is_float:
        return None
    width, height = node.image.size
    pixels = numpy.empty(width * height * 4, numpy.float32)
    node.image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)


def write_environment(world, path):
    """Writes the background to an .exr file. Returns (whether it was written, warnings); black needs no file."""
    if world is None:
        return False, []
    if not world.use_nodes:
        color, strength = world.color, 1.0
        pixels = numpy.ones((8, 16, 4), numpy.float32)
        pixels[:, :, :3] = tuple(color)
    else:
        node = _background(world)
        if node is None or node.inputs["Strength"].is_linked:
            return False, ["the world's nodes are not a plain background; it is left black, set Environment instead"]
        strength = node.inputs["Strength"].default_value
        if node.inputs["Color"].is_linked:
            pixels = _picture(node.inputs["Color"])
            if pixels is None:
                return False, ["the world's colour is not a plain equirectangular .hdr or .exr texture; "
                               "it is left black, set Environment instead"]
            # Blender's centre column looks along its +x, ours along glTF's -z, which is Blender's +y.
            pixels = numpy.roll(pixels, pixels.shape[1] // 4, axis=1)
        else:
            pixels = numpy.ones((8, 16, 4), numpy.float32)
            pixels[:, :, :3] = tuple(node.inputs["Color"].default_value)[:3]
    pixels[:, :, :3] *= strength
    if not pixels[:, :, :3].any():
        return False, []
    height, width = pixels.shape[:2]
    image = bpy.data.images.new("lobelia environment", width, height, alpha=False, float_buffer=True)
    try:
        image.colorspace_settings.name = "Non-Color"
        image.pixels.foreach_set(pixels.ravel())
        image.filepath_raw, image.file_format = path, "OPEN_EXR"
        image.save()
    finally:
        bpy.data.images.remove(image)
    return True, []
