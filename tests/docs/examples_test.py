# SPDX-License-Identifier: BSD-3-Clause
"""Checks the documentation's examples by the program: examples_test.py PROGRAM SOURCE_FOLDER

Rigs and pipelines are validated; each command of crisp has options that it knows.
"""

import functools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import markdown  # noqa: E402

PROGRAM, ROOT = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
del sys.argv[1:3]
PAGES = [ROOT / "README.md"] + sorted((ROOT / "docs").rglob("*.md"))


def examples():
    """(page, line, text) of each block of code, without fence and indentation."""
    for page in PAGES:
        for block in markdown.blocks(page.read_text(encoding="utf-8")):
            if block.kind != "code":
                continue
            lines = [line for line in block.lines if not line.lstrip().startswith("```")]
            indent = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
            yield page, block.line, "\n".join(line[indent:] for line in lines) + "\n"


def validate(text, rigs):
    with tempfile.TemporaryDirectory() as folder:
        for name, rig in rigs.items():
            (pathlib.Path(folder) / name).write_text(rig, encoding="utf-8")
        file = pathlib.Path(folder) / "example.yaml"
        file.write_text(text, encoding="utf-8")
        return subprocess.run([PROGRAM, "validate", str(file)], capture_output=True, text=True, check=False)


@functools.cache
def help_of(*command):
    """What `crisp COMMAND --help` prints; None if there is no such command."""
    run = subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=False)
    return run.stdout if run.returncode == 0 else None


def command_of(words):
    """Name and help of the command that these words begin with, of `study bound` those of bound."""
    help_text = help_of(words[0])
    below = (help_text or "").partition("Subcommands:\n")[2]
    if len(words) > 1 and re.search(rf"^  {re.escape(words[1])} ", below, flags=re.M):
        return " ".join(words[:2]), help_of(*words[:2])
    return words[0], help_text


class Examples(unittest.TestCase):
    def test_rigs_and_pipelines_are_valid(self):
        default = (ROOT / "configs/rig.yaml").read_text(encoding="utf-8")
        rigs = {"rig.yaml": default}
        count = 0
        for page, line, text in examples():
            if not text.startswith("crisp: 1\n") and not text.startswith("crisp: 1 "):
                continue
            if "stage: example." in text:
                continue  # a plugin's, which tests/plugins/out_of_tree runs
            count += 1
            if "\nlasers:" in text:
                rigs["tilt.yaml"] = text  # of the pipeline that follows it
            with self.subTest(f"{page.relative_to(ROOT)}:{line}"):
                run = validate(text, rigs)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertGreater(count, 8)

    def test_commands_have_options_that_the_program_knows(self):
        for page, line, text in examples():
            for words in re.findall(r"^ *crisp ([a-z][^\n#]*)", text.replace("\\\n", " "), flags=re.M):
                name, help_text = command_of(words.split())
                with self.subTest(f"{page.relative_to(ROOT)}:{line}: crisp {name}"):
                    self.assertIsNotNone(help_text, "there is no such command")
                    for option in re.findall(r"(?<!\S)(--[a-z-]+)", words):
                        self.assertRegex(help_text, rf"{option}(?![a-z-])")

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
