# SPDX-License-Identifier: BSD-3-Clause
"""Runs every command of the tutorial: tutorial_test.py PROGRAM SOURCE_FOLDER"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
del sys.argv[1:3]
PAGE = (ROOT / "docs/tutorial/README.md").read_text(encoding="utf-8")


class Tutorial(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.output = {}
        environment = dict(os.environ, PATH=f"{PROGRAM.parent}:{os.environ['PATH']}")
        for block in re.findall(r"^```sh\n(.*?)^```$", PAGE, flags=re.M | re.S):
            run = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=cls.folder, env=environment,
                                 capture_output=True, text=True, check=False)
            cls.output[block] = run.stdout + run.stderr
            assert run.returncode == 0, f"{block}\n{run.stdout}{run.stderr}"

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def printed_by(self, command):
        return next(output for block, output in self.output.items() if command in block)

    def summary(self, folder):
        return json.loads((self.folder / folder / "summary.json").read_text(encoding="utf-8"))

    def test_right_rig_is_trusted_and_wrong_one_is_not(self):
        self.assertTrue(self.summary("out")["trusted"])
        self.assertFalse(self.summary("wrong")["trusted"])

    def test_wrong_mount_is_named_with_the_one_that_fits(self):
        self.assertRegex(self.printed_by("wrong.yaml"), r"laser1's mount is off: 4[45]\.\d+ ± .* deg fits")

    def test_diagnosis_names_the_hidden_effect(self):
        found = json.loads((self.folder / "diagnosis/diagnosis.json").read_text(encoding="utf-8"))["findings"]
        self.assertIn("encoder.eccentricity", [finding["cause"] for finding in found if finding["accepted"]])

    def test_files_of_the_page_are_there(self):
        for name in ("out/report.html", "out/calibration.yaml", "out/cloud.pcd", "second/out/cloud.las",
                     "diagnosis/calibration.yaml", "diagnosis/cloud.pcd"):
            self.assertTrue((self.folder / name).exists(), name)

    def test_every_key_of_the_summary_is_documented(self):
        page = (ROOT / "docs/reference/json.md").read_text(encoding="utf-8")
        summary = self.summary("out")
        refine = next(stage for stage in summary["stages"] if stage["stage"] == "calibrate.refine")
        for key in [*summary, *refine, *refine["report"], *summary["inputs"][0]]:
            self.assertIn(f"`{key}`", page)


if __name__ == "__main__":
    unittest.main()
