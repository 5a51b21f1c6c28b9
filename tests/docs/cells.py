"""Runs the cells of a notebook in one session: reads a JSON list of texts, writes a JSON list of their outputs.

As in a notebook, the value of an expression at the end of a cell is shown, and an exception ends the session.
"""

import ast
import contextlib
import io
import json
import sys
import traceback


def run(text, number, session):
    """Returns the output of a cell and whether the next cell may run."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        try:
            code = ast.parse(text, f"cell {number}")
            last = None
            if code.body and isinstance(code.body[-1], ast.Expr):
                last = ast.Expression(code.body.pop().value)
            exec(compile(code, f"cell {number}", "exec"), session)
            value = eval(compile(last, f"cell {number}", "eval"), session) if last else None
            if value is not None:
                print(repr(value))
        except BaseException:
            traceback.print_exc()
            return printed.getvalue(), False
    return printed.getvalue(), True


def main():
    cells, session, outputs = json.load(sys.stdin), {"__name__": "__main__"}, []
    good = True
    for number, text in enumerate(cells, 1):
        if not good:
            break
        printed, good = run(text, number, session)
        outputs.append(printed)
    json.dump({"outputs": outputs, "good": good}, sys.__stdout__)


main()
