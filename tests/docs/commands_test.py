# SPDX-License-Identifier: BSD-3-Clause
"""Types every command that README.md and the pages under docs/ show, as it stands there.

commands_test.py PROGRAM SOURCE PYTHONPATH check|run, see shim.py.
"""

import contextlib
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import code_blocks  # noqa: E402
import shim  # noqa: E402
from inputs import Inputs  # noqa: E402

PROGRAM, PYTHONPATH, HOW = sys.argv[1], sys.argv[3], sys.argv[4]
SOURCE = pathlib.Path(sys.argv[2]).resolve()
# All pages but the reference, which the program writes, and the tutorial, which tutorial_test.py runs as one story.
PAGES = ["README.md"] + sorted(
    str(page.relative_to(SOURCE))
    for page in (SOURCE / "docs").rglob("*.md")
    if "reference" not in page.parts and "tutorial" not in page.parts
)


def setUpModule():
    folder = tempfile.TemporaryDirectory(prefix="crisp-pages-")
    unittest.addModuleCleanup(folder.cleanup)
    global made, inputs
    made = pathlib.Path(folder.name)
    inputs = Inputs(PROGRAM, SOURCE, made, HOW)


class Reader:
    """Somebody who reads a page, in a folder with what its readers have, and types what it shows."""

    def __init__(self, page: str, how: str):
        self.page, self.how = page, how
        self.text = (SOURCE / page).read_text(encoding="utf-8")
        self.blocks = code_blocks.code_blocks(SOURCE / page)
        self._folder = tempfile.TemporaryDirectory(prefix="crisp-page-")
        self.folder = pathlib.Path(self._folder.name) / "here"
        self.folder.mkdir()
        inputs.give(self.folder, self.text)
        for shown in PAGES:  # files that a page shows, here or where it links to
            for block in code_blocks.code_blocks(SOURCE / shown):
                if block.file:
                    (self.folder / block.file).write_text(block.text, encoding="utf-8")
        self._parent = self.folder.parent
        (self._parent / "bin").mkdir()
        for name in ("crisp", *shim.STUBS):
            self._stand_in(self._parent / "bin" / name)
        for path in set(re.findall(r"(?<!\S)(?:\./|\.ci/|build/release/)[\w/]+", "\n".join(b.text for b in self.blocks if b.is_shell))):
            self._stand_in(self.folder / path)

    def _stand_in(self, file: pathlib.Path):
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"#!/bin/sh\nexec '{sys.executable}' -B '{shim.__file__}' '{file.name}' \"$@\"\n")
        file.chmod(0o755)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        emulators = self._parent / "emulators"
        if emulators.exists():
            for pid in emulators.read_text().split():
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(pid), signal.SIGINT)
        self._folder.cleanup()

    def types(self, words, text=""):
        """Runs a shell or Python in the folder; returns how it ended, and the calls of crisp and of stubs."""
        log = self._parent / "log"
        log.write_text("")
        environment = dict(
            os.environ,
            PATH=f"{self._parent / 'bin'}:{os.environ['PATH']}",
            PYTHONPATH=PYTHONPATH,
            PAGES_HOW=self.how,
            PAGES_LOG=str(log),
            PAGES_MADE=str(made),
            PAGES_EMULATORS=str(self._parent / "emulators"),
            PAGES_PROGRAM=PROGRAM,
            PAGES_SOURCE=str(SOURCE),
        )
        ended = subprocess.run(words, input=text, cwd=self.folder, env=environment, capture_output=True, text=True, check=False)
        return ended, [json.loads(line) for line in log.read_text().splitlines()]


class PageTest(unittest.TestCase):
    def type_all(self, page: str, how: str) -> int:
        """Types each block of a page; returns how many commands of crisp that were."""
        calls = 0
        with Reader(page, how) as reader:
            for block in reader.blocks:
                if not block.is_shell:
                    continue
                with self.subTest(f"{page}:{block.line}"):
                    ended, called = reader.types(["bash", "-e", "-u", "-o", "pipefail"], block.script)
                    calls += sum(call["words"][0] == "crisp" for call in called)
                    wrong = [call for call in called if call["status"] not in (0, 3)]
                    failures = "".join(f"{' '.join(call['words'])}\nended with {call['status']}:\n{call['output']}" for call in wrong)
                    self.assertTrue(ended.returncode == 0 and not wrong, f"{page}:{block.line}:\n{block.script}\n{failures}{ended.stderr}")
        return calls


@unittest.skipUnless(HOW == "check", "for `check`")
class Check(PageTest):
    def test_commands_of_pages_are_right(self):
        calls = sum(self.type_all(page, "check") for page in PAGES)
        self.assertGreater(calls, 50)

    def test_python_of_the_readme_runs_as_it_stands(self):
        if not PYTHONPATH:
            self.skipTest("crisp was built without its Python package")
        with Reader("README.md", "run") as reader:
            blocks = [block for block in reader.blocks if block.is_python]
            self.assertEqual(len(blocks), 1)
            ended, _ = reader.types(["/usr/bin/python3", "-B", "-"], blocks[0].text)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            self.assertTrue((reader.folder / "out/cloud.pcd").exists())

    def test_commands_in_sentences_are_there(self):
        help_of = {}

        def help_text(*command):
            if command not in help_of:
                ended = subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=False)
                help_of[command] = ended.stdout if ended.returncode == 0 else ""
            return help_of[command]

        for page in PAGES:
            for line, text in code_blocks.mentions(SOURCE / page):
                command, *words = text.split()[1:]
                if command in ("COMMAND",) or command.startswith("-"):
                    continue
                with self.subTest(f"{page}:{line}: {text}"):
                    known = help_text(command)
                    self.assertTrue(known, f"there is no command {command}")
                    if words and help_text(command, words[0]) not in ("", known):  # a command of its own below it
                        known += help_text(command, words[0])
                    for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", text):
                        self.assertRegex(known, rf"{option}\b")

    def test_no_command_is_hidden_in_another_block(self):
        for page in PAGES:
            for block in code_blocks.code_blocks(SOURCE / page):
                if not block.is_shell and block.language in ("", "text"):
                    self.assertNotRegex(block.text, r"(?m)^crisp [a-z]", f"{page}:{block.line}")


@unittest.skipUnless(HOW == "run", "for `run`")
class Run(PageTest):
    def test_commands_of_pages_run(self):
        for page in PAGES:
            self.type_all(page, "run")

    def test_python_of_pages_runs(self):
        if not PYTHONPATH:
            self.skipTest("crisp was built without its Python package")
        for page in PAGES[1:]:
            with Reader(page, "run") as reader:
                for block in reader.blocks:
                    if not block.is_python:
                        continue
                    with self.subTest(f"{page}:{block.line}"):
                        ended, _ = reader.types(["/usr/bin/python3", "-B", "-"], "import crisp\n" + block.text)
                        self.assertEqual(ended.returncode, 0, f"{block.text}\n{ended.stderr}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
