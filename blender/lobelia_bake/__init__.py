"""Lobelia: bakes light into directional lightmaps, and shows them."""
import shutil
import tempfile
from pathlib import Path

import bpy

from . import export, lightmaps, world
from .process import Command

bl_info = {
    "name": "Lobelia",
    "author": "the Lobelia authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Lobelia",
    "description": "Bakes directional lightmaps with the lobelia command",
    "category": "Render",
}


class LobeliaPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(name="Program", description="The lobelia command", subtype="FILE_PATH", default="lobelia")

    def draw(self, context):
        self.layout.prop(self, "program")


class LobeliaSettings(bpy.types.PropertyGroup):
    codec: bpy.props.StringProperty(name="Codec", description="basis/encoder/evaluator, see lobelia list", default="sh2/moments/convolution")
    frame: bpy.props.EnumProperty(name="Frame", description="Coordinate frame of spherical coefficients", default="world",
                                  items=[("world", "World", ""), ("tangent", "Tangent", "Of each texel")])
    size: bpy.props.IntProperty(name="Page size", description="Texels of a side", default=512, min=16, max=16384)
    samples: bpy.props.IntProperty(name="Samples", description="Of each texel", default=256, min=16, max=1000000)
    bounces: bpy.props.IntProperty(name="Bounces", default=8, min=0, max=64)
    environment: bpy.props.StringProperty(name="Environment", description="A latitude-longitude .hdr or .exr, or \"sky\"; empty: the world's background", subtype="FILE_PATH")
    folder: bpy.props.StringProperty(name="Folder", description="Of the bake; empty: a temporary one", subtype="DIR_PATH")


def program_of(context):
    addon = context.preferences.addons.get(__package__)
    return addon.preferences.program if addon else "lobelia"


def meshes_of(context):
    return [o for o in context.selected_objects if o.type == "MESH"]


def add_lightmap_uvs(objects, margin=0.02):
    """Gives objects a second UV map that holds all of them without overlap."""
    for o in objects:
        layers = o.data.uv_layers
        if not layers:
            layers.new(name="UVMap")
        if lightmaps.UV_NAME not in layers:
            layers.new(name=lightmaps.UV_NAME)
        if layers.find(lightmaps.UV_NAME) != 1:
            raise RuntimeError(f"{o.name}: the UV map {lightmaps.UV_NAME} must be the second one, for glTF numbers them")
        o.data["lobelia_place"] = (1, 1, 0, 0)
    bpy.ops.object.select_all(action="DESELECT")
    for o in objects:
        o.select_set(True)
        o.data.uv_layers[lightmaps.UV_NAME].active = True
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(island_margin=margin)
    bpy.ops.object.mode_set(mode="OBJECT")
    for o in objects:
        o.data.uv_layers[0].active = True


def bake_arguments(context, scene_file, folder, environment):
    s = context.scene.lobelia
    arguments = [program_of(context), "bake", scene_file, "--codec", s.codec, "--frame", s.frame, "--size", f"{s.size}x{s.size}", "--samples",
                 str(s.samples), "--bounces", str(s.bounces), "--precision", "float", "--storage", "float32", "--no-report",
                 "-o", folder]
    if environment:
        arguments += ["--env", environment]
    return arguments


class LOBELIA_OT_uvs(bpy.types.Operator):
    bl_idname = "lobelia.uvs"
    bl_label = "Make lightmap UVs"
    bl_description = "Give the selected meshes a UV map for lightmaps, all in one square"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        objects = meshes_of(context)
        if not objects:
            self.report({"ERROR"}, "Select meshes first")
            return {"CANCELLED"}
        try:
            add_lightmap_uvs(objects)
        except RuntimeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class LOBELIA_OT_bake(bpy.types.Operator):
    bl_idname = "lobelia.bake"
    bl_label = "Bake"
    bl_description = "Bake the light of the selected meshes; Escape cancels"

    def start(self, context):
        """Exports and starts the command; False with a report if that fails."""
        self.objects = meshes_of(context)
        if not self.objects:
            self.report({"ERROR"}, "Select meshes first")
            return False
        for o in self.objects:
            if o.data.uv_layers.find(lightmaps.UV_NAME) != 1:
                self.report({"ERROR"}, f"{o.name} has no lightmap UVs: use Make lightmap UVs")
                return False
        lightmaps.restore(self.objects)
        self.work = tempfile.mkdtemp(prefix="lobelia-")
        folder = context.scene.lobelia.folder
        self.folder = bpy.path.abspath(folder) if folder else str(Path(self.work) / "bake")
        # A finished bake there is replaced; its states would be continued.
        if (Path(self.folder) / "bake.json").exists():
            shutil.rmtree(Path(self.folder) / "checkpoint", ignore_errors=True)
        scene_file = str(Path(self.work) / "scene.glb")
        for warning in export.export_scene(scene_file, self.objects):
            self.report({"WARNING"}, warning)
        try:
            self.command = Command(bake_arguments(context, scene_file, self.folder, self.environment(context)))
        except RuntimeError as error:
            shutil.rmtree(self.work, ignore_errors=True)
            self.report({"ERROR"}, str(error))
            return False
        return True

    def environment(self, context):
        """The chosen environment, else the world's background as a file; empty for none."""
        chosen = context.scene.lobelia.environment
        if chosen:
            return chosen if chosen in ("sky", "none") else bpy.path.abspath(chosen)
        file = str(Path(self.work) / "world.exr")
        written, warnings = world.write_environment(context.scene.world, file)
        for warning in warnings:
            self.report({"WARNING"}, warning)
        return file if written else ""

    def finish(self, context):
        result = self.take(context)
        # What a temporary bake held is in the images by now.
        shutil.rmtree(self.work, ignore_errors=True)
        return result

    def take(self, context):
        """Reports what the command said, and shows the lightmaps."""
        for message in self.command.messages:
            if "warning" in message:
                self.report({"WARNING"}, message)
        if self.command.poll() != 0:
            self.report({"ERROR"}, self.command.error())
            return {"CANCELLED"}
        try:
            shown = lightmaps.show(self.folder, program_of(context), self.objects)
        except (lightmaps.exr.Damaged, OSError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.scene["lobelia_bake"] = self.folder
        self.report({"INFO"}, f"{shown} objects have lightmaps")
        return {"FINISHED"}

    def execute(self, context):
        """Without an interface: waits for the end."""
        if not self.start(context):
            return {"CANCELLED"}
        self.command.process.wait()
        return self.finish(context)

    def invoke(self, context, event):
        if not self.start(context):
            return {"CANCELLED"}
        context.window_manager.progress_begin(0, 100)
        self.timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.command.cancel()
            self.end(context)
            shutil.rmtree(self.work, ignore_errors=True)
            self.report({"INFO"}, "The bake was cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self.command.progress is not None:
            context.window_manager.progress_update(100 * self.command.progress)
            context.workspace.status_text_set(f"Lobelia: {100 * self.command.progress:.0f} %, Escape cancels")
        if self.command.poll() is None:
            return {"RUNNING_MODAL"}
        self.end(context)
        return self.finish(context)

    def end(self, context):
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

class LOBELIA_OT_restore(bpy.types.Operator):
    bl_idname = "lobelia.restore"
    bl_label = "Original materials"
    bl_description = "Give the selected meshes their own materials back"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        lightmaps.restore(meshes_of(context))
        return {"FINISHED"}


class LOBELIA_PT_panel(bpy.types.Panel):
    bl_label = "Lobelia"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    def draw(self, context):
        layout, settings = self.layout, context.scene.lobelia
        layout.use_property_split = True
        for name in ("codec", "frame", "size", "samples", "bounces", "environment", "folder"):
            layout.prop(settings, name)
        layout.operator("lobelia.uvs")
        layout.operator("lobelia.bake")
        layout.operator("lobelia.restore")


classes = (LobeliaPreferences, LobeliaSettings, LOBELIA_OT_uvs, LOBELIA_OT_bake, LOBELIA_OT_restore, LOBELIA_PT_panel)


def register():
    for each in classes:
        bpy.utils.register_class(each)
    bpy.types.Scene.lobelia = bpy.props.PointerProperty(type=LobeliaSettings)


def unregister():
    del bpy.types.Scene.lobelia
    for each in reversed(classes):
        bpy.utils.unregister_class(each)
