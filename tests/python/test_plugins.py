"""What other packages are handed: xarray's arrays, a reader for napari, a format of imageio. Each against the package
itself where it is installed."""

import copy
import importlib
import importlib.util
import pickle
import re
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import nutik
import nutik.napari

import support


def needs(module):
    return unittest.skipIf(importlib.util.find_spec(module) is None, f"Python's module {module} is not installed")


class Plugins(support.TestCase):
    def setUp(self):
        super().setUp()
        self.pictures = support.moving_box(samples=12, height=10, width=14)
        self.file = self.path("clip.tik")
        self.times = np.cumsum([0.3, 0.5, 0.25, 1] * 3) / 100
        self.capture = nutik.encode(self.pictures, self.file, times=self.times, exposures=1e-3)

    @needs("xarray")
    def test_xarray(self):
        whole = self.capture.to_xarray()
        self.assertIs(type(whole), importlib.import_module("xarray").DataArray)
        self.assertEqual(whole.dims, ("time", "y", "x", "channel"))
        self.assert_same(whole.values, self.pictures)
        np.testing.assert_array_equal(whole["time"], self.capture.times)
        near = whole.sel(channel="green").sel(time=self.capture.times[5] + 1e-4, method="nearest")
        self.assert_same(near.values, self.pictures[5, :, :, 1])
        self.assertEqual(whole.attrs["white"], 255)
        self.assertTrue("transfer" in whole.attrs["facts"])
        part = nutik.encode(self.pictures[..., 0], rate=10).to_xarray(slice(2, 9, 3))
        self.assertEqual(part.dims, ("time", "y", "x"))
        np.testing.assert_allclose(part["time"], [0.2, 0.5, 0.8])
        picture = self.capture.render(start=0, exposure="20ms")
        self.assertEqual(picture.to_xarray().attrs["error_bound"], picture.error_bound)
        self.assertTrue(np.shares_memory(picture.to_xarray().values, picture.array))
        starts = [0.0, 0.01, 0.02]
        many = self.capture.render_many(starts=starts, exposures="10ms").to_xarray(start=starts)
        self.assertEqual(many.dims, ("start", "y", "x", "channel"))
        self.assertEqual(many.sel(start=0.01).shape, (10, 14, 3))
        self.assertEqual(many.mean("channel").dims, ("start", "y", "x"))
        self.assertEqual((many["start"].attrs["units"], whole["time"].attrs["units"]), ("s", "s"))
        self.assertEqual((whole.name, many.name, many.attrs["units"]), ("codes", "light", "1"))

    @needs("xarray")
    def test_xarray_of_a_region(self):
        region = dict(region=(5, 3, 4, 6), exposure="20ms")
        picture = self.capture.render(**region)
        many = self.capture.render_many(starts=[0, 0.01], exposures="20ms", region=region["region"])
        for each in (picture, pickle.loads(pickle.dumps(picture)), copy.deepcopy(picture), many):
            array = each.to_xarray()
            self.assertEqual((array["x"].values.tolist(), array["y"].values.tolist()),
                             ([5, 6, 7, 8], [3, 4, 5, 6, 7, 8]))
        whole = self.capture.render(exposure="20ms").to_xarray()
        self.assert_same(whole.sel(x=7, y=5).values, picture.to_xarray().sel(x=7, y=5).values)

    @needs("xarray")
    def test_xarray_of_bounds(self):
        starts = [0, 0.01, 0.02]
        many = self.capture.render_many(starts=starts, exposures="10ms")
        np.testing.assert_array_equal(many.to_xarray().attrs["error_bounds"], many.error_bounds)
        darkest = self.capture.render(exposure="10ms", combine="darken").to_xarray()
        self.assertNotIn("error_bound", darkest.attrs)
        self.assertNotIn("error_bound", self.capture.background().picture.to_xarray().attrs)
        if importlib.util.find_spec("scipy") is not None:
            for name, each in (("many.nc", many.to_xarray(start=starts)), ("darkest.nc", darkest)):
                each.to_netcdf(self.path(name), engine="scipy")

    @needs("xarray")
    def test_xarray_of_wrong_arguments(self):
        many = self.capture.render_many(starts=[0, 0.01, 0.02], exposures="10ms")
        for wrong in (5, "abc", [1, 2], [[1, 2, 3]], np.zeros((3, 2))):
            self.assert_raises(nutik.UsageError, "a list of 3", many.to_xarray, start=wrong)
        self.assert_raises(nutik.UsageError, "one name", many.to_xarray, start=[1, 2, 3], end=[1, 2, 3])
        self.assert_raises(nutik.UsageError, "x= names an axis", many.to_xarray, x=[1, 2, 3])
        self.assert_raises(nutik.WrongType, "slice(10, 20)", self.capture.to_xarray, 10)

    @needs("imageio")
    def test_imageio(self):
        import imageio
        importlib.import_module("nutik.imageio")
        self.assert_same(np.stack(imageio.mimread(self.file)), self.pictures)
        with imageio.get_reader(self.file) as reader:
            self.assertEqual(len(reader), 12)
            self.assert_same(np.asarray(reader.get_data(7)), self.pictures[7])
            self.assertEqual(reader.get_data(7).meta["time"], self.capture.times[7])
            self.assertEqual(reader.get_meta_data()["white"], 255)
        self.assert_same(np.asarray(imageio.imread(self.file)), self.pictures[0])
        self.assert_same(np.asarray(imageio.volread(self.file)), self.capture[:])
        self.assertEqual(len(imageio.mvolread(self.file)), 1)

    @needs("imageio")
    def test_imageio_asks_for_times_once(self):
        import imageio
        importlib.import_module("nutik.imageio")
        with unittest.mock.patch.object(nutik.Capture, "times_ns", new_callable=unittest.mock.PropertyMock,
                                        return_value=self.capture.times_ns) as asked:
            imageio.mimread(self.file)
        self.assertEqual(asked.call_count, 1)

    def test_napari_reads_captures(self):
        self.assertIsNone(nutik.napari.reader("clip.mp4"))
        self.assertIsNone(nutik.napari.reader([self.file, "clip.mp4"]))
        ((layer, named, kind),) = nutik.napari.reader(self.file)(self.file)
        self.assertEqual((kind, named["name"], named["rgb"], layer.ndim), ("image", "clip.tik", True, 4))
        self.assert_same(np.asarray(layer[3]), self.pictures[3])
        self.assertEqual(len(nutik.napari.reader([self.file] * 2)([self.file] * 2)), 2)
        nutik.encode(self.pictures[..., 0], self.path("grey.tik"), rate=100)
        ((layer, named, _),) = nutik.napari.reader(self.path("grey.tik"))(self.path("grey.tik"))
        self.assertEqual((named["scale"], named["contrast_limits"]), ((0.01, 1.0, 1.0), (0, 255)))

    def test_napari_finds_the_reader(self):
        text = Path(nutik.__file__).with_name("napari.yaml").read_text(encoding="utf-8")
        module, function = re.search(r"python_name: (\S+):(\S+)", text).groups()
        self.assertIs(getattr(importlib.import_module(module), function), nutik.napari.reader)
        self.assertEqual(re.search(r"id: (\S+)", text)[1], re.search(r"command: (\S+)", text)[1])
        if importlib.util.find_spec("npe2") is None:
            self.skipTest("Python's module npe2 is not installed: napari itself has not read the manifest")
        importlib.import_module("npe2").PluginManifest.from_file(Path(nutik.__file__).with_name("napari.yaml"))


if __name__ == "__main__":
    unittest.main()
