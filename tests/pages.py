"""What a page shows of a run or of a record, between its markers: compared with it, and written with WRITE_DOCS=1.

Also the data of the figures on a page of `contact1d report`.
"""

import json
import os
import re
from decimal import Decimal
from pathlib import Path
from typing import Any

from tests.scenes import ROOT
from validation.page import write_between

NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def require_shown(page: str, name: str, text: str, exactly: bool = False, share: float = 0.0) -> None:
    """The page shows `text` under that name, word for word.

    Unless `exactly`, which is for records, the last decimal of a number may be off by one: round-off of a processor.
    It may be off by a `share` of it where random numbers decide.
    """
    path = ROOT / page
    if os.environ.get("WRITE_DOCS"):
        write_between(path, name, text)
    _, begin, rest = path.read_text(encoding="utf-8").partition(f"<!-- {name}: begin -->\n")
    shown, end, _ = rest.partition(f"<!-- {name}: end -->\n")
    assert begin, f"{page} does not show {name}"
    assert end
    assert not exactly or shown == text
    assert NUMBER.sub("#", shown).split() == NUMBER.sub("#", text).split()
    for there, here in zip(NUMBER.findall(shown), NUMBER.findall(text), strict=True):
        last = Decimal((0, (1,), int(Decimal(there).as_tuple().exponent))) if "." in there else 0
        off = abs(Decimal(there) - Decimal(here))
        assert off <= max(last, Decimal(share) * abs(Decimal(there))), f"{page}: {there}"


def figures_on(page: Path) -> dict[str, Any]:
    """The data of the figures on a page of `contact1d report`."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page.read_text("utf-8"), re.DOTALL)
    assert found
    read: dict[str, Any] = json.loads(found[1])
    return read
