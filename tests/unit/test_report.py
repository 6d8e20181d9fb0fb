"""The page of runs and their animation: what stands on them, and that they need nothing beside them."""

from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from contact1d import Run, RunError, run
from tests.command import contact1d
from tests.pages import figures_on
from tests.scenes import SCENES, chains
from tests.sweeps import PLANE

VOID = {"meta", "link", "img", "br", "hr", "input"}
PULL_OFF = chains(400.0, experiment={"kind": "pull_off", "preload": 0.5}, title="<a> pull-off & more")
MOVES = PLANE | {"experiment": {"kind": "path", "displacements": [0.0, 0.05, 0.1]}}
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


def page_of(*folders: Path) -> Path:
    """The page of these runs, in the first of their folders; well-formed, with all that it needs."""
    page = folders[0] / "r.html"
    done = contact1d("report", *folders, "--out", page)
    assert done.exit_code == 0, done.output
    checked = Balance(page.read_text(encoding="utf-8"))
    assert (checked.open, checked.outside) == ([], [])
    assert len(set(checked.ids)) == len(checked.ids)
    return page


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(PULL_OFF, tmp_path_factory.mktemp("runs") / "pull_off", figures=False)


def test_the_page_of_a_run_says_results_scene_cost_deck_and_versions(finished: Run) -> None:
    page = page_of(finished.folder).read_text(encoding="utf-8")
    for quantity in finished.results.values():
        assert str(quantity) in page
    assert "&lt;a&gt; pull-off &amp; more" in page
    assert "<h1><a>" not in page
    for words in ("Compression by a preload", "required tolerance", "lmp -in in.lammps", "units           lj"):
        assert words in page
    for name in finished.document["versions"]:
        assert f"<dt>{name}</dt>" in page


def test_the_slider_moves_through_every_state_with_its_own_numbers(finished: Run) -> None:
    path = figures_on(page_of(finished.folder))["path"]
    count = len(finished.curve.force)
    curve, loads, bodies = (chart["data"] for chart in path["charts"])
    assert len(path["words"]) == len(loads[0]["y"]) == len(bodies[0]["y"]) == len(bodies[1]["y"]) == count
    marked = [force for (force,) in curve[-1]["y"]]
    np.testing.assert_allclose(marked, finished.curve.force, rtol=SEVEN_DIGITS, atol=SEVEN_DIGITS)
    spacing = finished.scene.bodies.spacing
    shown = [spacing * sum(row) for row in loads[0]["y"]]
    strong = np.argmax(np.abs(finished.curve.force))
    assert shown[strong] == pytest.approx(finished.curve.force[strong], rel=TAIL)


def test_runs_share_a_panel_where_each_has_a_twentieth_of_its_axes_and_a_failed_one_says_why(tmp_path: Path) -> None:
    """Spheres by Hertz, d ∝ F^(2/3): ten times the force is 4.6 times the displacement, a thousand times is 100."""
    folders = []
    for force in (1e4, 1e1, 1e3, 1e2):
        load = {"title": f"{force:g}", "experiment": {"kind": "load", "force": force}}
        bodies = PLANE["bodies"] | {"particles": "auto", "reduction": "mdr"}
        folders.append(run(PLANE | load | {"bodies": bodies}, tmp_path / f"{force:g}", figures=False).folder)
    with pytest.raises(RunError):
        run(PLANE | {"experiment": {"kind": "load", "force": 900.0}}, tmp_path / "failed", figures=False)
    page = page_of(*folders, tmp_path / "failed")
    assert "end of the chain" in page.read_text(encoding="utf-8")
    over = "Force over displacement"
    found = {chart["title"]: chart["data"] for chart in figures_on(page)["charts"] if chart["title"].startswith(over)}
    pairs = ("10000", "1000"), ("10", "100")
    assert list(found) == [f"{over}: {', '.join(names)}" for names in pairs]
    for names, traces in zip(pairs, found.values(), strict=True):
        assert {unescape(trace["name"]).partition(",")[0] for trace in traces} == {*names, "Hertz"}
    together = figures_on(page_of(folders[0], folders[2]))
    assert over in [chart["title"] for chart in together["charts"]]


def test_a_page_replaces_a_page_and_nothing_else(finished: Run, tmp_path: Path) -> None:
    page = page_of(finished.folder)
    written = page.read_text()
    older = written.replace('<meta name="generator" content="contact1d report">', "")  # as 0.1 wrote it
    assert older != written
    page.write_text(older)
    assert page_of(finished.folder).read_text() == written
    scene = tmp_path / "scene.toml"
    scene.write_text("title = 'mine'")
    (tmp_path / "folder").mkdir()
    (tmp_path / "other.html").write_text("<!DOCTYPE html>\n<html></html>\n")
    (tmp_path / "link.html").symlink_to(scene)
    for name in ("scene.toml", "folder", "other.html", "link.html"):
        refused = contact1d("report", finished.folder, "--out", tmp_path / name)
        assert refused.exit_code == 2
        assert f"{name} is no page of contact1d" in refused.stderr
    assert scene.read_text() == "title = 'mine'"
    assert contact1d("report", finished.folder, "--out", tmp_path / "named").stdout.endswith("named.html\n")


@pytest.mark.parametrize("name", ["hertz_plane", "mindlin"])
def test_a_moving_run_has_a_place_on_its_curve_for_each_state(name: str, tmp_path: Path) -> None:
    done = run(SCENES / f"{name}.toml", tmp_path / "run", figures=False)
    data = figures_on(page_of(done.folder))
    assert data["charts"]
    places = data["path"]["charts"][0]["data"][-1]["x"]
    assert len(places) == len(data["path"]["words"]) == len(done.curve.force)


def test_an_animation_has_a_picture_for_each_state_and_a_script_for_ovito_lies_beside_them(tmp_path: Path) -> None:
    """The script is Python of its own, which knows nothing of this program; a new run removes it."""
    done = run(MOVES, tmp_path / "run", figures=False)
    assert contact1d("animate", done.folder).exit_code == 0
    with Image.open(done.folder / "way.gif") as picture:
        assert picture.n_frames == len(done.curve.force)
        shown = [np.asarray(picture.convert("RGB")) for frame in range(2) if picture.seek(frame) is None]
    assert np.any(shown[0] != shown[1])
    assert not list(done.folder.glob("*.part*"))
    script = Path(contact1d("animate", done.folder, "--ovito").stdout.strip())
    text = script.read_text()
    compile(text, str(script), "exec")
    assert "contact1d" not in text
    (done.folder / "states.lammpstrj").unlink()
    lacking = contact1d("animate", done.folder, "--ovito")
    assert lacking.exit_code == 2
    assert "lacks states.lammpstrj" in lacking.stderr
    still = {"experiment": {"kind": "path", "displacements": [0.1]}}
    run(PLANE | still, done.folder, figures=False)
    assert not script.exists()
    for name, words in (("a.avi", "ends in .gif or .mp4"), ("a.gif", "has a single state")):
        refused = contact1d("animate", done.folder, "--out", tmp_path / name)
        assert refused.exit_code == 2
        assert words in refused.stderr
