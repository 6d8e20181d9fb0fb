"""Replies of a worker: arrays come through the pipe bitwise, into memory of their own, or the loss is noticed."""

from __future__ import annotations

import threading
from multiprocessing import Pipe
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.engine.process import receive
from contact1d.workflow.engine.worker import send

ARRAYS = {
    "id": np.arange(300_000),  # more than a pipe holds
    "x": np.random.default_rng(1).normal(size=(1000, 3)),
    "column": np.random.default_rng(2).normal(size=(50, 3))[:, 1],
    "turned": np.arange(12.0).reshape(3, 4).T,
    "none": np.empty((0, 3)),
}


def passed(reply: tuple[Any, ...]) -> Any:
    """The reply as the parent gets it."""
    ours, theirs = Pipe()
    sender = threading.Thread(target=send, args=(theirs, reply))
    sender.start()
    with ours, theirs:
        got = receive(ours)
        sender.join()
    return got


def test_arrays_come_through_bitwise() -> None:
    outcome, (values, arrays), step = passed(("done", ([0.1, float("inf")], ARRAYS), 7))
    assert (outcome, values, step) == ("done", [0.1, float("inf")], 7)
    for name, array in ARRAYS.items():
        np.testing.assert_array_equal(arrays[name], array)
        assert arrays[name].dtype == array.dtype


def test_an_array_can_be_written_to() -> None:
    got = passed(("done", np.zeros(3)))[1]
    got += 1.0
    assert got.tolist() == [1.0, 1.0, 1.0]


def test_a_reply_without_arrays() -> None:
    assert passed(("refused", "no such compute", 0)) == ("refused", "no such compute", 0)


def test_a_worker_lost_in_the_middle_of_an_array() -> None:
    ours, theirs = Pipe()
    head = b"\x80\x05N."
    theirs.send((head, [100]))
    theirs.close()
    with ours, pytest.raises(EOFError):
        receive(ours)
