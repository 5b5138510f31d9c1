"""Lobelia bakes light into lobes.

    environment or scene -> encode or bake -> coefficients -> evaluate, pack, measure

    >>> import lobelia
    >>> sky = lobelia.Environment.sky()
    >>> codec = lobelia.Codec("sg12/least-squares/odd-exact-2")
    >>> coefficients = codec.encode(sky)
    >>> codec.irradiance(coefficients, [0, 1, 0])     # E upwards [W/m^2]

Arrays are float32. Directions are unit vectors (x, y, z) that point away from the surface; colours are linear
Rec. 709; radiance is in W/(m^2 sr), irradiance in W/m^2 and never divided by pi. Bad input raises lobelia.Error, a
ValueError whose message names the place and the remedy.
"""

from . import _native
from ._native import (
    Accumulator,
    Bake,
    Codec,
    Environment,
    Error,
    Errors,
    Page,
    Progress,
    Scene,
    Texture,
    Textures,
    __version__,
    codec_names,
    default_codec,
    embedded_scene,
    embedded_scene_names,
    errors,
    pack,
    read_bake,
    read_gltf,
    storage_names,
)


def bake(
    scene,
    folder=None,
    *,
    codec=default_codec(),
    size=(512, 512),
    texels_per_metre=None,
    samples=256,
    bounces=8,
    seed=1,
    threads=0,
    memory=2 << 30,
    time=None,
    target_error=None,
    frame="world",
    directions="uniform",
    denoise=True,
    seams=True,
    dilate=True,
    push_out=True,
    precision="half",
    storages=None,
    container="ktx2",
    texture_arrays=True,
    mip_levels=1,
    zstd=False,
    probe_spacing=None,
    resume=False,
    progress=None,
):
    """Bakes a scene's light into lightmap pages; the bits are those of `lobelia bake` with the same options.

    scene: a Scene with lightmap UVs.
    folder: holds the checkpoint while the bake runs, then its files; None: no files.
    codec: "basis/encoder/evaluator"; "": irradiance at the shading normal only.
    size: (width, height) of a page [texels]. texels_per_metre: size each object by its area instead.
    samples: per texel, 1 to 1000000, rounded up to whole passes of 16.
    bounces: surfaces between a light source and a texel, 0 to 64.
    threads: 0: one per processor; the result does not depend on it. memory: budget [bytes].
    time: stop after the first pass that exceeds this many seconds.
    target_error: a texel is done when its relative standard error is below this.
    frame: "world" or "tangent", of spherical coefficients. directions: "uniform" or "mixture".
    precision: "half" or "float", of the pages in the folder. storages: of its textures; None: the default ones.
    container: file format of the textures, "ktx2" or "dds". texture_arrays: textures of one format and size share a
    file. mip_levels: of the textures, the page included. zstd: compress them (KTX 2.0 only).
    probe_spacing: also bake probes, on a grid of this spacing [m].
    resume: continue the checkpoint in the folder.
    progress: is called with a Progress, at most 20 times a second; an exception that it raises stops the bake.

    Ctrl-C raises KeyboardInterrupt within a fraction of a second; what the last checkpoint holds stays.
    """
    options = dict(locals())
    session = [options.pop(name) for name in ("scene", "folder", "resume", "progress")]
    return _native._bake(*session, **options)


__all__ = [
    "Accumulator",
    "Bake",
    "Codec",
    "Environment",
    "Error",
    "Errors",
    "Page",
    "Progress",
    "Scene",
    "Texture",
    "Textures",
    "__version__",
    "bake",
    "codec_names",
    "default_codec",
    "embedded_scene",
    "embedded_scene_names",
    "errors",
    "pack",
    "read_bake",
    "read_gltf",
    "storage_names",
]
