"""One picture by several processes, each with an OpenGL context of its own: sort first. The picture is cut
into tiles, whoever is free takes the next one, and what comes back is put together - byte for byte the
picture that one process draws.

    ./run python Examples/Python/sort_first.py [picture.png] [--workers N] [options]
    mpirun -np N ./run python Examples/Python/sort_first.py [picture.png] [options]

Without mpirun the workers are processes of this machine (--workers, by default one). With mpirun every
rank has --workers of them; rank 0 also hands out the tiles. In both cases a rank does not draw: it
supervises processes that do, so that one that dies takes nothing along. Its tile is drawn again.

--check also draws the picture in one go, and fails unless triangle numbers and colours are the same.
"""

import argparse
import collections
import concurrent.futures
import math
import multiprocessing
import os
import pathlib
import sys
import threading
import time
import typing

import numpy as np
from common import actor, save_pixels, scene_data, torus, window_of
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer

ATTEMPTS = 3  # a tile that so many processes have died of is given up
POLL = 0.001  # seconds; MPI's own waiting would keep a core busy that others draw with


# -- scenes: every worker makes its own, of the same numbers ------------------------------------------


def rings():
    """Twelve tori around a glass ball on a mirror floor: parts that a tile may leave out."""
    plane = vtkPlaneSource()
    plane.SetOrigin(-7, 0, -7)
    plane.SetPoint1(-7, 0, 7)
    plane.SetPoint2(7, 0, -7)
    floor = actor(plane, (0.6, 0.63, 0.68))
    vtkHybridMaterial.SetReflectance(floor, 0.35)
    sphere = vtkSphereSource()
    sphere.SetRadius(1.1)
    sphere.SetThetaResolution(120)
    sphere.SetPhiResolution(120)
    ball = actor(sphere, (1, 1, 1), specular=0.6, power=40)
    ball.SetPosition(0, 1.1, 0)
    vtkHybridMaterial.SetGlass(ball, 1.5)
    mesh = torus(0.6, 0.22, resolution=(80, 40))
    parts = [floor, ball]
    for i in range(12):
        angle = 2 * math.pi * i / 12
        color = [0.55 + 0.4 * math.cos(angle + shift) for shift in (0.0, 2.1, 4.2)]
        ring = actor(mesh, color, specular=0.4, power=40)
        ring.RotateX(25 * (i % 3))
        ring.RotateY(30 * i)
        ring.SetPosition(3.1 * math.cos(angle), 0.85, 3.1 * math.sin(angle))
        parts.append(ring)
    renderer = vtkRenderer()
    renderer.SetBackground(0.85, 0.88, 0.92)
    renderer.SetBackground2(0.25, 0.4, 0.65)
    renderer.GradientBackgroundOn()
    for part in parts:
        renderer.AddActor(part)
    lamp = vtkLight()
    lamp.SetLightTypeToSceneLight()
    lamp.PositionalOn()
    lamp.SetPosition(3, 8, 5)
    lamp.SetFocalPoint(0, 0.5, 0)
    lamp.SetConeAngle(45)
    renderer.AddLight(lamp)
    renderer.GetActiveCamera().SetPosition(1.5, 4.2, 10)
    renderer.GetActiveCamera().SetFocalPoint(0, 0.7, 0)
    renderer.ResetCameraClippingRange()
    return renderer


def bunny():
    import demo

    return demo.scene(demo.bunny(scene_data(DATA["bunny"])), mirror=True, glass=True)


def robots():
    from vtkhybrid import vtkHybridBARTImporter

    importer = vtkHybridBARTImporter()
    importer.SetFileName(scene_data(DATA["robots"]))
    importer.TexturesOff()  # textured actors would be drawn by VTK
    if not importer.Read():
        raise RuntimeError("the scene could not be read")
    renderer = vtkRenderer()
    importer.AddTo(renderer)
    importer.SetTime(27.0)
    renderer.UseDepthPeelingOn()
    return renderer


SCENES = {"rings": rings, "bunny": bunny, "robots": robots}
DATA = {"bunny": "bunny/bunny.ply", "robots": "bart/robots/aff/Robot.aff"}


# -- a worker: a process that draws tiles -------------------------------------------------------------


class Tile(typing.NamedTuple):
    name: str
    bounds: tuple  # x0, x1, y0, y1: as SetPixelBounds takes them


class Piece(typing.NamedTuple):
    """What a worker has drawn."""

    tile: Tile
    ids: np.ndarray     # triangle numbers, (height, width), row 0 at the bottom
    colors: np.ndarray  # (height, width, 3), 8 bits
    triangles: int      # rasterised
    seconds: float


def draw(tile, window, rt):
    x0, x1, y0, y1 = tile.bounds
    start = time.perf_counter()
    rt.SetPixelBounds(x0, x1, y0, y1)
    window.Render()
    colors = vtkUnsignedCharArray()
    window.GetPixelData(x0, y0, x1 - 1, y1 - 1, 0, colors, 0)
    return Piece(
        tile,
        buffer(rt, "triangle")[y0:y1, x0:x1].copy(),
        vtk_to_numpy(colors).reshape(y1 - y0, x1 - x0, 3).copy(),
        statistics(rt)["triangles_drawn"],
        time.perf_counter() - start,
    )


def serve(connection, scene, size):
    """The whole life of a worker: tiles come in, pieces go out, until nobody is there to ask."""
    renderer = SCENES[scene]()
    rt = vtkHybridRayTracingPass()
    rt.SetBuffers(["triangle"])
    renderer.SetPass(rt)
    # The whole picture's size: a tile is a part of it, not a small picture of its own.
    window = window_of(renderer, size)
    window.SetMultiSamples(0)
    renderer.AddObserver("StartEvent", lambda *_: connection.send("begun"))
    try:
        while True:
            connection.send(draw(connection.recv(), window, rt))
    except (EOFError, BrokenPipeError):
        pass


class Worker:
    """A process that draws and its place in this one. When the process dies another takes over."""

    def __init__(self, options, say):
        self.what = (options.scene, options.size)
        self.say = say
        self.process = None

    def render(self, tile):
        for _ in range(ATTEMPTS):
            try:
                self.begin()
                self.connection.send(tile)
                while (message := self.connection.recv()) == "begun":
                    self.say(f"{tile.name} begun by process {self.process.pid}")
                return message
            except (EOFError, OSError):
                self.bury(tile)
        raise RuntimeError(f"{ATTEMPTS} processes have died of {tile.name}")

    def begin(self):
        if self.process is None:
            # Not forked: neither MPI nor threads would survive that in the child.
            context = multiprocessing.get_context("spawn")
            self.connection, theirs = context.Pipe()
            self.process = context.Process(target=serve, args=(theirs, *self.what), daemon=True)
            self.process.start()
            theirs.close()  # so that its end is heard as the end of the stream

    def bury(self, tile):
        self.process.join()
        self.say(
            f"{tile.name} is drawn again: process {self.process.pid} ended with"
            f" {self.process.exitcode}", important=True
        )
        self.close()

    def close(self):
        if self.process is not None:
            self.connection.close()
            self.process.join()
            self.process = None


# -- the queue: one exchange brings the last piece in and the next tile out ---------------------------


class TileQueue:
    def __init__(self, tiles):
        self.lock = threading.Lock()
        self.waiting = collections.deque(tiles)
        self.total = len(tiles)
        self.pieces = []

    def exchange(self, piece):
        with self.lock:
            if piece is not None:
                self.pieces.append(piece)
            return self.waiting.popleft() if self.waiting else None

    def complete(self):
        return len(self.pieces) == self.total

    def serve_ranks(self, comm, workers, watch):
        """Answers the other ranks' exchanges until each of their workers has been told to stop."""
        from mpi4py import MPI

        stopped = []
        while not (self.complete() and len(stopped) == workers):
            watch()
            status = MPI.Status()
            if not comm.Iprobe(status=status):
                time.sleep(POLL)
                continue
            asker = {"dest": status.Get_source(), "tag": status.Get_tag()}
            piece = comm.recv(source=asker["dest"], tag=asker["tag"])
            tile = self.exchange(piece)
            if tile is None:
                stopped.append(asker)
            else:
                comm.send(tile, **asker)
        for asker in stopped:
            comm.send(None, **asker)


class RemoteQueue:
    """The same exchange with the queue of rank 0."""

    def __init__(self, comm, number, lock):
        self.comm = comm
        self.number = number
        self.lock = lock

    def exchange(self, piece):
        with self.lock:
            self.comm.send(piece, dest=0, tag=self.number)
        while True:
            with self.lock:
                if self.comm.Iprobe(source=0, tag=self.number):
                    return self.comm.recv(source=0, tag=self.number)
            time.sleep(POLL)


def work(worker, queue):
    piece = None
    try:
        while (tile := queue.exchange(piece)) is not None:
            piece = worker.render(tile)
    finally:
        worker.close()


# -- the program --------------------------------------------------------------------------------------


def arguments():
    def pair(text):
        width, height = (int(word) for word in text.lower().split("x"))
        if width < 1 or height < 1:
            raise ValueError(text)
        return width, height

    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("picture", nargs="?", type=pathlib.Path, help="file to write (sort_first.png)")
    parser.add_argument("--output", type=pathlib.Path, help="the same")
    parser.add_argument("--size", type=pair, default=(800, 600), metavar="WxH", help="pixels")
    parser.add_argument("--tiles", type=pair, default=(4, 3), metavar="CxR", help="columns and rows")
    parser.add_argument("--workers", type=int, default=1, help="processes that draw, of each rank")
    parser.add_argument("--scene", choices=SCENES, default="rings")
    parser.add_argument("--check", action="store_true", help="compare with the picture of one process")
    parser.add_argument("--verbose", action="store_true", help="say who draws which tile")
    options = parser.parse_args()
    if options.workers < 1 or any(t > s for t, s in zip(options.tiles, options.size)):
        parser.error("there must be a worker, and a pixel for each row and column of tiles")
    if options.scene in DATA and scene_data(DATA[options.scene]) is None:
        parser.error(f"{DATA[options.scene]} is absent: set HRT_DATA_ROOT (see Data/README.md)")
    options.picture = options.output or options.picture or pathlib.Path("sort_first.png")
    return options


def communicator():
    """MPI's ranks where mpirun has started this, else None."""
    if not any(name in os.environ for name in ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")):
        return None
    try:
        from mpi4py import MPI
    except ImportError as error:
        sys.exit(f"mpirun needs mpi4py for this Python, Debian's package python3-mpi4py: {error}")
    return MPI.COMM_WORLD


def cut(size, tiles):
    edges = [[s * i // t for i in range(t + 1)] for s, t in zip(size, tiles)]
    return [
        Tile(f"tile {column + row * tiles[0]}", (*edges[0][column : column + 2], *edges[1][row : row + 2]))
        for row in range(tiles[1])
        for column in range(tiles[0])
    ]


def assemble(pieces, size):
    ids = np.empty((size[1], size[0]), np.int64)
    colors = np.empty((size[1], size[0], 3), np.uint8)
    for piece in pieces:
        x0, x1, y0, y1 = piece.tile.bounds
        ids[y0:y1, x0:x1] = piece.ids
        colors[y0:y1, x0:x1] = piece.colors
    return ids, colors


def check(options, say, ids, colors, triangles):
    """Whether one process that draws all pixels at once gets the same bytes."""
    worker = Worker(options, say)
    single = worker.render(Tile("the whole picture", (0, options.size[0], 0, options.size[1])))
    worker.close()
    different = (single.ids != ids) | (single.colors != colors).any(axis=2)
    print(f"{triangles:,d} triangles rasterised for the tiles, {single.triangles:,d} for one picture")
    print(f"{different.sum()} of {ids.size} pixels differ from the picture of one process")
    return not different.any()


def run(options, comm):
    rank, ranks = (comm.Get_rank(), comm.Get_size()) if comm else (0, 1)

    def say(text, important=False):
        if important or options.verbose:
            print(f"rank {rank}: {text}", flush=True)

    start = time.perf_counter()
    workers = [Worker(options, say) for _ in range(options.workers)]
    lock = threading.Lock()
    queue = TileQueue(cut(options.size, options.tiles)) if rank == 0 else None
    with concurrent.futures.ThreadPoolExecutor(options.workers) as threads:
        futures = [
            threads.submit(work, worker, queue or RemoteQueue(comm, number, lock))
            for number, worker in enumerate(workers)
        ]

        def watch():
            for future in futures:
                if future.done():
                    future.result()  # raises what the thread has died of

        if rank == 0 and ranks > 1:
            queue.serve_ranks(comm, (ranks - 1) * options.workers, watch)
    watch()
    if rank > 0:
        return 0
    seconds = time.perf_counter() - start
    ids, colors = assemble(queue.pieces, options.size)
    save_pixels(colors, options.picture)
    print(
        f"wrote {options.picture}: {queue.total} tiles by {ranks * options.workers} processes of {ranks}"
        f" ranks in {seconds:.1f} s, {sum(piece.seconds for piece in queue.pieces):.1f} s of drawing"
    )
    triangles = sum(piece.triangles for piece in queue.pieces)
    return 0 if not options.check or check(options, say, ids, colors, triangles) else 1


def main():
    options = arguments()
    comm = communicator()
    try:
        return run(options, comm)
    except Exception as error:
        if comm is None:
            raise
        print(f"rank {comm.Get_rank()}: {error}", file=sys.stderr, flush=True)
        comm.Abort(1)  # the others would wait for this rank for ever


if __name__ == "__main__":
    sys.exit(main())
