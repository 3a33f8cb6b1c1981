"""The example sort_first.py: one picture by several processes is that of one process, with and without
MPI, and also when a process is killed while it draws."""

import argparse
import importlib.util
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

import pytest

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "Examples" / "Python"
SCRIPT = EXAMPLES / "sort_first.py"
SIZE = ["--size", "200x150", "--tiles", "4x3"]
SECONDS = 120  # for one run; it takes 3 to 8 on two cores


def environment(**more):
    result = dict(os.environ)
    # Containers often run as root, which Open MPI refuses unless told twice.
    result.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", **more)
    return result


def mpirun(ranks):
    """The start of a command line for so many ranks. Skips where there is no MPI."""
    program = shutil.which("mpirun")
    if program is None:
        pytest.skip("no mpirun (Debian's package openmpi-bin)")
    if importlib.util.find_spec("mpi4py") is None:
        pytest.skip("no mpi4py (Debian's package python3-mpi4py)")
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    # More ranks than cores, none tied to a core.
    options = ["--oversubscribe", "--bind-to", "none"] if "Open MPI" in version else []
    return [program, *options, "-np", str(ranks)]


def command(picture, *options):
    return [sys.executable, str(SCRIPT), str(picture), *SIZE, *options]


def run(line, **more):
    done = subprocess.run(line, env=environment(**more), capture_output=True, text=True, timeout=SECONDS)
    print(done.stdout, done.stderr, sep="")
    return done


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    """The picture of one process that draws one tile."""
    picture = tmp_path_factory.mktemp("sort_first") / "one.png"
    done = run([sys.executable, str(SCRIPT), str(picture), *SIZE[:2], "--tiles", "1x1"])
    assert done.returncode == 0
    return picture.read_bytes()


def check_of(output):
    """What --check found: pixels that differ, and of how many."""
    found = re.search(r"(\d+) of (\d+) pixels differ", output)
    return tuple(int(number) for number in found.groups())


@pytest.mark.parametrize("workers", [1, 3])
def test_processes_of_this_machine(tmp_path, reference, workers):
    picture = tmp_path / "picture.png"
    done = run(command(picture, "--check", "--workers", str(workers)))
    assert done.returncode == 0
    assert check_of(done.stdout) == (0, 200 * 150)
    assert picture.read_bytes() == reference


@pytest.mark.parametrize("ranks", [2, 4])
def test_ranks_of_mpi(tmp_path, reference, ranks):
    picture = tmp_path / "picture.png"
    done = run([*mpirun(ranks), *command(picture, "--check", "--verbose")])
    assert done.returncode == 0
    assert check_of(done.stdout) == (0, 200 * 150)
    assert picture.read_bytes() == reference
    assert f"by {ranks} processes of {ranks} ranks" in done.stdout
    assert len(set(re.findall(r"rank (\d): tile \d+ begun", done.stdout))) > 1


def kill_one(line):
    """Runs it, kills the first process that says it draws a tile, and returns the rest of the output."""
    victim = None
    output = []
    with subprocess.Popen(line, env=environment(), stdout=subprocess.PIPE, text=True) as program:
        try:
            for text in program.stdout:
                output.append(text)
                begun = re.search(r"begun by process (\d+)", text)
                if begun and victim is None:
                    victim = int(begun.group(1))
                    os.kill(victim, signal.SIGKILL)
            status = program.wait(timeout=SECONDS)
        finally:
            program.kill()
    print("".join(output))
    assert victim is not None
    return status, victim, "".join(output)


@pytest.mark.parametrize("ranks", [0, 2], ids=["processes", "ranks"])
def test_killed_worker(tmp_path, reference, ranks):
    picture = tmp_path / "picture.png"
    start = mpirun(ranks) if ranks else []
    workers = [] if ranks else ["--workers", "2"]
    status, victim, output = kill_one([*start, *command(picture, "--check", "--verbose", *workers)])
    assert status == 0
    assert re.search(rf"tile \d+ is drawn again: process {victim} ended with -{signal.SIGKILL:d}", output)
    assert check_of(output) == (0, 200 * 150)
    assert picture.read_bytes() == reference


@pytest.fixture
def example(monkeypatch):
    """The script as a module."""
    monkeypatch.syspath_prepend(str(EXAMPLES))
    return importlib.import_module("sort_first")


def test_a_tile_that_kills_every_process_is_given_up(example, capfd):
    """A scene that no worker can make."""
    said = []
    worker = example.Worker(
        argparse.Namespace(scene="none", size=(8, 8)), lambda text, important: said.append(text)
    )
    with pytest.raises(RuntimeError, match="3 processes have died of tile 0"):
        worker.render(example.Tile("tile 0", (0, 8, 0, 8)))
    assert len(said) == 3 and all("ended with 1" in text for text in said)
    assert "KeyError" in capfd.readouterr().err, "what the processes died of is seen"


@pytest.mark.parametrize("size, tiles", [((7, 5), (3, 2)), ((4, 3), (4, 3)), ((800, 600), (1, 1))])
def test_tiles_cover_each_pixel_once(example, size, tiles):
    covered = [0] * (size[0] * size[1])
    for tile in example.cut(size, tiles):
        x0, x1, y0, y1 = tile.bounds
        assert x0 < x1 and y0 < y1
        for y in range(y0, y1):
            for x in range(x0, x1):
                covered[y * size[0] + x] += 1
    assert set(covered) == {1}


def test_mpirun_without_mpi4py_names_the_package(tmp_path):
    (tmp_path / "mpi4py.py").write_text("raise ImportError('not here')", encoding="utf-8")
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    done = run(command(tmp_path / "picture.png"), OMPI_COMM_WORLD_SIZE="2", PYTHONPATH=path)
    assert done.returncode != 0
    assert "python3-mpi4py" in done.stderr


@pytest.mark.parametrize("options", [["--tiles", "300x1"], ["--tiles", "wide"]])
def test_wrong_options_are_refused(tmp_path, options):
    done = run(command(tmp_path / "picture.png", *options))
    assert done.returncode == 2 and "error:" in done.stderr
