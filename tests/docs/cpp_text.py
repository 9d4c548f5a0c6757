# SPDX-License-Identifier: BSD-3-Clause
"""Texts of messages in C++ sources: the string literals of a call's arguments, with … where a value stands."""

import re

TOKEN = re.compile(
    r'(?P<comment>//[^\n]*|/\*.*?\*/)|R"(?P<mark>[^(\s]*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:[^"\\\n]|\\.)*)"'
    r"|(?P<char>'(?:[^'\\\n]|\\.)+')|(?P<name>[A-Za-z_]\w*)|(?P<number>\d[\w.']*)|(?P<sign>\S)",
    re.S)
ESCAPES = {"n": "\n", "t": "\t", '"': '"', "\\": "\\", "r": "\r", "'": "'", "0": "\0"}
VALUE = "…"


def tokens(source):
    """List of (kind, text): text (a literal, as it prints), name or sign."""
    found = []
    for match in TOKEN.finditer(source):
        kind = match.lastgroup
        if kind == "comment":
            continue
        if kind in ("raw", "mark"):
            found.append(("text", match["raw"]))
        elif kind == "text":
            found.append(("text", re.sub(r"\\(.)", lambda m: ESCAPES.get(m[1], m[0]), match["text"])))
        else:
            found.append(("name" if kind == "name" else "sign", match[0]))
    return found


def arguments(found, opening):
    """The tokens of each argument of a call whose opening bracket is found[opening]."""
    depth = 0
    result = [[]]
    for token in found[opening:]:
        if token[0] == "sign" and token[1] in "([{":
            depth += 1
            if depth == 1:
                continue
        if token[0] == "sign" and token[1] in ")]}":
            depth -= 1
            if depth == 0:
                break
        if depth == 1 and token == ("sign", ","):
            result.append([])
        else:
            result[-1].append(token)
    return [argument for argument in result if argument]


def calls(found, names):
    """The arguments of each call of one of these functions, also of those that a member or an object gets."""
    for i in range(len(found) - 1):
        if found[i][0] == "name" and found[i][1] in names and found[i + 1][1] in "({" and found[i + 1][0] == "sign":
            yield arguments(found, i + 1)


def brackets(found):
    """(name, position, position after its closing bracket) of each name with an opening bracket behind it."""
    for i in range(len(found) - 1):
        if found[i][0] != "name" or found[i + 1] != ("sign", "("):
            continue
        depth = 0
        for end in range(i + 1, len(found)):
            depth += (found[end] == ("sign", "(")) - (found[end] == ("sign", ")"))
            if depth == 0:
                yield found[i][1], i, end + 1
                break


def defined_functions(found):
    """Names of the functions whose bodies follow, members included."""
    return {name for name, _, end in brackets(found)
            if [text for _, text in found[end:end + 2] if text != "const"][:1] == ["{"]}


def called_functions(found):
    """Names of the functions that are called, or declared, but of no object."""
    return {name for name, at, _ in brackets(found) if at == 0 or found[at - 1][1] not in (".", ">")}


def alternatives(argument):
    """An argument `c ? a : b` as a and b, any other as itself."""
    depth = 0
    question = colon = None
    for i, (kind, text) in enumerate(argument):
        if kind == "sign" and text in "([{":
            depth += 1
        elif kind == "sign" and text in ")]}":
            depth -= 1
        elif kind == "sign" and depth == 0 and text == "?" and question is None:
            question = i
        elif kind == "sign" and depth == 0 and text == ":" and question is not None and colon is None:
            if argument[i - 1][1] != ":" and argument[i + 1][1] != ":":
                colon = i
    if question is None or colon is None:
        return [argument]
    return alternatives(argument[question + 1:colon]) + alternatives(argument[colon + 1:])


def text_of(argument):
    """What a text's expression prints: literals as they are, VALUE for anything else, fmt::format's braces too."""
    parts = []
    i = 0
    while i < len(argument):
        kind, text = argument[i]
        if kind == "name" and text == "format" and i + 1 < len(argument) and argument[i + 1][1] == "(":
            given = arguments(argument, i + 1)
            literal = "".join(text for kind, text in given[0] if kind == "text") if given else ""
            literal = literal.replace("{{", "\0").replace("}}", "\1")
            parts.append(re.sub(r"\{[^{}]*\}", VALUE, literal).replace("\0", "{").replace("\1", "}"))
            depth = 0
            for i in range(i + 1, len(argument)):
                depth += (argument[i][1] in "(") - (argument[i][1] in ")") if argument[i][0] == "sign" else 0
                if depth == 0:
                    break
        elif kind == "text":
            parts.append(text)
        elif kind == "name" and text not in ("std", "string", "move", "fmt"):
            parts.append(VALUE)
        i += 1
    text = re.sub(r"\s+", " ", "".join(parts))
    return re.sub(f"({VALUE} ?)+{VALUE}", VALUE, text).strip()


def texts_of(argument):
    return [text for text in map(text_of, alternatives(argument)) if text]
