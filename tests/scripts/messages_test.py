#!/usr/bin/env python3
"""Checks that script/messages.py writes the complete texts of messages.

Usage: messages_test.py
"""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "script"))
sys.dont_write_bytecode = True

import messages  # noqa: E402


class Texts(unittest.TestCase):
    def test_a_condition_makes_one_text_for_each_value(self):
        self.assertEqual(messages.templates('"a " + (x > 0 ? "long" : "short") + " bar"', ""), {"a long bar", "a short bar"})

    def test_a_condition_has_one_value_in_a_text_and_its_hint(self):
        self.assertEqual(messages.templates('"it " + (b ? "bends" : "breaks")', 'b ? "more" : "less"'),
                         {"it bends (more)", "it breaks (less)"})

    def test_an_empty_hint_has_no_parentheses(self):
        self.assertEqual(messages.templates('"wrong"', 'std::string(ok ? "try" : "")'), {"wrong", "wrong (try)"})

    def test_conditions_may_contain_conditions(self):
        self.assertEqual(messages.templates('a ? "one" : b::c ? "two" : "three" + d', ""), {"one", "two", "three{}"})

    def test_arguments_of_a_format_are_texts(self):
        self.assertEqual(messages.templates('fmt::format("{1} by {0:.3g} m", f("x"), far ? "above" : "below")', ""),
                         {"above by {} m", "below by {} m"})

    def test_braces_outside_of_a_format_are_kept(self):
        self.assertEqual(messages.templates('"write `goal: {frame: world}`"', ""), {"write `goal: {frame: world}`"})

    def test_a_character_is_text(self):
        self.assertEqual(messages.templates("""'"' + name + '"' + " is " + '\\''""", ""), {""""{}" is '"""})

    def test_texts_in_calls_are_values(self):
        self.assertEqual(messages.templates('At("friction") + " must not be " + Name(x, "a")', ""), {"{} must not be {}"})


if __name__ == "__main__":
    unittest.main()
