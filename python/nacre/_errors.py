# Nacre: exceptions and warnings.
"""Exceptions and warnings of Nacre."""

from __future__ import annotations

import os
import sys
import warnings

_HERE = os.path.dirname(os.path.abspath(__file__))


class Error(RuntimeError):
    """Bad input or a failed request, told in three parts.

    Attributes
    ----------
    what : str
        What is wrong.
    why : str
        Why it is wrong; may be empty.
    advice : str
        What to do about it; may be empty.
    """

    def __init__(self, what: str, why: str = "", advice: str = "") -> None:
        text = what
        if why:
            text += f" ({why})"
        if advice:
            text += f"; {advice}"
        super().__init__(text)
        self.what = what
        self.why = why
        self.advice = advice

    def __reduce__(self) -> tuple[type[Error], tuple[str, str, str]]:
        return type(self), (self.what, self.why, self.advice)


class Interrupted(Exception):
    """A progress callback returned False."""


class Warning(UserWarning):
    """What Nacre assumed or dropped, and flaws of a result."""


for _class in (Error, Interrupted, Warning):
    _class.__module__ = "nacre"


def give_warning(sentence: str) -> None:
    """Warn at the line of the caller's own code."""
    level = 1
    frame = sys._getframe(0)
    while frame is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _HERE:
        level += 1
        if frame.f_back is None:
            break
        frame = frame.f_back
    warnings.warn(sentence, Warning, stacklevel=level)
