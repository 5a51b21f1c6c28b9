"""Sections of docs/performance.md that can be updated separately."""

import re

from validation.runs import Problem


def replaced(page, title, text):
    """Returns the page with the text of the section of this title replaced."""
    start, rest = re.escape(title) + r"[^\n]*\n\n", r"(?=\n\n### )"
    if len(re.findall(f"(?m)^{start}", page)) != 1:
        raise Problem(f"the page has no section {title}")
    return re.sub(rf"(?ms)^({start}).*?{rest}", lambda match: match[1] + text, page, count=1)
