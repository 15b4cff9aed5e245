"""Frames: what arrives is what was sent, to the last bit."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from torsional.workbench.frames import decoded, encoded


@given(arrays(np.float64, array_shapes(max_dims=3, max_side=4)), st.text())
def test_every_number_arrives_with_its_bits(values: np.ndarray, name: str) -> None:
    found = decoded(encoded({"a": {name: [values, {"n": values[..., :1]}]}}))["a"][name]
    assert found[0].tobytes() == values.tobytes() and found[0].shape == values.shape
    assert found[1]["n"].tobytes() == np.ascontiguousarray(values[..., :1]).tobytes()


def test_numbers_begin_where_a_float64array_may() -> None:
    for name in ("", "a", "ab", "abc", "ä", "€uro", "0123456"):
        frame = encoded({name: np.ones(2)})
        (size,) = struct.unpack_from("<I", frame)
        assert (4 + size) % 8 == 0 and len(frame) == 4 + size + 16


def test_a_plain_number_that_is_none_is_null() -> None:
    assert decoded(encoded({"a": float("nan"), "b": np.float64("inf"), "c": np.int64(3)})) == {
        "a": None,
        "b": None,
        "c": 3,
    }


def test_what_cannot_be_told_is_refused() -> None:
    with pytest.raises(TypeError):
        encoded({"a": object()})
