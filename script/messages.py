#!/usr/bin/env python3
"""Writes tests/messages.txt: every message identifier with its texts, from the calls in the sources.

  script/messages.py           writes the list
  script/messages.py --check   status 1 if the list is not current

Programs and tests compare identifiers, places and values, so a text may change; the change then shows in this
list. Expressions in a text appear as {}.
"""

import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIST = ROOT / "tests/messages.txt"
IDENTIFIER = re.compile(r'"([a-z][a-z0-9_]*\.[a-z][a-z0-9_]*)"')
CALL = re.compile(r"\b(Error|Warning|Unreadable|Stop|Refuse|refuse|once_|bodiless_|short_|complain_|MessageId)\(\s*(?=\")")
KEY = re.compile(r'"[\w.]*"|fmt::format\("[^" ]*".*|.*\bat \+ "\.\w+"', re.DOTALL)
LITERAL = re.compile(r'"((?:\\.|[^"\\])*)"')


def arguments(text, at):
    """Returns the texts of the arguments of a call whose first one begins at `at`."""
    found, depth, begin, quote = [], 0, at, ""
    while at < len(text):
        char = text[at]
        if quote:
            if char == "\\":
                at += 1
            elif char == quote:
                quote = ""
        elif char == '"' or (char == "'" and not text[at - 1].isdigit()):
            quote = char
        elif char in "([{":
            depth += 1
        elif char in ")]}":
            if depth == 0:
                return [*found, text[begin:at].strip()]
            depth -= 1
        elif char == "," and depth == 0:
            found.append(text[begin:at].strip())
            begin = at + 1
        at += 1
    return []


def template(expression):
    """Returns an expression of strings as one text: literals unchanged, other terms as {}."""
    parts, at = [], 0
    for literal in LITERAL.finditer(expression):
        if re.search(r"\w", expression[at:literal.start()]):
            parts.append("{}")
        parts.append(re.sub(r"\{[^{}]*\}", "{}", literal[1]).replace('\\"', '"'))
        at = literal.end()
    if re.search(r"\w", expression[at:]):
        parts.append("{}")
    return re.sub(r"(\{\})+", "{}", "".join(parts))


def read_messages():
    messages = collections.defaultdict(set)
    sources = [path for folder in ("src", "apps", "python", "include") for path in (ROOT / folder).rglob("*")
               if path.suffix in (".cpp", ".h", ".inl")]
    for path in sorted(sources):
        text = path.read_text(encoding="utf8")
        for call in CALL.finditer(text):
            given = arguments(text, call.end())
            identifier = given and IDENTIFIER.fullmatch(given[0])
            if not identifier:
                continue
            if len(given) > 2 and (call[1] == "Error" and KEY.fullmatch(given[1])):
                del given[1]  # the key or place of a reader's own Error
            texts = [template(each) for each in given[1:] if '"' in each]
            kind = "warning" if call[1] == "Warning" else "error"
            messages[identifier[1]].add(f"{kind}: {texts[0] if texts else '{}'}" +
                                        (f" ({texts[1]})" if len(texts) > 1 else ""))
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
