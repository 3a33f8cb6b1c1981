"""What every Python test shares: where the scene data lies, how a window becomes a numpy picture, and
that no VTK error or warning passes unnoticed."""

import os
import pathlib
import re

import numpy as np
import pytest

import vtkhybrid  # noqa: F401  (first, so that a broken package fails with its own message)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkWindowToImageFilter


def pytest_configure(config):
    config.addinivalue_line(
        "markers",
        "expects_vtk_messages(regex, ...): the test provokes VTK errors or warnings; each regex must "
        "be found in a message and each message must match one (none given: any message, or none)",
    )


_skipped = {}


def pytest_runtest_logreport(report):
    if report.skipped:
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        _skipped[report.nodeid] = reason.removeprefix("Skipped: ")


def pytest_sessionfinish(session):
    """Leaves the skipped tests where ctest can list them: it hides the output of a file that passed."""
    folder = os.environ.get("HRT_SKIP_FOLDER")
    if not folder:
        return
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    for file in {pathlib.Path(item.location[0]).stem for item in session.items}:
        report = pathlib.Path(folder, file + ".txt")
        lines = [f"{n}: {r}" for n, r in _skipped.items() if file + ".py::" in n]
        if lines:
            report.write_text("\n".join(lines) + "\n", encoding="utf-8")
        else:
            report.unlink(missing_ok=True)


@pytest.fixture(scope="session")
def data_root():
    """The folder of the scene data as a pathlib.Path. Skips where there is none."""
    root = os.environ.get("HRT_DATA_ROOT") or os.environ.get("HRT_DEFAULT_DATA_ROOT")
    if not root or not pathlib.Path(root).is_dir():
        pytest.skip("no scene data: set HRT_DATA_ROOT (see Data/README.md)")
    return pathlib.Path(root)


@pytest.fixture
def data_file(data_root):
    """data_file("bunny/bunny.ply") -> its path as a str; skips, naming it, where it is absent."""

    def find(name):
        path = data_root / name
        if not path.is_file():
            pytest.skip(f"scene data {name} is absent (see Data/README.md)")
        return str(path)

    return find


def render_to_numpy(window):
    """Renders `window` off screen, once, and returns its colours: uint8, (height, width, 3), row 0 at
    the bottom."""
    window.SetOffScreenRendering(1)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGB()
    grab.ReadFrontBufferOff()
    # The picture of the very frame whose counters the test reads, not of a second one.
    grab.ShouldRerenderOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    colors = vtk_to_numpy(image.GetPointData().GetScalars())
    # The filter's memory goes with the filter.
    return colors.reshape(height, width, 3).copy()


@pytest.fixture
def render():
    """render(window) renders a vtkRenderWindow; render(renderer, size=(300, 300)) makes a window
    without multisampling for a vtkRenderer first (the same one again for a later call with the same
    renderer). Both return numpy uint8, (height, width, 3), row 0 at the bottom."""
    windows = {}

    def draw(target, size=(300, 300)):
        if isinstance(target, vtkRenderWindow):
            return render_to_numpy(target)
        if target not in windows:
            window = vtkRenderWindow()
            window.SetOffScreenRendering(1)
            window.SetMultiSamples(0)
            window.AddRenderer(target)
            windows[target] = window
        windows[target].SetSize(*size)
        return render_to_numpy(windows[target])

    yield draw
    for window in windows.values():
        window.Finalize()


@pytest.fixture(autouse=True)
def vtk_messages(request):
    """The VTK errors and warnings of this test, a list of str. One that the test has not declared by
    the marker expects_vtk_messages fails it."""
    messages = []

    def note(_window, event, text):
        messages.append(f"{event}: {text.strip()}")

    note.CallDataType = "string0"
    output = vtkOutputWindow.GetInstance()
    tags = [output.AddObserver(event, note) for event in ("ErrorEvent", "WarningEvent")]
    yield messages
    for tag in tags:
        output.RemoveObserver(tag)

    marker = request.node.get_closest_marker("expects_vtk_messages")
    if marker is not None and not marker.args:
        return
    expected = marker.args if marker is not None else ()
    unexpected = [m for m in messages if not any(re.search(regex, m) for regex in expected)]
    missing = [regex for regex in expected if not any(re.search(regex, m) for m in messages)]
    if unexpected:
        pytest.fail("VTK said:\n" + "\n".join(unexpected), pytrace=False)
    if missing:
        pytest.fail(f"VTK did not say: {missing}", pytrace=False)
