# SPDX-License-Identifier: BSD-3-Clause
"""Checks each page of the documentation: links, length, how it begins: pages_test.py SOURCE_FOLDER"""

import pathlib
import re
import sys
import unittest
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import markdown  # noqa: E402

ROOT = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else pathlib.Path(".").resolve()
WORDS = 120
COLUMNS = 120
SUMMARY = ("Measured", "When", "Command", "Result", "Meaning")  # the five lines that a report begins with


def pages():
    return [ROOT / "README.md", ROOT / "CONTRIBUTING.md"] + sorted((ROOT / "docs").rglob("*.md"))


def name(page):
    return str(page.relative_to(ROOT))


def is_generated(page):
    return name(page) in ("docs/effects.md", "docs/reference/README.md", "docs/reference/messages.md") or (
        page.parent.name == "reference" and "." in page.stem)


BLOCKS = {page: markdown.blocks(page.read_text(encoding="utf-8")) for page in pages()}
WRITTEN = [page for page in BLOCKS if not is_generated(page)]


class Pages(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        for page, blocks in BLOCKS.items():
            for line, target in markdown.links(blocks):
                if re.match(r"[a-z]+:", target):
                    continue
                with self.subTest(f"{name(page)}:{line}: {target}"):
                    path, _, anchor = urllib.parse.unquote(target).partition("#")
                    file = (page.parent / path).resolve() if path else page
                    self.assertTrue(file.exists(), "there is no such file")
                    if anchor:
                        self.assertIn(anchor, markdown.anchors(BLOCKS[file]) if file in BLOCKS else ())

    def test_paragraphs_have_at_most_120_words(self):
        for page in WRITTEN:
            for block in BLOCKS[page]:
                if block.kind in ("paragraph", "item"):
                    with self.subTest(f"{name(page)}:{block.line}"):
                        self.assertLessEqual(len(block.text().split()), WORDS)

    def test_lines_of_prose_have_at_most_120_columns(self):
        for page in WRITTEN:
            for block in BLOCKS[page]:
                if block.kind not in ("paragraph", "item"):
                    continue
                for number, line in enumerate(block.lines, block.line):
                    is_one_link = len(line.split()) <= 2
                    with self.subTest(f"{name(page)}:{number}"):
                        self.assertTrue(len(line) <= COLUMNS or is_one_link, f"{len(line)} columns")

    def test_pages_begin_with_what_the_reader_can_do_after_them(self):
        for page in WRITTEN:
            if page.parent.name == "reports" or page.parent == ROOT:
                continue
            with self.subTest(name(page)):
                title, first = BLOCKS[page][:2]
                self.assertTrue(title.lines[0].startswith("# "))
                self.assertTrue(first.lines[0].startswith("After this page you "), first.lines[0])

    def test_reports_begin_with_five_lines_of_summary(self):
        for page in WRITTEN:
            if page.parent.name != "reports":
                continue
            with self.subTest(name(page)):
                items = [block.lines[0] for block in BLOCKS[page][1:6]]
                for item, word in zip(items, SUMMARY):
                    self.assertTrue(item.startswith(f"- **{word}**: "), f"{item} for {word}")

    def test_every_page_is_in_the_index(self):
        index = ROOT / "docs/README.md"
        named = {(index.parent / target.partition("#")[0]).resolve() for _, target in markdown.links(BLOCKS[index])}
        for page in WRITTEN:
            if page != index and page.parent != ROOT:
                with self.subTest(name(page)):
                    self.assertIn(page, named)


if __name__ == "__main__":
    unittest.main()
