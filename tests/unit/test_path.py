"""Paths of a law."""

import numpy as np

from contact1d.workflow.laws.path import legs


def test_a_path_that_rests_where_it_turns_has_two_legs() -> None:
    assert legs(np.asarray([0.0, 1.0, 1.0, 2.0, 2.0, 0.5])) == [slice(0, 5), slice(5, 6)]
