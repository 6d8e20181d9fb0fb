"""Numbers as text with as many digits as they need."""

EXACT = 12
"""Digits of a number that follows from others, without its round-off error."""
MOST = 17
"""Digits that tell any two numbers apart."""


def digits_apart(value: float, limit: float, least: int = 3) -> int:
    """How many digits, at least `least`, it takes to see which one of two numbers is larger.

    >>> digits_apart(0.10003, 0.1)
    5
    """
    apart = (count for count in range(least, MOST) if float(f"{value:.{count}g}") != float(f"{limit:.{count}g}"))
    return next(apart, MOST if value != limit else least)


def apart(value: float, limit: float, least: int = 3) -> tuple[str, str]:
    """Both numbers as text with as many digits, at least `least`, as it takes to see which one is larger.

    >>> apart(0.10003, 0.1)
    ('0.10003', '0.1')
    """
    digits = digits_apart(value, limit, least)
    return f"{value:.{digits}g}", f"{limit:.{digits}g}"


def cleaned(value: float) -> float:
    """The number without its round-off error: 1e-05 for 9.999999999999999e-06, on every machine.

    >>> cleaned(0.1 + 0.2)
    0.3
    """
    return float(f"{value:.{EXACT}g}")
