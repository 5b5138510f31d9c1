"""Environments, codecs, accumulators, storages, metrics and scenes through Python."""

import math
import pathlib
import tempfile
import unittest

import numpy as np

import lobelia


def fibonacci_sphere(count):
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    phi = math.pi * (3 - math.sqrt(5)) * i
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).astype(np.float32)


class Environments(unittest.TestCase):
    def test_pixels_are_not_copied(self):
        sky = lobelia.Environment.sky((64, 32))
        self.assertEqual(sky.pixels.shape, (32, 64, 3))
        self.assertEqual(sky.pixels.dtype, np.float32)
        self.assertEqual(sky.pixels.ctypes.data, sky.pixels.ctypes.data)
        self.assertFalse(sky.pixels.flags.owndata)
        self.assertFalse(sky.pixels.flags.writeable)

    def test_array_outlives_its_environment(self):
        pixels = lobelia.Environment(np.full((4, 8, 3), 2)).pixels
        self.assertTrue((pixels == 2).all())

    def test_refuses_what_is_not_radiance(self):
        for bad in (-1, math.nan, math.inf):
            with self.assertRaisesRegex(lobelia.Error, "pixels"):
                lobelia.Environment(np.full((4, 8, 3), bad))
        with self.assertRaisesRegex(lobelia.Error, "shape"):
            lobelia.Environment(np.zeros((4, 8)))
        with self.assertRaisesRegex(ValueError, "no such file.hdr"):
            lobelia.Environment.load("no such file.hdr")
        with self.assertRaisesRegex(lobelia.Error, "turbidity|haze"):
            lobelia.Environment.sky(turbidity=100)


class Codecs(unittest.TestCase):
    def test_white_furnace(self):
        white = lobelia.Environment(np.ones((32, 64, 3)))
        normals = fibonacci_sphere(300)
        # Twelve lobes only come near a constant.
        for name, bound in (("sh2/least-squares/convolution", 1e-3), ("sg12/least-squares/odd-exact-2", 0.05)):
            codec = lobelia.Codec(name)
            c = codec.encode(white)
            self.assertEqual(c.shape, (codec.size, 3))
            np.testing.assert_allclose(codec.irradiance(c, normals), math.pi, rtol=bound)
        c = lobelia.Codec("sh2/least-squares/convolution").encode(white)
        np.testing.assert_allclose(lobelia.Codec("sh2/least-squares/convolution").radiance(c, normals), 1, rtol=1e-3)

    def test_one_direction_is_as_many(self):
        codec = lobelia.Codec("sg12/least-squares/hill")
        c = codec.encode(lobelia.Environment.sky((64, 32)))
        normals = fibonacci_sphere(20).reshape(4, 5, 3)
        E = codec.irradiance(c, normals)
        self.assertEqual(E.shape, (4, 5, 3))
        np.testing.assert_allclose(codec.irradiance(c, normals[2, 3]), E[2, 3], rtol=1e-5)
        self.assertEqual(codec.irradiance(c, [0, 1, 0]).shape, (3,))

    def test_degree_two_harmonics_are_near_the_exact_irradiance(self):
        sky = lobelia.Environment.sky((128, 64))
        codec = lobelia.Codec("sh4/least-squares/convolution")
        normals = fibonacci_sphere(500)
        exact = sky.irradiance(normals)
        wrong = lobelia.errors(codec.irradiance(codec.encode(sky), normals), exact)
        self.assertLess(wrong.rms, 0.05 * exact.mean())
        self.assertEqual(lobelia.errors(exact, exact).rms, 0)

    def test_unknown_names_get_suggestions(self):
        with self.assertRaisesRegex(lobelia.Error, "convolution"):
            lobelia.Codec("sh2/least-squares/convolutoin")

    def test_shapes_are_checked(self):
        codec = lobelia.Codec("sh1/least-squares/convolution")
        with self.assertRaisesRegex(lobelia.Error, r"coefficients.*\(4, 3\)"):
            codec.irradiance(np.zeros((3, 3)), [0, 1, 0])
        with self.assertRaisesRegex(lobelia.Error, "directions"):
            codec.radiance(np.zeros((4, 3)), [0, 1])
        with self.assertRaisesRegex(lobelia.Error, "radiance"):
            codec.encode(np.zeros((5, 3)), np.zeros((4, 3)))

    def test_lists(self):
        self.assertIn("sh2/least-squares/convolution", lobelia.codec_names())
        lobelia.Codec(lobelia.default_codec())


class Accumulators(unittest.TestCase):
    def test_merge_equals_sequential(self):
        codec = lobelia.Codec("sg6/least-squares/hill")
        directions = fibonacci_sphere(600)
        radiance = np.maximum(directions[:, 1:2], 0) * [1, 2, 3]
        whole, first, second = codec.accumulator(), codec.accumulator(), codec.accumulator()
        whole.add(directions, radiance)
        first.add(directions[:250], radiance[:250], np.full(250, 4 * math.pi / 600))
        second.add(directions[250:], radiance[250:], np.full(350, 4 * math.pi / 600))
        first.merge(second)
        np.testing.assert_allclose(first.solve(), whole.solve(), rtol=1e-4, atol=1e-4)
        np.testing.assert_array_equal(whole.solve(), codec.encode(directions, radiance))
        self.assertFalse(whole.state.flags.owndata)

    def test_refuses_another_codec(self):
        a = lobelia.Codec("sh1/moments/convolution").accumulator()
        with self.assertRaisesRegex(lobelia.Error, "sh2/moments/convolution"):
            a.merge(lobelia.Codec("sh2/moments/convolution").accumulator())


class Storages(unittest.TestCase):
    def setUp(self):
        self.codec = lobelia.Codec("sh1/least-squares/convolution")
        c = self.codec.encode(lobelia.Environment.sky((64, 32)))
        self.coefficients = np.linspace(1, 2, 6 * 5).reshape(6, 5, 1, 1).astype(np.float32) * c

    def test_float32_round_trip(self):
        textures = lobelia.pack(self.codec, self.coefficients, "float32")
        np.testing.assert_array_equal(textures.unpack(), self.coefficients)
        self.assertEqual(sum(len(t.data) for t in textures), 6 * 5 * 3 * 4 * 4)
        self.assertEqual((textures[0].width, textures[-1].height), (5, 6))
        with self.assertRaises(IndexError):
            textures[len(textures)]

    def test_every_storage_that_fits(self):
        names = lobelia.storage_names(self.codec)
        self.assertIn("ratio8", names)
        self.assertLess(set(names), set(lobelia.storage_names()))
        largest = np.abs(self.coefficients).max()
        for name in names:
            unpacked = lobelia.pack(self.codec, self.coefficients, name).unpack()
            self.assertLess(np.abs(unpacked - self.coefficients).max(), 0.1 * largest, name)

    def test_texture_keeps_its_textures(self):
        data = lobelia.pack(self.codec, self.coefficients, "float32")[0].data
        self.assertEqual(data.view(np.float32)[0], self.coefficients[0, 0, 0, 0])

    def test_refuses_other_shapes_and_names(self):
        with self.assertRaisesRegex(lobelia.Error, "shape"):
            lobelia.pack(self.codec, self.coefficients[:, :, :3], "float32")
        with self.assertRaisesRegex(lobelia.Error, "no-such"):
            lobelia.pack(self.codec, self.coefficients, "no-such")


class Scenes(unittest.TestCase):
    def test_embedded(self):
        self.assertIn("cornell", lobelia.embedded_scene_names())
        scene = lobelia.embedded_scene("cornell")
        self.assertGreater(scene.triangles, 20)
        self.assertEqual(len(set(scene.objects)), len(scene.objects))
        self.assertIsNone(scene.environment)
        scene.environment = lobelia.Environment.sky((16, 8))
        self.assertEqual(scene.environment.pixels.shape, (8, 16, 3))
        scene.environment = None
        scene.set_sky(sun_elevation=30)
        self.assertIsNotNone(scene.environment)

    def test_hostile_files_are_errors(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "broken.glb"
            path.write_bytes(b"glTF\x02\x00\x00\x00\xff\xff\xff\xff")
            with self.assertRaisesRegex(lobelia.Error, "broken.glb"):
                lobelia.read_gltf(path)


if __name__ == "__main__":
    unittest.main()
