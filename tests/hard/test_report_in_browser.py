"""The page of runs in a real browser: figures are whole, the slider moves profile, force and bodies together."""

import itertools
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import contact1d
from contact1d import run
from tests.command import contact1d as command
from tests.scenes import chains

pytestmark = pytest.mark.browser
HERE = ("file:", "data:", "blob:")
"""Addresses that need no network."""
THEORY = "#555555"
PATIENCE = 180_000
"""Time for a page of some megabytes on a machine with other work [ms]."""
PHONE = {"width": 390, "height": 844}
SCREENS = (PHONE["width"], 1280)
"""Widths of a page [px]."""
PAPER = 680
"""Width of A4 between margins of 1.5 cm [px]."""
PIXEL = 1.0
"""To which a browser rounds the place of a box [px]."""


def page_of(folder: Path) -> str:
    """The address of the page of all runs in a folder."""
    done = command("report", *sorted(folder.iterdir()), "--out", folder / "report.html")
    assert done.exit_code == 0, done.output
    return (folder / "report.html").as_uri()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("report")
    run(chains(400.0, experiment={"kind": "pull_off", "preload": 0.5}), folder / "run", figures=False)
    return page_of(folder)


@pytest.fixture(scope="module")
def loop(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Two cycles of a steel ball on glass, in SI."""
    folder = tmp_path_factory.mktemp("loop")
    ball = contact1d.sphere(radius="10 mm", contact_modulus="70 GPa", tolerance=1e-2)
    cycles = {"amplitude": "0.5 µm", "number": 2, "points": 8}
    ball.tangential("10 N", 0.3, folder / "run", cycles=cycles)
    return page_of(folder)


@pytest.fixture(scope="module")
def overlaid(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Two loads in common panels, whose legends have long names, and a third one a thousand times as small."""
    folder = tmp_path_factory.mktemp("overlaid")
    ball = contact1d.sphere(radius="10 mm", contact_modulus="70 GPa", tolerance=1e-2)
    for force in ("10 N", "5 N", "5 mN"):
        ball.load(force, folder / f"steel ball on glass under {force}")
    return page_of(folder)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        yield chromium
        chromium.close()


def test_the_slider_moves_force_profile_and_words_by_mouse_and_keyboard(browser: Any, address: str) -> None:
    page = browser.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda asked: None if asked.url.startswith(HERE) else errors.append(asked.url))
    page.goto(address, timeout=PATIENCE)
    assert page.locator(".js-plotly-plot").count() >= 5
    titles = page.locator(".modebar-btn").evaluate_all("buttons => buttons.map(one => one.dataset.title)")
    assert titles
    assert not [title for title in titles if "share" in str(title).lower()], "a chart would be uploaded"

    def state() -> tuple[Any, ...]:
        return (
            page.evaluate("document.getElementById('path-0').data.at(-1).y[0]"),
            page.evaluate("document.getElementById('path-1').data[0].y.join()"),
            page.evaluate("document.getElementById('path-2').data[0].y.join()"),
            page.locator("#words").inner_text(),
        )

    slider = page.locator("#state")
    slider.focus()
    page.keyboard.press("Home")
    first = state()
    page.keyboard.press("ArrowRight")
    second = state()
    page.keyboard.press("End")
    last = state()
    assert all(a != b for a, b in zip(first, second, strict=True))
    assert all(a != b for a, b in zip(second, last, strict=True))
    assert first[3].startswith("1 of ")
    assert slider.get_attribute("aria-valuetext") in last[3]
    assert errors == []


@pytest.mark.parametrize("width", SCREENS)
def test_a_loop_is_drawn_leg_by_leg_in_si_beside_mindlins_and_its_axes_change_by_keyboard(
    browser: Any, loop: str, width: int
) -> None:
    page = browser.new_page(viewport=PHONE | {"width": width})
    page.goto(loop, timeout=PATIENCE)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    chart = page.evaluate("(({data, layout}) => ({data, layout}))(document.getElementById('chart-0'))")
    legs = [trace for trace in chart["data"] if trace["line"]["color"] != THEORY]
    assert len(legs) >= 4
    for leg in legs:
        steps = {after > before for before, after in itertools.pairwise(leg["x"])}
        assert len(steps) == 1, "a leg goes one way"
    assert "Cattaneo–Mindlin" in {trace["name"] for trace in chart["data"]}
    assert chart["layout"]["xaxis"]["title"]["text"] == "tangential displacement (nm)"
    assert chart["layout"]["yaxis"]["title"]["text"] == "tangential force (N)"
    words = page.locator("body").inner_text()
    assert not re.search(r"\b[LF]U\b", words), "the scene is in SI"
    pressure = page.locator("figure", has_text="Pressure over distance").first.get_by_label("logarithmic y")
    pressure.focus()
    page.keyboard.press("Space")
    drawn = page.evaluate("[...document.querySelectorAll('.chart')].map(one => one.layout?.yaxis.type)")
    assert "log" in drawn


def box_of(one: Any) -> tuple[float, float, float, float]:
    """Left, top, right and bottom of what is on a page [px]."""
    box = one.bounding_box()
    return box["x"], box["y"], box["x"] + box["width"], box["y"] + box["height"]


def apart(one: Any, other: Any) -> bool:
    """Whether two boxes have nothing in common."""
    a, b = box_of(one), box_of(other)
    return any(a[i + 2] <= b[i] + PIXEL or b[i + 2] <= a[i] + PIXEL for i in range(2))


def within(one: Any, other: Any) -> bool:
    """Whether a box is inside of another one."""
    a, b = box_of(one), box_of(other)
    return all(a[i] >= b[i] - PIXEL and a[i + 2] <= b[i + 2] + PIXEL for i in range(2))


@pytest.mark.parametrize("width", SCREENS)
@pytest.mark.parametrize("name", ["address", "loop", "overlaid"])
def test_the_tool_bar_covers_neither_legend_nor_plot_and_no_figure_is_cut(
    name: str, width: int, browser: Any, request: pytest.FixtureRequest
) -> None:
    page = browser.new_page(viewport=PHONE | {"width": width})
    page.goto(request.getfixturevalue(name), timeout=PATIENCE)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    panels = page.locator(".panel").all()
    assert panels
    for panel in panels:
        chart, plot = panel.locator(".chart"), panel.locator(".bglayer, .nsewdrag").last
        chart.hover()
        tools = panel.locator(".modebar")
        assert apart(tools, plot)
        for legend in panel.locator(".legend").all():
            assert apart(tools, legend)
            assert apart(chart, legend)
            assert within(legend, panel)
            assert all(within(words, legend) for words in legend.locator("button").all())
        for words in panel.locator(".xtitle, .ytitle, .xtick, .ytick, .modebar").all():
            assert within(words, chart), words.text_content()


def test_on_paper_a_figure_is_whole(browser: Any, overlaid: str) -> None:
    """It was drawn for the screen, and keeps its size; the browser's own print layout is that of a narrower page."""
    page = browser.new_page(viewport=PHONE)
    page.goto(overlaid, timeout=PATIENCE)
    page.emulate_media(media="print")
    assert not page.locator("#state").is_visible()
    assert page.get_by_text("displacement").first.is_visible()
    panels = [panel for panel in page.locator(".panel").all() if panel.is_visible()]
    assert panels
    for panel in panels:
        picture = panel.locator(".main-svg").first
        assert picture.bounding_box()["width"] <= PAPER
        assert within(picture, panel)
        assert all(apart(picture, legend) for legend in panel.locator(".legend").all())
