# SPDX-License-Identifier: BSD-3-Clause
"""The Python package as people use it."""

import os
import pathlib
import resource
import signal
import tempfile
import threading
import time
import unittest
import warnings

import crisp
import numpy


def write_pcd(file: pathlib.Path, points: numpy.ndarray) -> None:
    """n rows x, y, z as a binary PCD file, written by the format's description."""
    n = len(points)
    header = (
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
        f"WIDTH {n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA binary\n"
    )
    file.write_bytes(header.encode() + points.astype("<f4").tobytes())


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def simulate(self, duration="4s"):
        return crisp.run("simulate", output=self.folder / "made", set={"grabber.simulate.duration": duration})


class RunTest(InAFolder):
    def test_calibrates_a_capture_by_the_name_of_a_pipeline(self):
        self.simulate()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", crisp.NotTrustedWarning)
            result = crisp.run("calibrate", input=self.folder / "made/hub.pcap", output=self.folder / "out")
        self.assertTrue((self.folder / "out/cloud.pcd").exists())
        self.assertTrue((self.folder / "out/summary.json").exists())
        self.assertGreater(len(result.cloud), 100_000)
        self.assertEqual(result.cloud.dtype.names, ("x", "y", "z", "intensity", "laser", "beam", "time"))
        self.assertEqual(sorted(set(result.cloud["laser"].tolist())), [0, 1, 2])
        lasers = result.calibration["lasers"]
        self.assertEqual(len(lasers), 3)
        self.assertIsInstance(result.trusted, bool)
        # Ranges of measurements are those of points: the distance of the mirror, whose τ is about 20 cm.
        self.assertEqual(len(result.measurements), len(result.cloud))
        distance = numpy.sqrt(sum(result.cloud[axis].astype(float) ** 2 for axis in "xyz"))
        self.assertLess(numpy.abs(distance - result.measurements["range"]).max(), 0.35)
        self.assertTrue(numpy.all(numpy.abs(numpy.diff(result.cloud["time"])) < 1))

    def test_reads_a_cloud_with_a_pipeline_that_is_a_dict(self):
        points = numpy.array([[1, 2, 3], [4, 5, 6], [7, 8, 9.5]])
        write_pcd(self.folder / "in.pcd", points)
        pipeline = {
            "crisp": 1,
            "pipeline": [{"stage": "grabber.cloud", "with": {"file": "${input}"}}, {"stage": "filter.crop", "with": {"z": ["0m", "20m"]}}],
        }
        result = crisp.run(pipeline, input=self.folder / "in.pcd")
        rows = numpy.stack([result.cloud[axis] for axis in "xyz"], axis=1)
        numpy.testing.assert_array_equal(rows, points.astype("f4"))
        self.assertIsNone(result.measurements)
        self.assertIsNone(result.calibration)

    def test_copies_no_cloud_of_a_million_points(self):
        n = 2_000_000
        write_pcd(self.folder / "in.pcd", numpy.random.default_rng(1).normal(size=(n, 3)))
        pipeline = {"crisp": 1, "pipeline": [{"stage": "grabber.cloud", "with": {"file": "${input}"}}]}
        result = crisp.run(pipeline, input=self.folder / "in.pcd")
        cloud = result.cloud
        self.assertEqual(len(cloud), n)
        self.assertFalse(cloud.flags["OWNDATA"])
        self.assertFalse(cloud.flags["WRITEABLE"])

        def resident():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

        before = resident()
        x = cloud["x"]  # what a user takes of it is a view, too
        self.assertTrue(numpy.shares_memory(x, cloud))
        self.assertLess(resident() - before, 1_000_000)
        del result, cloud
        self.assertAlmostEqual(float(x[:1000].astype(float).mean()), 0, delta=0.2)  # the view keeps it
        held = resident()
        del x
        self.assertLess(resident() - held, -n * 32 * 0.9)  # and it goes with the last view

    def test_raises_errors_with_their_place(self):
        file = self.folder / "wrong.yaml"
        file.write_text("crisp: 1\npipeline:\n  - stage: grabber.cloudd\n  - {stage: filter.crop, with: {w: 1}}\n")
        with self.assertRaises(crisp.Error) as caught:
            crisp.run(file)
        error = caught.exception
        self.assertEqual((error.file, error.line, error.column), (str(file), 3, 12))
        self.assertIn("grabber.cloud", str(error))
        with self.assertRaisesRegex(crisp.Error, "did you mean 'calibrate'"):
            crisp.run("calibrat")
        with self.assertRaisesRegex(crisp.Error, "there is no input"):
            crisp.run("calibrate", input=self.folder / "no.pcap", output=self.folder)

    def test_warns_of_what_is_not_to_be_trusted(self):
        self.simulate("3s")
        with self.assertWarns(crisp.NotTrustedWarning) as caught:
            result = crisp.run(
                "calibrate",
                input=self.folder / "made/hub.pcap",
                output=self.folder / "out",
                set={"calibrate.refine.rounds": 1},
            )
        self.assertFalse(result.trusted)
        self.assertIn(result.caveats[0], str(caught.warning))

    def test_lets_other_threads_run(self):
        ticks = []
        done = threading.Event()

        def tick():
            while not done.wait(0.001):
                ticks.append(time.monotonic())

        ticker = threading.Thread(target=tick)
        ticker.start()
        begin = time.monotonic()
        self.simulate("6s")
        end = time.monotonic()
        done.set()
        ticker.join()
        during = sum(begin < at < end for at in ticks)
        self.assertGreater(during, 10)

    def test_is_interrupted_by_ctrl_c(self):
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            self.simulate("3600s")
        self.assertFalse((self.folder / "made/hub.pcap").exists())


class RqeTest(unittest.TestCase):
    def test_agrees_with_the_sum_over_all_pairs(self):
        points = numpy.random.default_rng(2).uniform(size=(60, 3)) * 0.2
        sigma = 0.03

        def by_brute_force(p):
            d2 = ((p[:, None, :] - p[None, :, :]) ** 2).sum(axis=2)
            kernel = numpy.exp(-d2 / (4 * sigma**2)) / (4 * numpy.pi * sigma**2) ** 1.5
            return -numpy.log(kernel.mean())

        value, gradient = crisp.rqe(points, sigma)
        self.assertAlmostEqual(value, by_brute_force(points), places=4)
        step = numpy.zeros_like(points)
        step[7, 1] = 1e-6
        slope = (by_brute_force(points + step) - by_brute_force(points - step)) / 2e-6
        self.assertAlmostEqual(gradient[7, 1], slope, places=4)

    def test_refuses_what_is_no_cloud(self):
        for wrong in (numpy.zeros(3), numpy.zeros((0, 3)), numpy.full((4, 3), numpy.nan)):
            with self.assertRaises(crisp.Error):
                crisp.rqe(wrong)


if __name__ == "__main__":
    unittest.main()
