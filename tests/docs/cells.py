"""Runs the cells of a notebook, in one session: a JSON list of texts comes in, one of what each printed goes out.

As in a notebook, the value of an expression at a cell's end is shown, and what a cell raises ends the session.
"""

import ast
import contextlib
import io
import json
import sys
import traceback


def run(text, number, session):
    """What a cell prints, and whether the next may run."""
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
