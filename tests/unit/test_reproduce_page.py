"""What a record of `reproduce` says: as JSON and back, as a page, and as Markdown."""

from __future__ import annotations

import base64
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from contact1d.workflow.pages.parts import paragraphs, symbols
from tests.checks import BOUND, FORCE, NOTHING, record
from validation.judging.markdown import cell
from validation.paper.markdown import readme_table, validation_markdown
from validation.paper.page import html_page
from validation.paper.record import Record, StudyRecord

VOID = {"meta", "link", "img", "br", "hr", "input"}
PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


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
