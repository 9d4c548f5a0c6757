# SPDX-License-Identifier: BSD-3-Clause
"""The page of all errors and warnings, made from the sources: messages_page.py SOURCE_FOLDER prints it."""

import pathlib
import sys

import messages

TITLE = """# Errors and warnings

After this page you know what each error and each warning of crisp means, and what to do about it. The page is generated
from the sources: `python3 tests/docs/messages_page.py . > docs/reference/messages.md`. The sign … stands for a name or a
number. [Troubleshooting](../how-to/troubleshoot.md) explains the messages that need more than a line, and all messages
that make a result untrusted.
"""
AREAS = (  # title, prefixes of the files
    ("Captures", ("grabbers/capture", "grabbers/wire", "pipeline/pcl", "grabbers/record")),
    ("Bags, tables, lists of telegrams, Velodyne", ("grabbers/bag", "grabbers/table", "grabbers/telegrams",
                                                    "grabbers/velodyne")),
    ("Devices", ("grabbers/live", "grabbers/emulate")),
    ("PCD files and clouds", ("grabbers/pcd", "pipeline/pcd", "plugins/write", "plugins/filter", "plugins/assemble")),
    ("Clocks", ("pipeline/clocks", "plugins/clock")),
    ("Calibration", ("pipeline/estimate", "pipeline/model", "plugins/calibrate", "plugins/watch", "plugins/cuda",
                     "pipeline/quality", "pipeline/statistics", "pipeline/data")),
    ("Diagnosis", ("plugins/diagnose", "plugins/scans")),
    ("Pipelines, rigs and other files", ("pipeline/include", "pipeline/stage", "pipeline/files", "pipeline/plot",
                                         "plugins/report")),
    ("Program, batch and cluster", ("pipeline/app", "pipeline/batch", "pipeline/python")),
    ("Simulator and studies", ("grabbers/simulate", "plugins/simulate", "plugins/study")),
)


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_").replace("[", "\\[")


def table(head, rows):
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return lines + [f"| {' | '.join(map(cell, row))} |" for row in sorted(set(rows), key=lambda row: (row[0].lower(), row))]


def page(root):
    errors, warnings = messages.errors(root), messages.warnings(root)
    lines = [TITLE]
    for title, prefixes in AREAS:
        stopped = [(message, advice or "–") for name, message, advice in errors if name.startswith(prefixes)]
        warned = [(message,) for name, message in warnings if name.startswith(prefixes)]
        if not stopped and not warned:
            continue
        lines.append(f"## {title}\n")
        if stopped:
            lines += table(("error", "what to do"), stopped) + [""]
        if warned:
            lines += table(("warning: the run goes on",), warned) + [""]
    return "\n".join(lines).rstrip() + "\n"


if __name__ == "__main__":
    sys.stdout.write(page(pathlib.Path(sys.argv[1])))
