# SPDX-License-Identifier: BSD-3-Clause
"""Checks the documentation's examples by the program: examples_test.py PROGRAM SOURCE_FOLDER

Rigs and pipelines are validated; code that names a file of the sources is that file's.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import code_blocks  # noqa: E402

PROGRAM, ROOT = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
del sys.argv[1:3]
PAGES = [ROOT / "README.md"] + sorted((ROOT / "docs").rglob("*.md"))


def examples():
    """(page, line, text) of each block of code."""
    for page in PAGES:
        for block in code_blocks.code_blocks(page):
            yield page, block.line, block.text


def validate(text, rigs):
    with tempfile.TemporaryDirectory() as folder:
        for name, rig in rigs.items():
            (pathlib.Path(folder) / name).write_text(rig, encoding="utf-8")
        file = pathlib.Path(folder) / "example.yaml"
        file.write_text(text, encoding="utf-8")
        return subprocess.run([PROGRAM, "validate", str(file)], capture_output=True, text=True, check=False)


class Examples(unittest.TestCase):
    def test_rigs_and_pipelines_are_valid(self):
        default = (ROOT / "configs/rig.yaml").read_text(encoding="utf-8")
        rigs = {"rig.yaml": default}
        count = 0
        for page, line, text in examples():
            if not text.startswith("crisp: 1\n") and not text.startswith("crisp: 1 "):
                continue
            if "stage: example." in text:
                continue  # a plugin's, which tests/installed runs
            count += 1
            if "\nlasers:" in text:
                rigs["tilt.yaml"] = text  # of the pipeline that follows it
            with self.subTest(f"{page.relative_to(ROOT)}:{line}"):
                run = validate(text, rigs)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertGreater(count, 8)

    def test_code_is_that_of_the_file_that_it_names(self):
        count = 0
        for page, line, text in examples():
            named = re.match(r"// ((?:tests|plugins|pipeline|grabbers)/\S+\.[ch]pp)\n", text)
            if not named or not (ROOT / named[1]).exists():
                continue
            count += 1
            rest = iter((ROOT / named[1]).read_text(encoding="utf-8").split("\n"))
            for code in text.split("\n")[1:-1]:
                with self.subTest(f"{page.relative_to(ROOT)}:{line}"):
                    self.assertIn(code, rest, f"not in {named[1]}, or not in this order")
        self.assertGreater(count, 1)


if __name__ == "__main__":
    unittest.main()
