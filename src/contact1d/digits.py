"""Numbers as text with as many digits as they need."""

EXACT = 12
"""Digits of a number that follows from others, without its round-off error."""


def digits_apart(value: float, limit: float, least: int = 3) -> int:
    """Return the number of significant digits, at least `least`, that show which one of two numbers is larger.

    17 at most; `least` for equal numbers. Two numbers are apart as soon as they are rounded to different ones.

    >>> digits_apart(0.10003, 0.1)
    5
    """
    most = 17  # digits that distinguish any two numbers
    apart = (count for count in range(least, most) if float(f"{value:.{count}g}") != float(f"{limit:.{count}g}"))
    return next(apart, most if value != limit else least)


def apart(value: float, limit: float, least: int = 3) -> tuple[str, str]:
    """Return both numbers as text, with the significant digits, at least `least`, that show which one is larger.

    Both are rounded to the same number of digits, 17 at most, `least` for equal numbers; zeros at the end are not
    written.

    >>> apart(0.10003, 0.1)
    ('0.10003', '0.1')
    """
    digits = digits_apart(value, limit, least)
    return f"{value:.{digits}g}", f"{limit:.{digits}g}"


def cleaned(value: float) -> float:
    """Return a number without its round-off error, to 12 digits: 1e-05 for 9.999999999999999e-06, on every machine.

    >>> cleaned(0.1 + 0.2)
    0.3
    """
    return float(f"{value:.{EXACT}g}")
