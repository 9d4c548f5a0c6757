# SPDX-License-Identifier: BSD-3-Clause
"""Code blocks of Markdown pages, and which of them are commands of a shell, or Python."""

import dataclasses
import pathlib
import re
import textwrap
import typing

import markdown

_FENCE = re.compile(r"\s*(?:```+|~~~+)\s*(\S*)")
# The first word of a line in a block without a language that shows commands to type.
_TYPED = re.compile(
    r"^(\$ |(crisp|apt|apt-get|sudo|cmake|ctest|cpack|for|git|lintian|parallel|pip|python3|sbatch|source|tcpdump|\./\w+|"
    r"hidden_trial|hidden_capture|build/[\w/]+|\w+=\$\(\w+)(\s|$))"
)


@dataclasses.dataclass(frozen=True)
class CodeBlock:
    """A block of code: its line, its language ("" where none is named), its text without indentation."""

    page: pathlib.Path
    line: int
    language: str
    text: str

    @property
    def is_shell(self) -> bool:
        if self.language:
            return self.language in ("sh", "bash", "shell", "console")
        return any(_TYPED.match(line) for line in self.text.splitlines())

    @property
    def is_python(self) -> bool:
        return self.language == "python" or (not self.language and self.text.startswith("import crisp"))

    @property
    def file(self) -> typing.Optional[str]:
        """The file that it shows as a whole, if its first line is `crisp: 1  # NAME.yaml`."""
        found = re.match(r"crisp: 1 +# ([\w-]+\.yaml)\n", self.text)
        return found and found[1]

    @property
    def script(self) -> str:
        """What is typed: all of it, or, where outputs are shown with it, what follows `$ `."""
        lines = self.text.splitlines()
        if any(line.startswith("$ ") for line in lines):
            lines = [line[2:] for line in lines if line.startswith("$ ")]
        return "\n".join(lines) + "\n"


def code_blocks(page: pathlib.Path) -> typing.List[CodeBlock]:
    """All code blocks of a page, fenced or indented by four blanks; what an empty line parts is one indented block."""
    found: typing.List[CodeBlock] = []
    joins = False  # the block before is indented code, too
    for block in markdown.blocks(page.read_text(encoding="utf-8")):
        if block.kind != "code":
            joins = False
            continue
        fence = _FENCE.match(block.lines[0])
        lines = [line for line in block.lines if not _FENCE.match(line)] if fence else block.lines
        text = textwrap.dedent("\n".join(lines)).rstrip() + "\n"
        if joins and not fence:
            before = found.pop()
            found.append(dataclasses.replace(before, text=f"{before.text}\n{text}"))
        else:
            found.append(CodeBlock(page, block.line, fence.group(1) if fence else "", text))
        joins = not fence
    return found


def mentions(page: pathlib.Path) -> typing.Iterator[typing.Tuple[int, str]]:
    """Commands within sentences: `crisp …`, and the line they stand in."""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        for text in re.findall(r"`(crisp [^`]+)`", line):
            yield number, text
