#!/usr/bin/env python3
"""Lists the results in a file of ctest (--output-junit): status, name and, for skipped tests, the reason.

  script/test_results.py FILE      one line per test: STATUS<tab>NAME<tab>REASON

STATUS is run, fail, skipped, or missing: skipped because a dependency of script/setup is missing. Other reasons to
skip a test are files from outside the clone (TAUT_REFERENCE), "this machine" and "this build".
"""

import re
import sys
import xml.etree.ElementTree

ALLOWED = re.compile(r"TAUT_REFERENCE|\bthis (machine|build)\b")


def reason(output):
    """Returns the reason of a skipped test: taut's follows "skipped:", GoogleTest's is on the line after "Skipped"."""
    found = re.search(r"skipped: *(.*)|: Skipped\n(.*)", output)
    return (found[1] or found[2] or "").strip() if found else ""


def main():
    for test in xml.etree.ElementTree.parse(sys.argv[1]).iter("testcase"):
        status, why = test.get("status"), ""
        if status not in ("run", "fail"):
            why = reason(test.findtext("system-out") or "")
            status = "skipped" if ALLOWED.search(why) else "missing"
        print(status, test.get("name"), why, sep="\t")


if __name__ == "__main__":
    main()
