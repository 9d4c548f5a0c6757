# SPDX-License-Identifier: BSD-3-Clause
"""Builds the site and checks it: site_test.py SOURCE_FOLDER

Ends with status 77, and a reason, where mkdocs or its theme is missing.
"""

import html.parser
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

ROOT = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else pathlib.Path(".").resolve()


def skip(reason):
    print(f"tests/docs/site_test.py: Skipped\n{reason}\n[  SKIPPED ] Docs.Site (0 ms)")
    sys.exit(77)


if shutil.which("mkdocs") is None:
    skip("mkdocs is missing: apt-get install mkdocs mkdocs-material")
build = subprocess.run(["mkdocs", "build", "--help"], capture_output=True, text=True, check=False).stdout
if "material" not in build:  # among the themes of --theme
    skip("the theme is missing: apt-get install mkdocs-material")


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.ids, self.targets, self.loaded = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        key = {"a": "href", "img": "src", "link": "href", "script": "src"}.get(tag)
        if key and attributes.get(key):
            self.targets.append(attributes[key])
            if tag != "a" and attributes.get("rel") != "canonical":
                self.loaded.append(attributes[key])


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.site = pathlib.Path(cls.folder.name).resolve() / "site"
        cls.built = subprocess.run(["mkdocs", "build", "--strict", "--site-dir", str(cls.site)], cwd=ROOT,
                                   capture_output=True, text=True, check=False)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_is_built_without_a_warning(self):
        self.assertEqual(self.built.returncode, 0, self.built.stderr)
        self.assertNotIn("WARNING", self.built.stderr)

    def test_links_lead_to_pages_and_headings_and_nothing_is_loaded_from_elsewhere(self):
        pages = {path: Page(path.read_text(encoding="utf-8")) for path in self.site.rglob("*.html")
                 if path.name != "404.html"}
        self.assertGreater(len(pages), 80)
        for path, page in pages.items():
            self.assertFalse([target for target in page.loaded if "//" in target], path)
            for target in page.targets:
                parts = urllib.parse.urlsplit(target)
                if parts.scheme or parts.netloc:
                    continue
                with self.subTest(f"{path.relative_to(self.site)}: {target}"):
                    file = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
                    file = file / "index.html" if file.is_dir() else file
                    self.assertTrue(file.exists())
                    anchor = urllib.parse.unquote(parts.fragment)
                    if anchor and file in pages:
                        self.assertIn(anchor, pages[file].ids)

    def test_can_be_searched(self):
        index = (self.site / "search/search_index.json").read_text(encoding="utf-8")
        self.assertIn("UNTRUSTED", index)


if __name__ == "__main__":
    unittest.main()
