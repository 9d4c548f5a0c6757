#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Clouds that crisp writes are opened by other programs: CloudCompare, Open3D and PCL's, as far as they are installed.

    peers_test.py CRISP
"""

import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # CTest's SKIP_RETURN_CODE
TOLERANCE = 1e-4  # [m]
POINTS = [(1.25, -2.5, 3.125, 10), (-20.0625, 0.5, 0.25, 200), (100.5, 200.25, -3, 65535), (0.0001, 0.0002, -0.0003, 0)]
PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else ""

try:
    import open3d
except ImportError:
    open3d = None
CLOUD_COMPARE = shutil.which("CloudCompare")
PCL = shutil.which("pcl_convert_pcd_ascii_binary") and shutil.which("pcl_ply2pcd")


def write_pcd(path):
    """A cloud in PCD, binary, by hand."""
    header = ("VERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
              f"WIDTH {len(POINTS)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(POINTS)}\nDATA binary\n")
    path.write_bytes(header.encode() + b"".join(struct.pack("<4f", *point) for point in POINTS))


class Peers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        write_pcd(self.folder / "given.pcd")

    def converted(self, ending):
        file = self.folder / f"cloud.{ending}"
        subprocess.run([PROGRAM, "convert", self.folder / "given.pcd", file], check=True, stdout=subprocess.DEVNULL)
        return file

    def expect_points(self, found, columns):
        self.assertEqual(len(found), len(POINTS))
        for point, truth in zip(found, POINTS):
            for value, true_value in zip(point, truth[:columns]):
                self.assertAlmostEqual(value, true_value, delta=TOLERANCE)

    @unittest.skipUnless(CLOUD_COMPARE, "cloudcompare is not installed")
    def test_cloud_compare_opens_ply_with_its_intensities(self):
        file = self.converted("ply")
        seen = self.folder / "seen.asc"
        subprocess.run([CLOUD_COMPARE, "-SILENT", "-AUTO_SAVE", "OFF", "-O", file, "-C_EXPORT_FMT", "ASC", "-PREC", "6",
                        "-SAVE_CLOUDS", "FILE", seen], check=True, stdout=subprocess.DEVNULL, timeout=120,
                       env=dict(os.environ, QT_QPA_PLATFORM="offscreen"))
        rows = [[float(number) for number in line.split()] for line in seen.read_text().splitlines()]
        self.expect_points(rows, 4)

    def points_by_pcl(self, pcd):
        """x, y, z and intensity of a cloud that PCL's program opens and writes as text."""
        text = self.folder / "text.pcd"
        subprocess.run(["pcl_convert_pcd_ascii_binary", pcd, text, "0"], check=True, stdout=subprocess.DEVNULL)
        header, _, rows = text.read_text().partition("DATA ascii\n")
        fields = next(line.split()[1:] for line in header.splitlines() if line.startswith("FIELDS"))
        columns = [fields.index(name) for name in ("x", "y", "z", "intensity")]
        return [[float(row.split()[column]) for column in columns] for row in rows.splitlines()]

    @unittest.skipUnless(PCL, "pcl-tools is not installed")
    def test_pcl_opens_pcd_with_its_intensities(self):
        self.expect_points(self.points_by_pcl(self.converted("pcd")), 4)

    @unittest.skipUnless(PCL, "pcl-tools is not installed")
    def test_pcl_opens_ply_with_its_intensities(self):
        made = self.folder / "made.pcd"
        subprocess.run(["pcl_ply2pcd", self.converted("ply"), made], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        self.expect_points(self.points_by_pcl(made), 4)

    @unittest.skipUnless(open3d, "python3-open3d is not installed")
    def test_open3d_opens_ply_and_pcd(self):
        for ending in ("ply", "pcd"):
            with self.subTest(ending):
                cloud = open3d.io.read_point_cloud(str(self.converted(ending)))
                self.expect_points([tuple(point) for point in cloud.points], 3)

    @unittest.skipUnless(open3d, "python3-open3d is not installed")
    def test_open3d_has_the_intensities_of_a_ply(self):
        cloud = open3d.t.io.read_point_cloud(str(self.converted("ply")))
        self.assertEqual([float(value) for value in cloud.point["intensity"].numpy().ravel()], [p[3] for p in POINTS])


if __name__ == "__main__":
    if not open3d and not CLOUD_COMPARE and not PCL:
        print("skipped: none of cloudcompare, python3-open3d and pcl-tools is installed")
        sys.exit(SKIPPED)
    unittest.main()
