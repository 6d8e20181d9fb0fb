"""Claim: a run in finer settings that contradicts the first is as uncertain as that; no scene can be made to do so."""

from dataclasses import replace

import pytest

from contact1d import run
from contact1d.workflow.runs.refinement import nested
from tests.scenes import chains


def test_a_run_that_contradicts_the_first_is_as_uncertain_as_that() -> None:
    """Each errs by at most what it states, unless the two differ by more than both: then by that share more."""
    fine = run(chains(200.0, experiment={"kind": "load", "force": 3.0})).outcome
    one = fine.results["displacement"]
    given = 10.0 * one.uncertainty  # by a number with ±, which is the same in both
    open_ = replace(one, errors={**one.errors, "input": given}, given=given)
    for apart, factor in ((1.9, 1.0), (2.2, 1.1), (-6.0, 3.0)):
        for own, known in ((one, 0.0), (open_, given)):
            moved = replace(own, value=one.value + apart * one.uncertainty)
            found = nested(replace(fine, results={"displacement": moved}), replace(fine, results={"displacement": own}))
            doubt = found.results["displacement"].uncertainty - known
            assert doubt == pytest.approx(factor * one.uncertainty, rel=1e-9, abs=0.0)
