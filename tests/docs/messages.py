# SPDX-License-Identifier: BSD-3-Clause
"""What the sources have crisp print: its errors, its warnings, and the caveats that make a result untrusted."""

import functools
import re

import cpp_text
from cpp_text import VALUE

FOLDERS = ("grabbers", "pipeline", "plugins")
MARKS = {"distrust", "mark_untrusted"}  # Context's: the run ends with exit status 3
DECLARES_MARKS = "pipeline/include/crisp/context.hpp"
INTERNAL = ": an error of this program"  # what internal_error() appends, with the advice
REPORT = "please report it with the command and its input"
LISTS = {"caveats", "other_minima"}

# Functions here return caveats, which other files mark: each sentence in them is one.
MAKERS = (
    "grabbers/capture/loss_warnings.cpp",
    "pipeline/estimate/surfel_refinement.cpp",
    "pipeline/estimate/surfel_refiner_covariance.cpp",
    "pipeline/estimate/scene_repeat.cpp",
    "pipeline/estimate/view_consistency.cpp",
    "plugins/calibrate/fit_check.cpp",
    "plugins/calibrate/rig_check.cpp",
    "plugins/calibrate/rig_hypotheses.cpp",
    "plugins/calibrate/rig_mistakes.cpp",
    "plugins/calibrate/rqe_calibration.cpp",
    "plugins/clock/alignment_report.cpp",
    "plugins/diagnose/clocks/clocks_stage.cpp",
)
# How often each other file marks a result with a text that it gets from one of these.
RELAYS = {
    "grabbers/capture/capture_stage.cpp": 3,
    "grabbers/live/live_stage.cpp": 1,
    "grabbers/telegrams/telegrams_stage.cpp": 1,
    "pipeline/estimate/surfel_refiner.cpp": 1,
    "plugins/calibrate/refine_stage.cpp": 4,
    "plugins/calibrate/rqe_stage.cpp": 5,
    "plugins/clock/clock_stages.cpp": 1,
    "plugins/diagnose/model/model_stage.cpp": 1,
}


@functools.cache
def sources(root):
    """(file, its tokens) of each source; a file is parsed once, however many functions here search it."""
    return [(str(path.relative_to(root)), cpp_text.tokens(path.read_text(encoding="utf-8")))
            for folder in FOLDERS for path in sorted((root / folder).rglob("*.[ch]pp"))]


def is_message(text):
    return len(re.findall(r"[A-Za-z]{2,}", text)) >= 2


def errors(root):
    """(file, message, advice) of each Error."""
    found = []
    for name, tokens in sources(root):
        for given in cpp_text.calls(tokens, {"Error"}):
            advice = " / ".join(cpp_text.texts_of(given[1])) if len(given) > 1 else ""
            found += [(name, text, advice) for text in cpp_text.texts_of(given[0]) if is_message(text)] if given else []
        for given in cpp_text.calls(tokens, {"internal_error"}):
            found += [(name, text + INTERNAL, REPORT) for text in cpp_text.texts_of(given[0]) if is_message(text)]
    return found


def warnings(root):
    """(file, message) of each warning."""
    found = []
    for name, tokens in sources(root):
        given = list(cpp_text.calls(tokens, {"warn"})) + list(added_to(tokens, {"warnings"}))
        found += [(name, text) for arguments in given if arguments for text in cpp_text.texts_of(arguments[0])
                  if is_message(text)]
    return found


def texts_or_initial(argument, tokens):
    """The texts of an argument; of a variable those that the file initialises it by."""
    names = [token for token in argument if token[0] == "name" and token[1] not in ("std", "move")]
    if len(names) != 1 or any(token[0] == "text" for token in argument):
        return cpp_text.texts_of(argument)
    for i in range(len(tokens) - 1):
        if tokens[i][1] == names[0][1] and tokens[i + 1][1] == "=":
            end = next(k for k in range(i, len(tokens)) if tokens[k][1] == ";")
            return cpp_text.texts_of(tokens[i + 2:end])
    return []


def added_to(tokens, lists):
    """Arguments of push_back() and emplace_back() of a list of one of these names, also of `(a ? x.b : y.list)`."""
    for i in range(2, len(tokens) - 1):
        if tokens[i][1] not in ("push_back", "emplace_back") or tokens[i - 1][1] != ".":
            continue
        start = i - 2
        if tokens[start][1] == ")":
            depth = 0
            while start > 0:
                depth += (tokens[start][1] == ")") - (tokens[start][1] == "(")
                if depth == 0:
                    break
                start -= 1
        if lists & {text for kind, text in tokens[start:i - 1] if kind == "name"}:
            yield cpp_text.arguments(tokens, i + 1)


def sentences(tokens):
    """Every text of ten words and more, but those of an Error, of a warning and of a stage's description."""
    others = {"Error", "warn", "say", "print", "option", "details", "summary", "count", "progress"}
    given = list(cpp_text.calls(tokens, others)) + list(added_to(tokens, {"warnings"}))
    skipped = {id(token) for arguments in given for argument in arguments for token in argument}
    found = []
    i = 0
    while i < len(tokens):
        if tokens[i][0] != "text" or id(tokens[i]) in skipped:
            i += 1
            continue
        text = ""
        while i < len(tokens) and tokens[i][0] == "text":
            text += tokens[i][1]
            i += 1
        text = re.sub(r"\s+", " ", re.sub(r"\{[^{}]*\}", VALUE, text)).strip()
        if len(re.findall(r"[A-Za-z]+", text)) >= 10:
            found.append(text)
    return found


@functools.cache
def caveats(root, makers=MAKERS):
    """(file, message) of each caveat, and how often each file relays one that is made elsewhere."""
    found = []
    relays = {}
    for name, tokens in sources(root):
        if name == DECLARES_MARKS:
            continue
        given = list(cpp_text.calls(tokens, MARKS)) + list(added_to(tokens, LISTS))
        for arguments in given:
            texts = [text for text in (texts_or_initial(arguments[0], tokens) if arguments else []) if is_message(text)]
            found += [(name, text) for text in texts]
            if not texts and name not in makers:
                relays[name] = relays.get(name, 0) + 1
        if name in makers:
            found += [(name, text) for text in sentences(tokens)]
    return sorted(set(found)), relays


def missing_makers(root, makers=MAKERS):
    """(file, function) of each function of a caveat, by its name, that a file of caveats calls from elsewhere."""
    found, relays = caveats(root, makers)
    of_caveats = {name for name, _ in found} | set(relays)
    called = {function for name, tokens in sources(root) if name in of_caveats
              for function in cpp_text.called_functions(tokens) - cpp_text.defined_functions(tokens)
              if "caveat" in function}
    return sorted((name, function) for name, tokens in sources(root) if name not in of_caveats
                  for function in cpp_text.defined_functions(tokens) & called)
