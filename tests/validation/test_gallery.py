"""Claim: every result of the gallery is within its uncertainty of the closed form, and docs/gallery.md shows them."""

import pytest

from docs.gallery import page
from tests.pages import require_shown
from validation.gallery import PROBLEMS, Problem


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_a_result_is_within_its_uncertainty(problem: Problem) -> None:
    assert problem.over <= 1.0


def test_the_page_shows_them() -> None:
    require_shown("docs/gallery.md", "gallery", page())
