"""What a record of `reproduce` says: as JSON and back, as a page, and as Markdown."""

from __future__ import annotations

import base64
import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from contact1d.workflow.judging.check import Check, Comparison, Verdict
from contact1d.workflow.judging.markdown import cell
from contact1d.workflow.judging.words import duration, measured, number, printed, ratio, share, tolerance
from contact1d.workflow.pages.parts import paragraphs, symbols
from contact1d.workflow.reproduce.markdown import readme_table, validation_markdown
from contact1d.workflow.reproduce.page import html_page
from contact1d.workflow.reproduce.record import RECORD, Record, StudyRecord, read_record

VOID = {"meta", "link", "img", "br", "hr", "input"}
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
FORCE = Check(
    study="table1",
    name="adhesion force, R = 1000 LU",
    value=1.48341,
    uncertainty=0.00012,
    unit="FU",
    reference=1.47,
    source="Table 1 of the paper",
    evidence="printed value",
    tolerance=0.015,
    limited_by="print: three digits",
    paper=1.47,
)
BOUND = replace(
    FORCE, study="fig8a", name="distance |ours − JKR| <all N>", value=0.1, uncertainty=0.0, unit="1", reference=0.08,
    source="bound that was asked for", evidence="set bound", comparison="at most", limited_by="range & lattice",
    paper=None,
)  # fmt: skip
LIMIT = replace(
    FORCE, study="fig8a", name="a_cr/a_0", value=0.53, uncertainty=0.001, unit="1", reference=0.63, source="JKR",
    evidence="closed form", tolerance=0.01, limited_by="model", paper=None, differs=True,
)  # fmt: skip
AGAIN = replace(LIMIT, name="F_A again", value=1.0, reference=1.0, differs=False, standing="repeats")
NOTHING = replace(FORCE, name="zero-load radius", value=math.nan, uncertainty=math.nan, unit="LU", reference=28.53)


def record() -> Record:
    table1 = StudyRecord("table1", "Table 1", "The paper says 1 < 2.", "Found F_A.", (FORCE, NOTHING), {}, 3, 90.0)
    fig8a = StudyRecord(
        "fig8a",
        "F(a) is JKR | any N",
        "Says.",
        "One.\n\nTwo.",
        (BOUND, LIMIT, AGAIN),
        {"fig8a.png": 'F "over" a', "no.png": "Lost"},
    )
    return Record((table1, fig8a), {"contact1d": "0.1.0"}, 61.0)


class Walk(HTMLParser):
    """Holds every end tag against the element that is open, and collects what the tests ask for."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.targets: list[str] = []
        self.addresses: list[str] = []
        self.alternatives: list[str | None] = []
        self.rows: list[list[str]] = []
        self.tables = self.captions = 0
        self.lang: str | None = None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        assert len(given) == len(attrs), f"an attribute twice in <{tag}>"
        if tag not in VOID:
            self.open.append(tag)
        if tag == "html":
            self.lang = given.get("lang")
        if tag == "img":
            self.alternatives.append(given.get("alt"))
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        self.tables += tag == "table"
        self.captions += tag == "caption"
        self.ids += [given["id"] or ""] if "id" in given else []
        for name in ("href", "src"):
            address = given.get(name) or ""
            if address.startswith("#"):
                self.targets.append(address[1:])
            elif address:
                self.addresses.append(address)
        self.targets += (given.get("aria-labelledby") or "").split()

    def handle_endtag(self, tag: str) -> None:
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if "td" in self.open or "th" in self.open:
            self.rows[-1][-1] += data


@pytest.mark.parametrize(
    ("comparison", "value", "verdict"),
    [
        ("relative", 2.2, "PASS"),
        ("relative", 2.3, "FAIL"),
        ("relative", 1.7, "FAIL"),
        ("absolute", 2.1, "PASS"),
        ("absolute", 2.2, "FAIL"),
        ("at most", -7.0, "PASS"),
        ("at most", 2.0, "PASS"),
        ("at most", 2.01, "FAIL"),
        ("uncertainty", 2.4, "PASS"),
        ("uncertainty", 2.6, "FAIL"),
        ("relative", math.nan, "FAIL"),
        ("absolute", math.nan, "FAIL"),
        ("at most", math.nan, "FAIL"),
        ("uncertainty", math.nan, "FAIL"),
    ],
)
def test_each_comparison_has_its_own_verdict(comparison: Comparison, value: float, verdict: Verdict) -> None:
    allowed = 0.0 if comparison == "uncertainty" else 0.125
    check = replace(FORCE, value=value, uncertainty=0.5, reference=2.0, tolerance=allowed, comparison=comparison)
    assert check.verdict == verdict


def test_a_record_comes_back_from_its_file_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / RECORD
    path.write_text(record().to_json(), encoding="utf-8")
    again = read_record(path)
    assert again.to_json() == record().to_json()
    assert again.studies[1] == record().studies[1]
    assert again.checks[0] == FORCE
    assert math.isnan(again.checks[1].value)
    assert [check.verdict for check in again.checks] == ["PASS", "FAIL", "FAIL", "DIFFERS", "PASS"]


def test_a_number_that_is_none_is_null_in_the_file_and_fails() -> None:
    document = json.loads(record().to_json())
    assert document["rows"][1]["ours"] == {"value": None, "uncertainty": None, "unit": "LU"}
    assert document["rows"][1]["ratio"] is None
    assert document["verdicts"] == {
        "judged": {"PASS": 1, "FAIL": 2, "DIFFERS": 1}, "repeats": {"PASS": 1}, "by construction": {}
    }  # fmt: skip


@pytest.mark.parametrize(
    ("value", "uncertainty", "unit", "text"),
    [
        (1.48341, 0.00012, "FU", "1.48341 ± 0.00012 FU"),
        (0.00031, 0.00002, "1", "(3.10 ± 0.20) × 10⁻⁴"),
        (-0.5, 0.02, "1", "−0.500 ± 0.020"),
        (12345.0, 120.0, "LU", "(1.234 ± 0.012) × 10⁴ LU"),
        (12.0, 0.0, "LU", "12 LU"),
        (math.nan, 0.1, "LU", "no number"),
    ],
)
def test_a_value_has_the_places_of_its_uncertainty(value: float, uncertainty: float, unit: str, text: str) -> None:
    assert measured(value, uncertainty, unit) == text


def test_numbers_are_written_for_people() -> None:
    assert [number(x) for x in (1000.0, -0.25, 4e-7, 1.23e9)] == ["1000", "−0.25", "4 × 10⁻⁷", "1.23 × 10⁹"]
    assert [share(x) for x in (0.0, 0.009, 4e-6, 0.996, 1.5)] == ["0 %", "0.9 %", "4 × 10⁻⁶", "99.6 %", "150 %"]
    assert [duration(x) for x in (4.21, 61.0, 7500.0)] == ["4.2 s", "1 min", "2 h 5 min"]
    assert (printed(FORCE), printed(BOUND)) == ("1.47 FU", "–")


@pytest.mark.parametrize(
    ("check", "words"),
    [
        (FORCE, "within 1.5 %"),
        (replace(FORCE, tolerance=0.0125), "within 1.25 %"),
        (replace(FORCE, tolerance=4e-6), "within 4 × 10⁻⁶"),
        (replace(FORCE, tolerance=0.02, comparison="absolute"), "within 0.02 FU"),
        (BOUND, "at most 0.08"),
        (replace(FORCE, comparison="uncertainty", tolerance=0.0), "within the uncertainty"),
        (replace(FORCE, comparison="uncertainty"), "within the uncertainty, itself at most 1.5 %"),
    ],
)
def test_a_tolerance_is_said_in_words(check: Check, words: str) -> None:
    assert tolerance(check) == words


def test_a_ratio_shows_how_far_from_one_it_is() -> None:
    values = (1.0091, 0.9999968, 1.0, 2.5, math.nan)
    assert [ratio(replace(FORCE, value=v, reference=1.0)) for v in values] == ["1.0091", "0.9999968", "1", "2.5", "–"]
    assert ratio(replace(FORCE, reference=0.0)) == "–"


def test_a_row_refuses_what_no_record_can_hold() -> None:
    with pytest.raises(ValueError, match="reference must be finite"):
        replace(FORCE, reference=math.inf)
    with pytest.raises(ValueError, match="needs an uncertainty"):
        replace(FORCE, uncertainty=math.nan)
    assert replace(BOUND, value=-math.inf).verdict == "FAIL"


def test_symbols_get_their_index_and_exponent_and_nothing_else() -> None:
    assert symbols("F_A ∝ R^0.5") == "<i>F</i><sub>A</sub> ∝ R<sup>0.5</sup>"
    assert symbols("F̄_A, a_cr^{3/2}.") == "<i>F̄</i><sub>A</sub>, <i>a</i><sub>cr</sub><sup>3/2</sup>."
    assert symbols("mean_pressure <b> fig_1") == "mean_pressure &lt;b&gt; fig_1"
    assert symbols("N = 200, 8 FU a") == "N\u00a0=\u00a0200, 8\u00a0FU a"
    assert paragraphs("One.\n \nTwo.\n") == ["One.", "Two."]


def test_the_page_is_well_formed_and_needs_nothing_beside_it(tmp_path: Path) -> None:
    (tmp_path / "fig8a.png").write_bytes(PNG)
    text = html_page(record(), tmp_path)
    page = Walk(text)
    assert page.open == []
    assert page.lang == "en"
    assert len(page.ids) == len(set(page.ids))
    assert set(page.targets) <= set(page.ids)
    assert page.addresses == ["data:image/png;base64," + base64.b64encode(PNG).decode()]
    assert page.alternatives == ['F "over" a']
    assert page.tables == page.captions == 2
    assert "<script" not in text


def test_the_page_has_every_row_with_its_verdict(tmp_path: Path) -> None:
    page = Walk(html_page(record(), tmp_path))
    body = [[re.sub(r"\s+", " ", text).strip() for text in row] for row in page.rows if "Verdict" not in row]
    assert body == [
        ["✓ PASS", FORCE.name, "1.47 FU", "1.48341 ± 0.00012 FU", "1.47 FU Table 1 of the paper", "1.0091",
         "within 1.5 %", "print: three digits"],
        ["✗ FAIL", NOTHING.name, "1.47 LU", "no number", "28.53 LU Table 1 of the paper", "–",
         "within 1.5 %", "print: three digits"],
        ["✗ FAIL", BOUND.name, "–", "0.1", "0.08 bound that was asked for", "1.25", "at most 0.08", "range & lattice"],
        ["≠ DIFFERS", "acr/a0", "–", "0.5300 ± 0.0010", "0.63 JKR", "0.84", "within 1 %", "model"],
        ["✓ PASS repeats", "FA again", "–", "1.0000 ± 0.0010", "1 JKR", "1", "within 1 %", "model"],
    ]  # fmt: skip


def test_the_page_lists_and_links_the_rows_that_fail_and_escapes_text(tmp_path: Path) -> None:
    text = html_page(record(), tmp_path)
    assert "1 of 3 rows pass, 1 differs as expected; counted apart: 1 repeat another" in text
    assert {"table1-2", "fig8a-1"} <= set(Walk(text).targets)
    assert "fig8a-2" not in Walk(text).targets
    assert "table1-1" not in Walk(text).targets
    assert "distance |ours − JKR| &lt;all N&gt;" in text
    assert "<all N>" not in text


def test_a_figure_that_is_not_there_is_named(tmp_path: Path) -> None:
    text = html_page(record(), tmp_path)
    assert "<img" not in text
    assert text.count("is missing") == 2
    assert "<code>no.png</code> is missing" in text


def test_a_page_of_passing_rows_lists_no_failure(tmp_path: Path) -> None:
    text = html_page(Record((StudyRecord("table1", "Table 1", "Says.", "Found.", (FORCE,)),), {}, 1.0), tmp_path)
    assert "1 of 1 rows pass" in text
    assert ">FAIL<" not in text
    Walk(text)


def columns(line: str) -> int:
    return len(re.findall(r"(?<!\\)\|", line))


@pytest.mark.parametrize("make", [validation_markdown, readme_table])
def test_rows_of_a_markdown_table_have_one_number_of_columns(make: object) -> None:
    assert callable(make)
    blocks = re.findall(r"(?:^\|.*\n)+", make(record()), re.MULTILINE)
    assert blocks
    for block in blocks:
        lines = block.splitlines()
        assert len({columns(line) for line in lines}) == 1
        assert set(lines[1]) == set("| -")
        assert len(lines) > 2


def test_a_cell_stays_a_cell() -> None:
    assert cell("a | b\n<c> \\ d R^{2/3}") == r"a \| b &lt;c> \\ d R^(2/3)"


def test_validation_shows_failing_rows_evidence_and_what_is_not_validated() -> None:
    text = validation_markdown(record())
    assert "**1 of 3 rows pass, 1 differs as expected; counted apart: 1 repeat another.** These fail:" in text
    assert "| DIFFERS |" in text
    assert "| PASS, repeats |" in text
    assert "0 of 4 rows allow more than 20 times what they reach." in text
    assert r"distance \|ours − JKR\| &lt;all N>" in text
    assert text.count("**FAIL**") == 2
    assert [len(re.findall(rf"^\| {name} \|", text, re.MULTILINE)) for name in ("set bound", "printed value")] == [1, 1]
    assert "| Table 1 of the paper | printed value |" in text
    assert "## Not validated" in text
    assert text.endswith(".\n")
    assert "\n\n\n" not in text


def test_the_readme_has_one_row_for_each_study() -> None:
    lines = readme_table(record()).splitlines()
    assert lines[2:] == [
        "| `table1` | Table 1 | 1 of 2 rows pass; worst deviation 0.91 % | **FAIL** |",
        r"| `fig8a` | F(a) is JKR \| any N | 0 of 1 rows pass, 1 differs as expected; counted apart: 1 repeat "
        "another | **FAIL** |",
    ]


def test_a_study_without_rows_claims_nothing(tmp_path: Path) -> None:
    empty = Record((StudyRecord("fig4", "Figure 4", "Says.", "Found.", ()),), {}, 1.0)
    assert readme_table(empty).splitlines()[2] == "| `fig4` | Figure 4 | 0 of 0 rows pass | – |"
    assert "no rows" in html_page(empty, tmp_path)
    validation_markdown(empty)
