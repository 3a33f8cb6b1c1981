"""The robots of BART, the benchmark for animated ray tracing, on their parade through a city: mirrors in
the street, in the walls and on the robots themselves.

    ./run python Examples/Python/robots.py [picture.png] [options]

With --frames N it draws N frames, spread over the whole animation, into picture_000.png ...
The scene is public but not part of this repository: Data/README.md says where it comes from.
"""

import argparse
import pathlib
import sys
import time

from common import save, scene_data, window_of
from vtkhybrid import statistics, vtkHybridBARTImporter, vtkHybridRayTracingPass
from vtkmodules.vtkRenderingCore import vtkRenderer

SCENE = "bart/robots/aff/Robot.aff"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("picture", nargs="?", type=pathlib.Path, default="robots.png")
    parser.add_argument("--time", type=float, default=27.0, help="moment of a single picture, 0 to 50")
    parser.add_argument("--frames", type=int, default=1, help="pictures of the whole animation")
    parser.add_argument("--size", type=int, nargs=2, default=(800, 600), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument(
        "--textures", action=argparse.BooleanOptionalAction, default=True, help="the scene's 44 images"
    )
    return parser.parse_args()


def moments(importer, options):
    """The times to draw and the file of each."""
    if options.frames < 2:
        return [(options.time, options.picture)]
    last = importer.GetNumberOfFrames() - 1
    frames = [round(i * last / (options.frames - 1)) for i in range(options.frames)]
    name = options.picture
    return [
        (importer.GetFrameTime(frame), name.with_name(f"{name.stem}_{i:03d}{name.suffix}"))
        for i, frame in enumerate(frames)
    ]


def main():
    options = arguments()
    path = scene_data(SCENE)
    if path is None:
        print(
            f"The scene {SCENE} is absent: nothing to draw.\n"
            "Set HRT_DATA_ROOT to the folder that holds it; Data/README.md says where it comes from.",
            file=sys.stderr,
        )
        return 1

    importer = vtkHybridBARTImporter()
    importer.SetFileName(path)
    importer.SetTextures(options.textures)
    if not importer.Read():
        return 1  # the importer has said why
    print(
        f"{importer.GetNumberOfTriangles():,d} triangles in {importer.GetActors().GetNumberOfItems():,d}"
        f" actors, {importer.GetNumberOfKeyedTransforms()} moving transforms"
    )

    renderer = vtkRenderer()
    importer.AddTo(renderer)
    # Panes before panes: peel them apart instead of blending them in any order.
    renderer.UseDepthPeelingOn()
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    window = window_of(renderer, options.size)
    window.SetMultiSamples(0)

    for moment, picture in moments(importer, options):
        importer.SetTime(moment)
        start = time.perf_counter()
        window.Render()
        seconds = time.perf_counter() - start
        traced = sum(kind["traced"] for kind in statistics(rt)["rays"].values())
        save(window, picture)
        print(f"wrote {picture}: time {moment:.2f}, {traced:,d} rays traced, {seconds:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
