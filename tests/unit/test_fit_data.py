"""A file of force curves is read to its numbers, lines and segments, or refused at its bounds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.fit.curve import ForceCurve
from contact1d.workflow.fit.data import DataError, curves
from contact1d.workflow.fit.plan import read_fit

BASE = {
    "bodies": {"profile": {"kind": "parabola", "radius": "5 µm"}},
    "material": {"contact_modulus": "1 MPa"},
    "adhesion": {"work_of_adhesion": "20 mJ/m²"},
}
Array = np.ndarray[Any, np.dtype[np.float64]]


def read(path: Path, **changes: Any) -> list[Any]:
    tables = {"data": str(path), "parameters": ["material.contact_modulus"], "base": BASE}
    return list(curves(path, read_fit(tables | {"instrument": {"stiffness": "0.5 N/m"}} | changes)))


def one(path: Path, text: str, **changes: Any) -> ForceCurve:
    path.write_text(text, encoding="utf-8")
    ((_, _, curve),) = read(path, **changes)
    if isinstance(curve, DataError):
        raise curve
    assert isinstance(curve, ForceCurve)
    return curve


def rows(count: int = 60) -> Array:
    """z [nm] up and down again, and F [nN], an approach of half the points that touches in its middle."""
    z = np.round(np.linspace(-100.0, 100.0, count // 2), 2)
    z = np.append(z, z[::-1][: count - count // 2])
    z = np.append(z, z[-1:] - 1.0) if z.size < count else z
    return np.column_stack([z, np.round(np.maximum(z, 0.0) ** 1.5 / 10.0 + 0.01 * np.cos(37.0 * np.arange(count)), 4)])


def text(numbers: Array, names: str = "z [nm],F [nN]", separator: str = ",") -> str:
    return names + "\n" + "".join(separator.join(f"{x:.4f}" for x in row) + "\n" for row in numbers)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "curve.csv"


def test_numbers_are_in_si_with_the_lines_that_they_stand_in(file: Path) -> None:
    curve = one(file, "# an instrument\n\n" + text(rows()))
    assert curve.positions == pytest.approx(1e-9 * rows()[:, 0], rel=1e-12, abs=1e-20)
    assert curve.forces == pytest.approx(1e-9 * rows()[:, 1], rel=1e-12, abs=1e-20)
    assert curve.lines.tolist() == list(range(4, 64))
    assert curve.turn == 30


FORMS = {
    "units below": (text(rows(), "z,F\n[µm],[µN]"), 1e3, range(3, 63)),
    "tabs": (text(rows(), "piezo [nm]\tload [nN]", "\t"), 1.0, range(2, 62)),
    "decimal commas": (text(rows(), "z [nm];F [nN]", ";").replace(".", ","), 1.0, range(2, 62)),
    "spaces": (text(rows(), "height force\nnm nN", " "), 1.0, range(3, 63)),
    "a mark of the encoding": ("\ufeff" + text(rows()), 1.0, range(2, 62)),
    "a blank line": (text(rows()).replace("nN]\n", "nN]\n\n", 1), 1.0, range(3, 63)),
    "units below a blank line": (text(rows(), "z,F\n\n[nm],[nN]"), 1.0, range(4, 64)),
    "a remark among the numbers": (text(rows()).replace("\n", "\n# a remark\n", 2), 1.0, [3, *range(5, 64)]),
    "another column": (text(np.column_stack([rows()[:, 0], rows()]), "time,z [nm],F [nN]"), 1.0, range(2, 62)),
}


@pytest.mark.parametrize("name", FORMS)
def test_forms_of_a_file(name: str, file: Path) -> None:
    content, size, lines = FORMS[name]
    curve = one(file, content)
    assert curve.positions == pytest.approx(size * 1e-9 * rows()[:, 0], rel=1e-12, abs=1e-20)
    assert curve.forces == pytest.approx(size * 1e-9 * rows()[:, 1], rel=1e-12, abs=1e-20)
    assert curve.lines.tolist() == list(lines)


def test_an_indentation_becomes_the_position_of_the_piezo(file: Path) -> None:
    """z = d + F/k."""
    given = one(file, text(rows(), "d [nm],F [nN]"))
    assert given.positions == pytest.approx(1e-9 * (rows()[:, 0] + rows()[:, 1] / 0.5), rel=1e-12, abs=1e-20)
    rigid = one(file, text(rows(), "d [nm],F [nN]"), instrument=None)
    assert rigid.positions == pytest.approx(1e-9 * rows()[:, 0], rel=1e-12, abs=1e-20)


def test_signs_and_segments_are_as_they_are_said_to_be(file: Path) -> None:
    turned = one(file, text(-rows()), reverse=["z", "F"])
    assert turned.forces == pytest.approx(1e-9 * rows()[:, 1], rel=1e-12, abs=1e-20)
    words = ["Approach"] * 27 + ["retract"] * 33
    lines = text(rows()).splitlines()
    marked = [f"{line},{word}" for line, word in zip(lines, ["segment", *words], strict=True)]
    assert one(file, "\n".join(marked) + "\n").turn == 27
    marked[3] = marked[3].replace("Approach", "pause")
    with pytest.raises(DataError, match="words other than approach and retract"):
        one(file, "\n".join(marked) + "\n")
    marked[3] = marked[3].replace("pause", "retract")
    with pytest.raises(DataError, match="the approach must come before"):
        one(file, "\n".join(marked) + "\n")


def test_a_map_is_read_curve_by_curve_with_its_places(file: Path) -> None:
    parts = [np.column_stack([np.full((60, 3), [i, 10.0 * i, 5.0]), rows() * [1.0, 1.0 + i]]) for i in (3, 4)]
    file.write_text(text(np.vstack(parts), "index,x,y,z [nm],F [nN]"), encoding="utf-8")
    found = read(file)
    assert [place for _, place, _ in found] == [(30.0, 5.0), (40.0, 5.0)]
    assert [curve.forces.max() for _, _, curve in found] == pytest.approx([4e-9 * 100.0, 5e-9 * 100.0], rel=1e-3)
    assert [int(curve.lines[0]) for _, _, curve in found] == [2, 62]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: rows(40), ""),
        (lambda c: rows(39), "39 points, and at least 40"),
        (lambda c: np.column_stack([c[:, 0], np.minimum(c[:, 1], np.sort(c[:, 1])[-5])]), ""),
        (lambda c: np.column_stack([c[:, 0], np.minimum(c[:, 1], np.sort(c[:, 1])[-6])]), "saturated: 6 points"),
        (lambda c: np.delete(c, slice(8, 14), axis=0), ""),
        (lambda c: np.delete(c, slice(8, 16), axis=0), "gap in z after line 9"),
        (lambda c: np.delete(c, slice(42, 50), axis=0), "gap in z after line 43"),
        (lambda c: rows(70)[:45], ""),
        (lambda c: rows(70)[:44], r"one segment only \(35 points approach, 9 retract\)"),
        (lambda c: c * [1.0, -1.0], r'reverse = \["F"\]'),
        (lambda c: c * [-1.0, 1.0], r'reverse = \["z"\]'),
    ],
)
def test_what_is_just_a_curve_and_what_is_none(change: Any, words: str, file: Path) -> None:
    content = text(change(rows()))
    if not words:
        assert one(file, content).turn >= 20
        return
    with pytest.raises(DataError, match=words):
        one(file, content)


def test_volts_and_numbers_that_are_none_are_told_with_their_line(file: Path) -> None:
    with pytest.raises(DataError, match="column F is in volts"):
        one(file, text(rows(), "z [nm],F [mV]"))
    lines = text(rows()).splitlines()
    lines[7] = lines[7].partition(",")[0] + ",x"
    lines[9] = lines[9].partition(",")[0] + ","
    with pytest.raises(DataError, match=r"line 8: F is empty or no number; leave such lines out \(2 in all\)"):
        one(file, "\n".join(lines) + "\n")
    with pytest.raises(DataError, match="z is the position of the piezo"):
        one(file, text(rows()), instrument=None)
