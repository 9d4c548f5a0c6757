# SPDX-License-Identifier: BSD-3-Clause
"""What a page in Markdown consists of: paragraphs, headings, links."""

import dataclasses
import re


@dataclasses.dataclass
class Block:
    kind: str  # "heading", "paragraph", "item", "table", "code", "html"
    line: int
    lines: list

    def text(self):
        return " ".join(line.strip() for line in self.lines)


def blocks(text):
    found = []
    fence = None
    after_blank = True
    in_list = False
    for number, line in enumerate(text.split("\n"), 1):
        stripped = line.strip()
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence or mark:
            if fence and mark and mark[1].startswith(fence):
                fence = None
            elif not fence:
                fence = mark[1]
            kind = "code"
        elif not stripped:
            after_blank = True
            continue
        elif line.startswith("    ") and (after_blank or found and found[-1].kind == "code") and not in_list:
            kind = "code"
        elif re.match(r"#+ ", line):
            kind = "heading"
        elif stripped.startswith("|"):
            kind = "table"
        elif stripped.startswith("<"):
            kind = "html"
        elif re.match(r"\s*([-*+]|\d+[.)]) ", line):
            kind = "item"
        elif in_list and line.startswith("  "):
            kind = "item"
        else:
            kind = "paragraph"
        starts = kind == "heading" or (kind == "item" and re.match(r"\s*([-*+]|\d+[.)]) ", line))
        if kind in ("paragraph",) and not after_blank and found and found[-1].kind == "item":
            kind = "item"
        in_list = kind == "item" or (in_list and kind in ("code", "table") and line.startswith("  "))
        if found and found[-1].kind == kind and not after_blank and not starts:
            found[-1].lines.append(line)
        else:
            found.append(Block(kind, number, [line]))
        after_blank = False
    return found


def without_code(text):
    return re.sub(r"(`+)(?!`).+?(?<!`)\1(?!`)", "", text)


def links(page_blocks):
    """(line, target) of each link and picture."""
    for block in page_blocks:
        if block.kind == "code":
            continue
        for match in re.finditer(r"\]\(\s*<?([^()\s>]+(?:\([^()\s]*\))?)>?(?:\s+\"[^\"]*\")?\)", without_code(block.text())):
            yield block.line, match[1]


def anchors(page_blocks):
    """What `#…` of a link may name, as GitHub and the site make it of headings."""
    found = {}
    for block in page_blocks:
        if block.kind != "heading":
            continue
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"^#+ ", "", block.lines[0]).strip())
        slug = re.sub(r"[^\w\- ]", "", title.lower().replace("`", "")).replace(" ", "-")
        count = found.get(slug, 0)
        found[slug] = count + 1
        if count:
            found[f"{slug}-{count}"] = 1
    return set(found)
