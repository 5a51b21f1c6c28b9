"""Sections of docs/performance.md that can be measured anew by themselves."""

import re

from validation.runs import Problem


def replaced(page, title, text):
    """The page with another text in the section of that title, and all else as it was."""
    start, rest = re.escape(title) + r"[^\n]*\n\n", r"(?=\n\n### )"
    if len(re.findall(f"(?m)^{start}", page)) != 1:
        raise Problem(f"the page has no section {title}")
    return re.sub(rf"(?ms)^({start}).*?{rest}", lambda match: match[1] + text, page, count=1)
