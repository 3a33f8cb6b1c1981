"""A short run of Testing/Stress/frames.py: a pass survives what happens to it at random, and shows what
a new one would."""

import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "Stress"))

import frames  # noqa: E402


@pytest.mark.expects_vtk_messages()  # run() judges them itself
@pytest.mark.parametrize("seed", [11, 12])
def test_random_changes(seed):
    assert frames.run(200, seed) == []
