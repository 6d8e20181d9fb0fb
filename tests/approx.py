"""`pytest.approx` without its default of abs=1e-12, beside which a k_B of 1e-23 J/K or an energy in joule is nothing.

`conftest.py` puts it in the place of pytest's own: without `abs` a comparison is relative, and with 0 exact.
"""

from typing import Any

import pytest

RELATIVE = 1e-6
"""Where neither `rel` nor `abs` is given, as in pytest."""
ORIGINAL = pytest.approx


def relative(expected: Any, rel: Any = None, abs: Any = None, nan_ok: bool = False) -> Any:
    """`pytest.approx`, relative unless `abs` is given."""
    if abs is None:
        rel, abs = RELATIVE if rel is None else rel, 0.0
    return ORIGINAL(expected, rel=rel, abs=abs, nan_ok=nan_ok)
