"""What all benchmarks share: the models, how a window is made, and what a frame costs in it."""

import os
import pathlib
import platform
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "Python"))

import scenes  # noqa: E402
from vtkhybrid import __version__, vtkHybridMaterial  # noqa: E402
from vtkmodules.vtkCommonCore import vtkVersion  # noqa: E402
from vtkmodules.vtkRenderingCore import vtkRenderWindow  # noqa: E402

SIZE = (800, 600)
WARM_UP = 3


def model_on_floor(model, mirror=False, glass=False):
    """The model on a floor under one spot light. Returns the renderer and the light."""
    floor = scenes.actor_of(scenes.plane(1.6, -0.45), Color=(0.6, 0.6, 0.65))
    if mirror:
        vtkHybridMaterial.SetReflectance(floor, 0.4)
    thing = scenes.actor_of(model, Color=(0.9, 0.7, 0.5), Specular=0.3, SpecularPower=20.0)
    if glass:
        vtkHybridMaterial.SetGlass(thing, 1.5)
    thing.SetOrigin(*thing.GetCenter())
    bounds = thing.GetBounds()
    thing.SetScale(1.0 / max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]))
    thing.AddPosition(*(-c for c in thing.GetCenter()))
    renderer = scenes.renderer_of(floor, thing)
    light = scenes.scene_light((1, 3, 2), positional=True, ConeAngle=30.0)
    renderer.AddLight(light)
    scenes.look(renderer, (0.3, 0.7, 2.2), (0, -0.05, 0))
    return renderer, light


def window_of(renderer):
    """An off-screen window of SIZE without multisampling."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    return window


def timed(window):
    """Wall-clock milliseconds of a whole Render, the GL commands finished."""
    start = time.perf_counter()
    window.Render()
    window.WaitForCompletion()
    return 1000 * (time.perf_counter() - start)


def device_of(window):
    return next(
        (s.partition(":")[2].strip() for s in window.ReportCapabilities().splitlines()
         if "renderer string" in s), "unknown")


def header():
    """What a file of results says about its machine."""
    return {"vtkhybrid": __version__, "vtk": vtkVersion.GetVTKVersion(), "size": SIZE,
            "cores": os.cpu_count(), "machine": platform.machine()}


def models():
    """(name, source) of the models that are at hand."""
    yield "torus", scenes.torus()
    root = os.environ.get("HRT_DATA_ROOT")
    path = pathlib.Path(root, "bunny/bunny.ply") if root else None
    if path and path.is_file():
        yield "bunny", scenes.bunny(str(path))
    else:
        print("bunny: skipped, no scene data (see Data/README.md)")


def robots_file():
    """Where the robots are; None, and a word about it, where they are not."""
    root = os.environ.get("HRT_DATA_ROOT")
    path = pathlib.Path(root, "bart/robots/aff/Robot.aff") if root else None
    if path and path.is_file():
        return str(path)
    print("robots: skipped, no scene data (see Data/README.md)")
    return None
