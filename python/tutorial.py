# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # Lobelia from Python
#
# From an environment to coefficients, to irradiance and its error, to textures; then a baked scene. Open this file as a
# notebook with jupytext, or run it: `python3 tutorial.py`.

# %%
import math

import numpy as np

import lobelia

# %% [markdown]
# ## An environment
#
# `Environment.load` reads Radiance `.hdr` and OpenEXR files; here the embedded clear sky serves. Its pixels are an array
# that shares the memory of the library. y is up; radiance is in W/(m² sr).

# %%
sky = lobelia.Environment.sky((256, 128), sun_elevation=40)
print(sky, sky.pixels.shape, "brightest:", sky.pixels.max())

# %% [markdown]
# ## Encode
#
# A codec is a basis, an encoder and an evaluator. `sh2` is spherical harmonics of degree 2, nine coefficients, each a
# colour; `sg12` is twelve spherical Gaussians.

# %%
codecs = [
    lobelia.Codec(name)
    for name in (
        "sh1/least-squares/convolution",
        "sh2/least-squares/convolution",
        "sh4/least-squares/convolution",
        "sg12/least-squares/odd-exact-2",
        "sg12/joint/odd-exact-2",
    )
]
coefficients = {codec.name: codec.encode(sky) for codec in codecs}
print(coefficients["sh1/least-squares/convolution"])

# %% [markdown]
# ## Evaluate, and measure the error
#
# Irradiance E [W/m²] at normals all around, against the exact sum over the texels of the sky.

# %%
count = 1000
z = 1 - 2 * (np.arange(count) + 0.5) / count
azimuth = math.pi * (3 - math.sqrt(5)) * np.arange(count)
radius = np.sqrt(1 - z * z)
normals = np.stack([radius * np.cos(azimuth), z, radius * np.sin(azimuth)], axis=-1)

exact = sky.irradiance(normals)
for codec in codecs:
    E = codec.irradiance(coefficients[codec.name], normals)
    wrong = lobelia.errors(E, exact)
    print(f"{codec.name:34} {12 * codec.size:4} bytes, RMS error {100 * wrong.rms / exact.mean():5.1f} % of the mean")

# %% [markdown]
# ## Samples as they arrive
#
# A path tracer makes samples in parts. Each thread adds its own to an accumulator; merged, they give the coefficients of
# all.

# %%
codec = codecs[1]
generator = np.random.default_rng(1)
total = codec.accumulator()
for part in range(4):
    directions = generator.normal(size=(5000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    radiance = np.maximum(directions[:, 1:2], 0) * [1.0, 0.8, 0.6]
    accumulator = codec.accumulator()
    accumulator.add(directions, radiance)
    total.merge(accumulator)
c = total.solve()

# The radiance max(0, y) gives E = 2 pi / 3 upwards.
up = codec.irradiance(c, [0, 1, 0])
print("E upwards:", up, "expected:", 2 * math.pi / 3 * np.array([1.0, 0.8, 0.6]))
assert np.allclose(up, 2 * math.pi / 3 * np.array([1.0, 0.8, 0.6]), rtol=0.05)

# %% [markdown]
# ## Bake a scene
#
# `read_gltf` reads a scene with lightmap UVs (`lobelia unwrap` makes them); the Cornell box is embedded. Without a
# folder, nothing is written. Ctrl-C stops a bake.

# %%
scene = lobelia.embedded_scene("cornell")
bake = lobelia.bake(
    scene,
    codec="sh1/least-squares/convolution",
    size=(64, 64),
    samples=32,
    progress=lambda p: print(f"{p.stage}: {100 * p.done:.0f} %"),
)
page = bake.pages[0]
print(f"{bake.statistics['texels']} texels, {bake.statistics['rays'] / 1e6:.1f} million rays")
print("channels:", ", ".join(page.channels))

# %% [markdown]
# `page["c0.R"]` is a view of the library's memory. The mean irradiance over all baked texels:

# %%
lit = page.chart > 0
print("mean irradiance [W/m²]:", page.irradiance[lit].mean(axis=0))
assert page.irradiance[lit].mean() > 0

# %% [markdown]
# ## Textures
#
# Storages keep coefficients in fewer bytes. The error of each, as the irradiance that it changes at the texels' normals:

# %%
codec = lobelia.Codec(bake.codec)
c = page.coefficients
some = np.argwhere(lit)[::40]


def irradiance_at(coefficients):
    return np.stack([codec.irradiance(coefficients[y, x], page.normals[y, x]) for y, x in some])


stored_exactly = irradiance_at(c)
for name in ("float32", "float16", "ratio8"):
    textures = lobelia.pack(codec, c, name)
    size = sum(texture.data.nbytes for texture in textures) / lit.size
    wrong = lobelia.errors(irradiance_at(textures.unpack()), stored_exactly)
    print(f"{name:8} {size:4.0f} bytes a texel, RMS error {100 * wrong.rms / stored_exactly.mean():.3f} %")
    assert wrong.rms < 0.05 * stored_exactly.mean()

# %% [markdown]
# `bake.write("folder", scene=scene)` writes pages, textures and `bake.json` as `lobelia bake` does; docs/bake-format.md
# describes them.
