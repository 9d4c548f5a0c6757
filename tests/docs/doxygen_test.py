# SPDX-License-Identifier: BSD-3-Clause
"""Checks the reference of the public headers: doxygen_test.py SOURCE_FOLDER

Ends with status 77, and a reason, where doxygen is missing.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else pathlib.Path(".").resolve()
HEADERS = ROOT / "pipeline/include/crisp"
PAGE = ROOT / "docs/reference/cpp.md"
EXAMPLES = ROOT / "tests/examples"
INCLUDE = re.compile(r"^#include <crisp/([\w.]+)>", re.M)

if shutil.which("doxygen") is None:
    print("tests/docs/doxygen_test.py: Skipped\ndoxygen is missing: apt-get install doxygen\n[  SKIPPED ] Docs.Doxygen (0 ms)")
    sys.exit(77)


def copy_headers(folder):
    """Copies the public headers to where they are in the project, below `folder`; returns their folder."""
    return shutil.copytree(HEADERS, pathlib.Path(folder) / HEADERS.relative_to(ROOT))


def doxygen(folder):
    """Runs doxygen in `folder`, which has the headers alone, with the project's settings."""
    return subprocess.run(["doxygen", ROOT / "docs/Doxyfile"], cwd=folder, capture_output=True, text=True, check=False)


def included(file):
    """The public headers that a source includes, directly or through others of them."""
    text = file.read_text(encoding="utf-8")
    text += "".join((file.parent / own).read_text(encoding="utf-8") for own in re.findall(r'^#include "(.+)"', text, re.M))
    found, new = set(), set(INCLUDE.findall(text))
    while new:
        found |= new
        new = {name for header in new for name in INCLUDE.findall((HEADERS / header).read_text(encoding="utf-8"))} - found
    return found


def rows():
    """(header, example) of each row of the page's table."""
    return re.findall(r"^\| `<crisp/([\w.]+)>` \|.*\| \[.*?\]\(\S*/tests/examples/([\w.]+)\) \|$",
                      PAGE.read_text(encoding="utf-8"), re.M)


class Doxygen(unittest.TestCase):
    def test_all_that_is_public_is_documented(self):
        with tempfile.TemporaryDirectory() as folder:
            copy_headers(folder)
            run = doxygen(folder)
            self.assertEqual((run.returncode, run.stderr), (0, ""))
            self.assertTrue((pathlib.Path(folder) / "build/doxygen/index.html").is_file())

    def test_a_member_without_documentation_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            header = copy_headers(folder) / "calibration.hpp"
            text = header.read_text(encoding="utf-8")
            header.write_text(text.replace("struct Calibration {", "struct Calibration {\n  int bare = 0;"), encoding="utf-8")
            run = doxygen(folder)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("Member bare (variable) of struct crisp::Calibration is not documented", run.stderr)


class Page(unittest.TestCase):
    def test_names_each_public_header_once(self):
        self.assertEqual(sorted(header for header, _ in rows()), sorted(file.name for file in HEADERS.iterdir()))

    def test_names_an_example_that_uses_the_header(self):
        for header, example in rows():
            with self.subTest(header):
                self.assertIn(header, included(EXAMPLES / example), f"{example} does not include it")


if __name__ == "__main__":
    unittest.main()
