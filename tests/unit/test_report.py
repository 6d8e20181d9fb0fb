"""The page of runs or of a sweep: what stands on it, and that it needs nothing beside it."""

from __future__ import annotations

import json
import re
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Contact1dError, FolderError, Run, read_scene, run, sphere, sweep
from contact1d.workflow.report.animation import animate, ovito_script
from contact1d.workflow.report.report import report
from tests.scenes import chains

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
SHIPPED = [SCENES / f"{name}.toml" for name in ("hertz_plane", "path_hysteresis", "mindlin", "pull_off")]
SHORTER = {"path_hysteresis": ["experiment.displacements.steps=4", "bodies.particles=60"]}
VOID = {"meta", "link", "img", "br", "hr", "input"}
PULL_OFF = chains(400.0, experiment={"kind": "pull_off", "preload": 0.5}, title="<a> pull-off & more")
TAIL = 0.05  # relative: the part of the force beyond the window that is drawn
SEVEN_DIGITS = 1e-6  # relative: what single precision and the page's rounding keep


class Balance(HTMLParser):
    """Checks that each element is closed, and keeps what the page asks for from elsewhere."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.outside: list[str] = []
        self.ids: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.ids += [str(given["id"])] if "id" in given else []
        self.outside += [str(given[key]) for key in ("src", "href") if key in given]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(PULL_OFF, tmp_path_factory.mktemp("runs") / "pull_off", figures=False)


def data_on(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found
    read: dict[str, Any] = json.loads(found[1])
    return read


def test_the_page_of_a_run_says_results_scene_cost_deck_and_versions(finished: Run, tmp_path: Path) -> None:
    page = report([finished.folder], tmp_path / "r.html").read_text()
    for quantity in finished.results.values():
        assert str(quantity) in page
    assert "&lt;a&gt; pull-off &amp; more" in page
    assert "<h1><a>" not in page
    for words in ("Compression by a preload", "required tolerance", "lmp -in in.lammps", "units           lj"):
        assert words in page
    for name in finished.document["versions"]:
        assert f"<dt>{name}</dt>" in page


def test_the_page_needs_nothing_beside_it_and_is_well_formed(finished: Run, tmp_path: Path) -> None:
    page = report([finished.folder], tmp_path / "r.html").read_text()
    checked = Balance(page)
    assert checked.open == []
    assert checked.outside == []
    assert len(set(checked.ids)) == len(checked.ids)


def test_the_slider_moves_through_every_state_with_its_own_numbers(finished: Run, tmp_path: Path) -> None:
    way = data_on(report([finished.folder], tmp_path / "r.html").read_text())["path"]
    count = len(finished.curve.force)
    curve, loads, bodies = (chart["data"] for chart in way["charts"])
    assert len(way["words"]) == len(loads[0]["y"]) == len(bodies[0]["y"]) == len(bodies[1]["y"]) == count
    against = [one for (one,) in curve[-1]["y"]]
    np.testing.assert_allclose(against, finished.curve.force, rtol=SEVEN_DIGITS, atol=SEVEN_DIGITS)
    spacing = finished.scene.bodies.spacing
    shown = [spacing * sum(row) for row in loads[0]["y"]]
    strong = np.argmax(np.abs(finished.curve.force))
    assert shown[strong] == pytest.approx(finished.curve.force[strong], rel=TAIL)


def test_several_runs_are_overlaid_and_a_failed_one_says_why(finished: Run, tmp_path: Path) -> None:
    other = run(chains(600.0, experiment={"kind": "pull_off", "preload": 0.5}, title="other"), tmp_path / "o", False)
    with pytest.raises(Exception, match="end of the chain"):
        run(chains(400.0, experiment={"kind": "load", "force": 0.5}, bodies={"particles": 7}), tmp_path / "f", False)
    page = report([finished.folder, other.folder, tmp_path / "f"], tmp_path / "r.html").read_text()
    names = [unescape(trace["name"]) for trace in data_on(page)["charts"][0]["data"]]
    assert {name.partition(",")[0] for name in names} >= {finished.scene.title, "other"}
    assert "end of the chain" in page
    assert str(other.results.adhesion_force) in page


def test_runs_share_a_panel_where_each_has_a_twentieth_of_its_axes(tmp_path: Path) -> None:
    """Spheres by Hertz, d ∝ F^(2/3): ten times the force is 4.6 times the displacement, a thousand times is 100."""
    ball = sphere(radius="10 mm", contact_modulus="70 GPa", tolerance=1e-2)
    folders = [ball.load(force, tmp_path / force).folder for force in ("10 N", "10 mN", "1 N", "100 mN")]
    page = data_on(report(folders, tmp_path / "r.html").read_text())
    over = "Force over displacement"
    found = {chart["title"]: chart["data"] for chart in page["charts"] if chart["title"].startswith(over)}
    strong, weak = ("10\u00a0N", "1\u00a0N"), ("10\u00a0mN", "100\u00a0mN")
    assert list(found) == [f"{over}: {', '.join(names)}" for names in (strong, weak)]
    for names, traces in zip((strong, weak), found.values(), strict=True):
        assert {trace["name"].partition(",")[0] for trace in traces} == {*names, "Hertz"}
    together = data_on(report([folders[0], folders[2]], tmp_path / "r.html").read_text())
    assert over in [chart["title"] for chart in together["charts"]]


def test_a_page_replaces_a_page_and_nothing_else(finished: Run, tmp_path: Path) -> None:
    page = report([finished.folder], tmp_path / "r.html")
    written = page.read_text()
    older = written.replace('<meta name="generator" content="contact1d report">', "")  # as 0.1 wrote it
    assert older != written
    page.write_text(older)
    assert report([finished.folder], page).read_text() == written
    scene = tmp_path / "scene.toml"
    scene.write_text("title = 'mine'")
    (tmp_path / "folder").mkdir()
    (tmp_path / "other.html").write_text("<!DOCTYPE html>\n<html></html>\n")
    (tmp_path / "link.html").symlink_to(scene)
    for name in ("scene.toml", "folder", "other.html", "link.html"):
        with pytest.raises(FolderError, match=rf"{name} is no page of contact1d.*choose another file") as refused:
            report([finished.folder], tmp_path / name)
        assert refused.value.exit_code == 2
    assert scene.read_text() == "title = 'mine'"


def test_the_page_of_a_sweep_has_its_table_and_a_figure_for_each_result(tmp_path: Path) -> None:
    base = chains(400.0, experiment={"kind": "load", "force": 0.5})
    axes = [{"key": "experiment.force", "values": [0.25, 0.5]}, {"key": "bodies.profile.radius", "values": [400.0]}]
    done = sweep({"title": "forces", "base": base, "axes": axes}, tmp_path / "s", workers=1, figures=False)
    page = report([tmp_path / "s"], tmp_path / "r.html").read_text()
    assert Balance(page).open == []
    charts = [chart["title"].partition(" over ")[0] for chart in data_on(page)["charts"]]
    assert (
        {"Displacement", "Contact radius"}
        <= set(charts)
        <= {name.replace("_", " ").capitalize() for name in done.quantities}
    )
    assert "Separation energy" not in charts  # it is the same everywhere
    assert page.count("<td>done</td>") == 2


@pytest.mark.parametrize("name", [path.stem for path in SHIPPED])
def test_every_kind_of_run_has_a_page(name: str, tmp_path: Path) -> None:
    """A shipped scene for each kind of experiment: what it moves on, and a place on it for each state."""
    scene = read_scene(SCENES / f"{name}.toml", SHORTER.get(name, []))
    kept = run(scene, tmp_path / "run", figures=False)
    page = report([tmp_path / "run"], tmp_path / "r.html").read_text()
    assert Balance(page).open == []
    data = data_on(page)
    assert data["charts"]
    if len(kept.curve.force) > 1:
        assert len(data["path"]["charts"][0]["data"][-1]["x"]) == len(data["path"]["words"])


def test_the_way_of_a_run_moves_a_picture_for_each_state(tmp_path: Path) -> None:
    from PIL import Image

    path = {"kind": "path", "displacements": [0.0, 0.05, 0.1]}
    finished = run(chains(400.0, experiment=path), tmp_path / "run", figures=False)
    with Image.open(animate(finished.folder)) as picture:
        assert picture.n_frames == len(finished.curve.force)
        shown = [np.asarray(picture.convert("RGB")) for frame in range(2) if picture.seek(frame) is None]
    assert np.any(shown[0] != shown[1])
    assert not list(finished.folder.glob("*.part*"))


@pytest.mark.parametrize(("name", "words"), [("way.avi", "ends in .gif or .mp4"), ("way.gif", "has a single state")])
def test_what_cannot_move_is_told(name: str, words: str, tmp_path: Path) -> None:
    run(chains(400.0, experiment={"kind": "path", "displacements": [0.1]}), tmp_path / "run", figures=False)
    with pytest.raises(Contact1dError, match=words):
        animate(tmp_path / "run", tmp_path / name)


def test_the_script_for_ovito_lies_beside_the_states_and_a_new_run_removes_it(tmp_path: Path) -> None:
    """It is Python of its own, which knows nothing of this program."""
    path = {"kind": "path", "displacements": [0.0, 0.05]}
    finished = run(chains(400.0, experiment=path), tmp_path / "run", figures=False)
    script = ovito_script(finished.folder)
    text = script.read_text()
    compile(text, str(script), "exec")
    assert "contact1d" not in text
    (finished.folder / "states.lammpstrj").unlink()
    with pytest.raises(FolderError, match=r"lacks states\.lammpstrj.*run the scene again"):
        ovito_script(finished.folder)
    run(finished.scene, finished.folder, figures=False)
    assert not script.exists()
