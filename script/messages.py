#!/usr/bin/env python3
"""Writes tests/messages.txt: every message identifier with its texts, from the calls in the sources.

  script/messages.py           writes the list
  script/messages.py --check   status 1 if the list is not current

Programs and tests compare identifiers, places and values, so a text may change; the change then shows in this
list. Expressions in a text appear as {}. A text that depends on conditions (a ? b : c) appears once for each.
"""

import collections
import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = ROOT / "tests/messages.txt"
IDENTIFIER = re.compile(r'"([a-z][a-z0-9_]*\.[a-z][a-z0-9_]*)"')
CALL = re.compile(r"\b(Error|Warning|Unreadable|Stop|Refuse|refuse|once_|bodiless_|short_|complain_|MessageId)\(\s*(?=\")")
KEY = re.compile(r'"[\w.]*"|fmt::format\("[^" ]*".*|.*\bat \+ "\.\w+"', re.DOTALL)
LITERAL = re.compile(r'"((?:\\.|[^"\\])*)"')
CHARACTER = re.compile(r"'(\\?.)'")


def outside(text, at=0):
    """Yields places and characters of code outside of literals, with the depth of their brackets."""
    depth, quote = 0, ""
    while at < len(text):
        char = text[at]
        if quote:
            if char == "\\":
                at += 1
            elif char == quote:
                quote = ""
        elif char == '"' or (char == "'" and not text[at - 1].isdigit()):
            quote = char
        else:
            depth -= char in ")]}"
            yield at, char, depth
            depth += char in "([{"
        at += 1


def arguments(text, at):
    """Returns the texts of the arguments of a call whose first one begins at `at`."""
    found, begin = [], at
    for place, char, depth in outside(text, at):
        if depth < 0:
            return [*found, text[begin:place].strip()]
        if char == "," and depth == 0:
            found.append(text[begin:place].strip())
            begin = place + 1
    return []


def conditional(expression):
    """Returns condition and both values of `a ? b : c`; None for other expressions."""
    question, nested = None, 0
    for at, char, depth in outside(expression):
        if depth != 0:
            continue
        if char == "?":
            question, nested = (at if question is None else question), nested + 1
        elif char == ":" and question is not None and ":" not in (expression[at - 1], expression[at + 1]):
            nested -= 1
            if nested == 0:
                return expression[:question].strip(), expression[question + 1:at], expression[at + 1:]
    return None


def terms(expression):
    """Returns the terms of a sum."""
    found, begin = [], 0
    for at, char, depth in outside(expression):
        if char == "+" and depth == 0:
            found.append(expression[begin:at])
            begin = at + 1
    return [*found, expression[begin:]]


def both(lefts, rights):
    """Joins texts whose conditions agree."""
    return [(left | right, before + after) for left, before in lefts for right, after in rights
            if all(left.get(condition, value) == value for condition, value in right.items())]


def with_conditions(expression):
    """Returns the texts of an expression of strings, each with the values of its conditions. Literals are unchanged, terms
    of other kinds are {}."""
    expression = expression.strip()
    if parts := conditional(expression):
        condition, yes, no = parts
        return [(known | {condition: value}, text) for value, branch in ((True, yes), (False, no))
                for known, text in with_conditions(branch) if known.get(condition, value) == value]
    if len(parts := terms(expression)) > 1:
        return functools.reduce(both, map(with_conditions, parts))
    if re.fullmatch(rf"(?:{LITERAL.pattern}\s*)+", expression):
        return [({}, "".join(LITERAL.findall(expression)).replace('\\"', '"'))]
    if character := CHARACTER.fullmatch(expression):
        return [({}, character[1][-1])]
    call = re.match(r"(?:fmt::format|std::string|std::string_view)?\(", expression)
    given = arguments(expression, call.end()) if call else []
    if not given or sum(map(len, given)) + len(call[0]) < len(re.sub(r"\s*,\s*", "", expression)) - 1 or not given[0]:
        return [({}, "{}")]
    if "format" not in call[0]:
        return with_conditions(given[0])
    values = [with_conditions(each) for each in given[1:]]
    texts = []
    for known, text in with_conditions(given[0]):
        pieces = re.split(r"\{(?!\{)([^{}]*)\}", text)  # text, field, text, field ...
        whole = [(known, pieces[0])]
        for number, (field, after) in enumerate(zip(pieces[1::2], pieces[2::2])):
            place = int(field.split(":")[0]) if field[:1].isdigit() else number
            whole = both(whole, values[place] if place < len(values) else [({}, "{}")])
            whole = both(whole, [({}, after)])
        texts += whole
    return texts


def templates(text, hint):
    """Returns all texts of a message, each with its hint in parentheses. `hint` may be empty."""
    found = both(with_conditions(text), [({}, "\0")])
    if hint:
        found = both(found, with_conditions(hint))
    texts = set()
    for _, whole in found:
        message, _, remedy = whole.partition("\0")
        texts.add(re.sub(r"(\{\})+", "{}", message + (f" ({remedy})" if remedy else "")))
    return texts


def read_messages():
    messages = collections.defaultdict(set)
    sources = [path for folder in ("src", "apps", "python", "include") for path in (ROOT / folder).rglob("*")
               if path.suffix in (".cpp", ".h", ".inl")]
    for path in sorted(sources):
        text = path.read_text(encoding="utf8")
        has_columns = "Error(MessageId id, int line, int column," in text
        for call in CALL.finditer(text):
            given = arguments(text, call.end())
            identifier = given and IDENTIFIER.fullmatch(given[0])
            if not identifier:
                continue
            if len(given) > 2 and call[1] == "Error" and (
                    KEY.fullmatch(given[1]) or all(re.fullmatch(r"[\w.]+", text) for text in templates(given[1], ""))):
                del given[1]  # the key or place of a reader's own Error
            if has_columns and call[1] == "Error":
                del given[1]
            if len(given) > 2 and not any(re.search(r"\w", text) for text in templates(given[1], "")):
                message, hint = [*given[2:], ""][:2]  # after a place, such as a key of the file
            else:
                message, hint = [*(each for each in given[1:] if '"' in each), "value", ""][:2]
                hint = "" if message == "value" or hint == "value" else hint
            kind = "warning" if call[1] == "Warning" else "error"
            messages[identifier[1]].update(f"{kind}: {each}" for each in templates(message, hint))
    return messages


def main():
    lines = ["# Every message identifier with its texts. Written by script/messages.py; {}: a value."]
    for identifier, texts in sorted(read_messages().items()):
        lines += [identifier, *(f"    {text}".rstrip() for text in sorted(texts))]
    text = "\n".join(lines) + "\n"
    if sys.argv[1:] == ["--check"]:
        if not LIST.is_file() or LIST.read_text(encoding="utf8") != text:
            sys.exit("tests/messages.txt is not current: script/messages.py writes it")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        LIST.write_text(text, encoding="utf8")


if __name__ == "__main__":
    main()
