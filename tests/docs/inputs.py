# SPDX-License-Identifier: BSD-3-Clause
"""What a page's reader has before the page begins, under the names that the pages use.

A page whose commands need something else fails; what its reader has is then added here.
"""

import os
import pathlib
import re
import shutil
import subprocess

_SCENE = re.compile(r"--scene-file (\S+)")  # a scene of the reader's own
_RECORDED = re.compile(r"-i ([\w.-]+\.(?:csv|json|pcapng|pcap))")  # perhaps a real scanner's


class Inputs:
    """A small recording and what runs leave of it, and of these whatever a page's reader has."""

    def __init__(self, program: str, source: pathlib.Path, folder: pathlib.Path, how: str):
        self._program = program
        made, out, results, captures = folder / "made", folder / "out", folder / "results", folder / "captures"
        self._run("run", "simulate", "-o", made, "--set", "grabber.simulate.duration=3s")
        self._run("run", "calibrate" if how == "check" else "diagnose", "-i", made / "hub.pcap", "-o", out)
        if how == "check":  # a diagnosis takes too long
            shutil.copy(source / "tests/fuzz/corpus/yaml/diagnosis.json", out)
        shutil.copytree(made, out, dirs_exist_ok=True)
        shutil.copytree(made, out / "made")
        (captures / "hall").mkdir(parents=True)
        for name in ("monday.pcap", "hall/tuesday.pcap"):
            os.link(made / "hub.pcap", captures / name)
        self._run("batch", "assemble", "-i", captures, "-o", results, "--set", f"calibration={made}/truth.yaml")
        configs, here = source / "configs", pathlib.Path(__file__).parent
        self._given = {
            "configs": configs,
            "docs": source / "docs",
            "hub.pcap": made / "hub.pcap",
            "captures": captures,
            "fleet/one/hub.pcap": made / "hub.pcap",
            "fleet/one/rig.yaml": configs / "rig.yaml",
            "out": out,
            "last/calibration.yaml": out / "calibration.yaml",
            "results": results,
            "clouds/cloud.pcd": out / "cloud.pcd",
            "cloud.pcd": out / "cloud.pcd",
            "thin.yaml": here / "thin.yaml",
            "mine.yaml": here / "mine.yaml",
            "rig.yaml": configs / "rig.yaml",
            "my.yaml": configs / "rig.yaml",
            "my_rig.yaml": configs / "rig.yaml",
            "tilt.bag": source / "tests/fuzz/corpus/bag/plain.bag",
            "my-calibration.yaml": made / "truth.yaml",
        }
        self._scene = configs / "scenes/office.yaml"
        self._real = {file.name: file for file in (source.parent / "shared/data").rglob("*.*")}

    def _run(self, *words):
        ended = subprocess.run([self._program, *map(str, words)], capture_output=True, text=True, check=False)
        if ended.returncode not in (0, 3):  # 3: done, but not to be trusted, as after so short a recording
            raise RuntimeError(f"crisp {' '.join(map(str, words))} ended with {ended.returncode}:\n{ended.stdout}{ended.stderr}")

    def give(self, folder: pathlib.Path, text: str) -> None:
        """Puts into a folder what the reader of this page has."""
        given = dict(self._given) | {name: self._scene for name in _SCENE.findall(text)}
        for name, made in given.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            if made.is_dir():
                shutil.copytree(made, folder / name)
            else:
                shutil.copy(made, folder / name)
        for name in set(_RECORDED.findall(text)) - set(given):
            if name in self._real:
                (folder / name).symlink_to(self._real[name])
            else:
                (folder / name).touch()  # shim.py runs nothing of an empty recording
