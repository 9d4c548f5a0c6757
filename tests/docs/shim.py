# SPDX-License-Identifier: BSD-3-Clause
"""Stands for `crisp`, and for programs that are not to be started, while bash runs what a page shows.

PAGES_HOW is `check` (what takes long ends where its results would be written: its command line, its pipeline and its
inputs are checked until then; results are put there from PAGES_MADE) or `run` (all of it runs, but shorter where
that would take too long). Each call is appended to PAGES_LOG as JSON: words, status, output.
"""

import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

# Commands that compute for long, and where they write if nothing else is said.
LONG = {
    "run": "out",
    "calibrate": "out/calibrate",
    "diagnose": "out/diagnose",
    "batch": "out",
    "record": "out",
    "emulate": "out/emulate",
    "bound": "out/bound",
    "detection": "out/detection",
    "basin": "out/basin",
    "monte-carlo": "out/monte_carlo",
    "figures": "out/figures",
}
VERBS = ("status", "table", "retry")
SECONDS = 8  # after which what ends by Ctrl-C alone gets it


def command_of(words):
    """The command's own name: of `study bound` it is bound."""
    return next((word for word in words if word != "study"), "")


def place_of(words, names):
    """Where the value stands of an option that has these names; None without it."""
    return next((i + 1 for i, word in enumerate(words[:-1]) if word in names), None)


def with_value(words, names, value):
    """The words with another value of the option, which is added if it is not there."""
    at = place_of(words, names)
    return [*words, names[0], value] if at is None else [*words[:at], value, *words[at + 1 :]]


def call(words, seconds=None):
    """Status and output of the program; what runs for longer than so many seconds gets Ctrl-C then."""
    with subprocess.Popen(
        [os.environ["PAGES_PROGRAM"], *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            out, error = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
            out, error = process.communicate()
    return process.returncode, out, error


def check(words):
    command = command_of(words)
    if command == "cluster":
        return call([*words, "--dry-run"])
    if command not in LONG or words[1:2] and words[1] in VERBS:
        return call(words)
    output = ("-o", "--output")
    status, out, error = call(with_value(words, output, "/dev/null/none"))
    if status != 2 or "cannot write into the folder /dev/null/none" not in error:
        return status or 1, out, error
    at = place_of(words, output)
    made = os.path.join(os.environ["PAGES_MADE"], "results" if command == "batch" else "out")
    shutil.copytree(made, LONG[command] if at is None else words[at], dirs_exist_ok=True)
    return 0, out, ""


def shorter(words):
    """The same command on less: as it stands on the page it would take minutes to days."""
    command, text = command_of(words), " ".join(words)
    if command in ("monte-carlo", "basin"):
        if "--only" not in words:
            words = with_value(words, ("-n", "--runs", "--starts"), "1")
        if "--shard" in words:
            words = with_value(words, ("--shard",), "1/1")
    elif command in ("bound", "detection"):
        words = with_value(words, ("--duration",), "1s")
    elif command == "run" and ("simulate" in words[1] or "like_real" in words[1]) and "duration" not in text:
        # Lasers that see one side need more turns.
        seconds = "10s" if "first_angle" in text else "3s"
        words = [*words, "--set", f"grabber.simulate.duration={seconds}"]
    elif command == "cluster":  # tests/cluster submits
        words = [*words, "--dry-run"]
    return words


def once(words):
    """Status and output of the program. What another page has run on the same files is put there from that run."""
    output = place_of(words, ("-o", "--output"))
    command = command_of(words)
    folder = words[output] if output is not None else LONG.get(command)
    if command not in LONG or command == "batch" or folder is None:  # a batch's manifest belongs to its folder
        return call(words)
    files = [hashlib.sha256(pathlib.Path(word).read_bytes()).hexdigest() for word in words if os.path.isfile(word)]
    key = hashlib.sha256(json.dumps([words, files]).encode()).hexdigest()
    kept = pathlib.Path(os.environ["PAGES_MADE"], "kept", key)
    if kept.exists():
        shutil.copytree(kept, folder, dirs_exist_ok=True)
        return 0, "", ""
    ended = call(words)
    if ended[0] in (0, 3) and os.path.isdir(folder):
        shutil.copytree(folder, kept)
    return ended


def run(words):
    command = command_of(words)
    if command == "emulate":  # the page's other terminal
        emulate(words)
        return 0, "", ""
    if command == "record" or (command == "run" and "live" in words[1]):  # of a scanner that is there
        if not os.path.exists(os.environ["PAGES_EMULATORS"]):
            emulate(["emulate"])
        words = with_value(words, ("--rig",), "configs/loopback.yaml")
        if command == "record":  # the reader's folder holds a simulated capture, which is not continued
            words = with_value(words, ("-o", "--output"), "recorded")
        return call(words, SECONDS)
    if "from-bag.yaml" in words:  # the bag at hand has other topics than the page's
        return check(words)
    at = place_of(words, ("-i", "--input"))
    if at is not None and os.path.isfile(words[at]) and os.path.getsize(words[at]) == 0:
        return check(words)  # a real recording, which is not here
    return once(shorter(words))


def emulate(words):
    """Starts an emulated scanner, which the test ends."""
    nothing = subprocess.DEVNULL
    process = subprocess.Popen([os.environ["PAGES_PROGRAM"], *words], stdin=nothing, stdout=nothing, stderr=nothing)
    with open(os.environ["PAGES_EMULATORS"], "a", encoding="utf-8") as pids:
        pids.write(f"{process.pid}\n")
    time.sleep(1)


def preset(words):
    """cmake, ctest: whether there is such a preset."""
    at = place_of(words, ("--preset",))
    presets = pathlib.Path(os.environ["PAGES_SOURCE"], "CMakePresets.json").read_text(encoding="utf-8")
    if at is not None and f'"name": "{words[at]}"' not in presets:
        return 1, "", f"there is no preset {words[at]}\n"
    return 0, "", ""


def parallel(words):
    """GNU parallel: the first of the commands that it would start."""
    command = words[words.index("crisp") + 1 : words.index(":::")]
    return crisp([word.replace("{}", words[words.index(":::") + 1]) for word in command])


def sbatch(words):
    """Slurm: what its task does; prints the number of a job, as sbatch --parsable."""
    at = next(i for i, word in enumerate(words) if word.endswith(".sbatch"))
    table = ["batch", "table"] if "merge" in words[at] else ["batch"]
    status, _, error = crisp(table + words[at + 1 :])
    return status, "1\n", error


def nothing(_):
    return 0, "", ""


def crisp(words):
    """A table's status is that of its batch: 1 where recordings are due, as after one of several parts."""
    status, out, error = outcome(words)
    is_table = command_of(words) == "batch" and "table" in words[1:2]
    return (0 if is_table and status == 1 else status), out, error


def outcome(words):
    if "--plugin" in words:  # tests/installed runs the example's
        return 0, "", ""
    return {"check": check, "run": run}[os.environ["PAGES_HOW"]](words)


# What is not started: why, and what is done in its place.
STUBS = {
    "demo": ("builds crisp and runs for minutes", nothing),
    "check": ("builds crisp and runs for minutes", lambda words: (int(words not in ([], ["deep"], ["all"])), "", "")),
    "cmake": ("builds crisp", preset),
    "ctest": ("runs all tests", preset),
    "gnuplot": ("may be missing", nothing),
    "parallel": ("may be missing", parallel),
    "sbatch": ("needs Slurm; tests/cluster has one", sbatch),
    "install": ("installs packages", nothing),
    "mkdocs": ("serves for ever; docs.site builds the site", nothing),
    "python3": ("is given a script of the sources", nothing),
    "apt": ("installs packages; tests/package does it", nothing),
    "apt-get": ("installs packages; tests/package does it", nothing),
    "hidden_trial": ("a trial of hours", nothing),
    "faults_test": ("runs for half an hour", nothing),
    "rig_trial": ("a trial of hours", nothing),
}


def main():
    name, words = sys.argv[1], sys.argv[2:]
    status, out, error = crisp(words) if name == "crisp" else STUBS[name][1](words)
    with open(os.environ["PAGES_LOG"], "a", encoding="utf-8") as log:
        log.write(json.dumps({"words": [name, *words], "status": status, "output": out + error}) + "\n")
    sys.stdout.write(out)
    sys.stderr.write(error)
    return 0 if status == 3 else status  # 3: done, but not to be trusted, as after so short a recording


if __name__ == "__main__":
    sys.exit(main())
