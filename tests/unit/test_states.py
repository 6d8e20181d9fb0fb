"""Profiles that are kept for the eye: how many, which, and what of a file of them is refused."""

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from contact1d.analysis.curve import States, read_states, states_of, write_states
from contact1d.analysis.pressure import Profile


def passed(rows: int, particles: int) -> list[Profile]:
    """Each number tells its row, its column and its particle."""
    x = np.arange(float(particles))
    return [Profile(x, *(x + 100.0 * kind + 1e4 * row for kind in range(1, 5))) for row in range(rows)]


@pytest.mark.parametrize("most", [10, 40, 41])
def test_as_many_states_are_kept_as_numbers_fit_evenly_with_both_ends(most: int) -> None:
    for rows in (1, 2, 7, 20):
        for particles in (1, 2, 5, 19, 20, 21, 50):
            profiles = passed(rows, particles)
            found = states_of(profiles, most_numbers=most)
            kept = found.x[0].astype(int).tolist()
            assert found.rows.size == min(rows, most // len(kept))
            assert len(kept) == min(particles, most // 2)
            for chosen, count in ((found.rows.tolist(), rows), (kept, particles)):
                assert chosen[0] == 0
                assert chosen[-1] == count - 1
                steps = np.diff(chosen)
                assert steps.size == 0 or (steps.min() >= 1 and np.ptp(steps) <= 1)
            for kind, name in enumerate(("z_lower", "z_upper", "pressure", "shear"), start=1):
                expected = np.array(kept) + 100.0 * kind + 1e4 * found.rows[:, None]
                assert getattr(found, name) == pytest.approx(expected, rel=1e-6)


def test_states_come_back_and_what_holds_objects_or_lacks_a_column_is_refused(tmp_path: Path) -> None:
    kept, path = states_of(passed(4, 3)), tmp_path / "states.npz"
    write_states(path, kept)
    for field in fields(States):
        np.testing.assert_array_equal(getattr(read_states(path), field.name), getattr(kept, field.name))
    with pytest.raises(ValueError, match="Object arrays"):
        write_states(path, replace(kept, x=np.array([None], dtype=object)))
    columns = {field.name: getattr(kept, field.name) for field in fields(States)}
    np.savez(path, **{name: column for name, column in columns.items() if name not in ("x", "shear")})
    with pytest.raises(ValueError, match="no x, shear"):
        read_states(path)
    np.savez(path, **columns | {"x": np.array([None], dtype=object)})
    with pytest.raises(ValueError, match="Object arrays"):
        read_states(path)
