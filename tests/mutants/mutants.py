#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Mutation testing: does a test notice when a comparison, a sign or a condition of the product is flipped?

Draws mutants at random over pipeline, grabbers and plugins, builds each in a copy of the tree, and runs the quick
tests: those of the mutant's folder first, then all. A mutant that every test passes has survived: a test is missing,
or the line is.

  tests/mutants/mutants.py WORK --count 150 --seed 1

WORK is a folder outside the tree: a clone of it, its build, and mutants.json with one result per mutant, from which a
run that was interrupted goes on. Exit status 1 where more than one mutant in twenty survived.
"""

import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import time

TREE = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("pipeline", "grabbers", "plugins")
# Operators with blanks on both sides: neither templates nor references have these.
FLIPS = {" < ": " >= ", " > ": " <= ", " <= ": " > ", " >= ": " < ", " == ": " != ", " != ": " == ",
         " + ": " - ", " - ": " + ", " * ": " / ", " += ": " -= ", " -= ": " += ", " && ": " || ", " || ": " && "}
OPERATOR = re.compile("|".join(re.escape(one) for one in sorted(FLIPS, key=len, reverse=True)))
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^\s*#[^\n]*', re.DOTALL | re.MULTILINE)
BUILD_SECONDS = 1200
TEST_SECONDS = 900


def sites(text):
    """Places of operators in code, as (begin, end)."""
    hidden = [(m.start(), m.end()) for m in NO_CODE.finditer(text)]
    code = list(text)
    for begin, end in hidden:
        code[begin:end] = "\0" * (end - begin)
    return [(m.start(), m.end()) for m in OPERATOR.finditer("".join(code))]


def draw(clone, count, seed):
    """`count` mutants (file, begin, end), each site as likely as any other."""
    every = []
    for folder in FOLDERS:
        for file in sorted((clone / folder).rglob("*.cpp")) + sorted((clone / folder).rglob("*.hpp")):
            name = file.relative_to(clone).as_posix()
            every += [(name, begin, end) for begin, end in sites(file.read_text(encoding="utf-8"))]
    return random.Random(seed).sample(every, min(count, len(every)))


def run(command, clone, seconds):
    """Whether it succeeded; a command that takes too long did not."""
    try:
        done = subprocess.run(command, cwd=clone, timeout=seconds, stdin=subprocess.DEVNULL, check=False,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def build(clone, targets=("crisp", "all_tests")):
    return run(["ninja", "-C", "build/release", *targets], clone, BUILD_SECONDS)


def tests_of_folder(clone, file):
    """Names of the test programs whose sources are in the folder that mirrors the mutant's."""
    folder = clone / "tests" / pathlib.PurePosixPath(file).parent
    while not (folder / "CMakeLists.txt").exists() and folder != clone / "tests":
        folder = folder.parent
    lists = (folder / "CMakeLists.txt").read_text(encoding="utf-8") if (folder / "CMakeLists.txt").exists() else ""
    return re.findall(r"crisp_test\((\w+)", lists)


def verdict(clone, file):
    near = tests_of_folder(clone, file)
    ctest = ["ctest", "--preset", "quick", "--stop-on-failure", "-j", "2"]
    if near:
        if not build(clone, ["crisp", *(name + "_test" for name in near)]):
            return "does not compile"
        if not run(ctest + ["-R", "^(" + "|".join(near) + ")$"], clone, TEST_SECONDS):
            return "killed by its folder's tests"
    if not build(clone):
        return "does not compile"
    return "survived" if run(ctest, clone, TEST_SECONDS) else "killed"


def prepare(work):
    clone = work / "tree"
    if not clone.exists():
        subprocess.run(["git", "clone", "--quiet", str(TREE), str(clone)], check=True)
    subprocess.run(["git", "checkout", "--quiet", "--", "."], cwd=clone, check=True)
    # Programs of tests need not be linked again where only a library changes.
    subprocess.run([".ci/step", "configure", "release", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON"], cwd=clone, check=True)
    if not build(clone) or not run(["ctest", "--preset", "quick", "-j", "2"], clone, 4 * TEST_SECONDS):
        sys.exit("the tree itself does not build, or its tests fail: nothing can be learned from mutants of it")
    return clone


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    if work == TREE or TREE in work.parents:
        sys.exit(f"{work} is inside the tree: name a folder outside")
    work.mkdir(parents=True, exist_ok=True)
    results_file = work / "mutants.json"
    results = json.loads(results_file.read_text(encoding="utf-8")) if results_file.exists() else {}
    clone = prepare(work)
    for file, begin, end in draw(clone, arguments.count, arguments.seed):
        text = (clone / file).read_text(encoding="utf-8")
        line = text.count("\n", 0, begin) + 1
        operator = text[begin:end]
        name = f"{file}:{line}: {operator.strip()} to {FLIPS[operator].strip()} at {begin}"
        if name in results:
            continue
        began = time.monotonic()
        (clone / file).write_text(text[:begin] + FLIPS[operator] + text[end:], encoding="utf-8")
        try:
            results[name] = verdict(clone, file)
        finally:
            (clone / file).write_text(text, encoding="utf-8")
        results_file.write_text(json.dumps(results, indent=1), encoding="utf-8")
        print(f"{results[name]:>30}  {time.monotonic() - began:5.0f} s  {name}", flush=True)
    judged = [one for one in results.values() if one != "does not compile"]
    survived = judged.count("survived")
    print(f"{len(judged)} mutants, {survived} survived")
    sys.exit(1 if survived * 20 > len(judged) else 0)


if __name__ == "__main__":
    main()
