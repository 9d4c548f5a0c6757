# SPDX-License-Identifier: BSD-3-Clause
"""Code blocks of Markdown pages, and which of them are commands of a shell, or Python."""

import dataclasses
import pathlib
import re
import typing

_FENCE = re.compile(r"^ {0,3}```\s*(\S*)")
# What the first word of a line in a block without a language shows: somebody is to type it.
_TYPED = re.compile(
    r"^(\$ |(crisp|apt|apt-get|sudo|cmake|ctest|cpack|for|git|lintian|parallel|pip|python3|sbatch|source|tcpdump|\./\w+|"
    r"hidden_trial|hidden_capture|build/[\w/]+|\w+=\$\(\w+)(\s|$))"
)


@dataclasses.dataclass(frozen=True)
class Block:
    """A block of code: where it stands, its language ("" where none is named), its text without indentation."""

    page: str
    line: int
    language: str
    text: str

    @property
    def place(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def is_shell(self) -> bool:
        if self.language:
            return self.language in ("sh", "bash", "shell", "console")
        return any(_TYPED.match(line) for line in self.text.splitlines())

    @property
    def is_python(self) -> bool:
        return self.language == "python" or (not self.language and self.text.startswith("import crisp"))

    @property
    def script(self) -> str:
        """What is typed: all of it, or, where outputs are shown with it, what stands behind `$ `."""
        lines = self.text.splitlines()
        if any(line.startswith("$ ") for line in lines):
            lines = [line[2:] for line in lines if line.startswith("$ ")]
        return "\n".join(lines) + "\n"


def blocks(page: pathlib.Path, name: str) -> typing.List[Block]:
    """All code blocks of a page, fenced or indented by four blanks behind an empty line."""
    found: typing.List[Block] = []
    lines: typing.List[str] = []
    begin, language, fenced, before = 0, "", False, ""

    def end():
        text = "\n".join(lines).rstrip()
        if text:
            found.append(Block(name, begin, language, text))
        lines.clear()

    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        fence = _FENCE.match(line)
        if fence:
            end()
            fenced, language, begin = not fenced, "" if fenced else fence.group(1), number
        elif fenced:
            lines.append(line)
        elif line.startswith("    ") and (lines or not before.strip()):
            if not lines:
                begin, language = number, ""
            lines.append(line[4:])
        elif lines and not line.strip():
            lines.append("")
        else:
            end()
        before = line
    end()
    return found


def pages(root: pathlib.Path) -> typing.List[str]:
    """README.md and every page under docs/, but for the reference, which the program writes."""
    docs = sorted(str(page.relative_to(root)) for page in (root / "docs").rglob("*.md"))
    return ["README.md"] + [page for page in docs if "/reference/" not in page]


def mentions(page: pathlib.Path) -> typing.Iterator[typing.Tuple[int, str]]:
    """Commands within sentences: `crisp …`, and the line they stand in."""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        for text in re.findall(r"`(crisp [^`]+)`", line):
            yield number, text
