"""What a frame costs: the hybrid pass beside VTK's own renderer, frame by frame in turn in one window, so
that a noisy machine disturbs both alike. Prints medians with quartiles and the ratio; writes JSON. Then the
core by itself, where hrtCoreBenchmark was built: the kd-tree's build and rays beside Embree's.

    ./run bench [--quick] [--frames N] [--json FILE] [--no-core]

Each case says what changes between its frames. Times are wall-clock milliseconds of a whole
vtkRenderWindow.Render with the GL commands finished, 800 x 600, no multisampling.
"""

import argparse
import json
import os
import pathlib
import platform
import statistics as st
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "Python"))

import scenes  # noqa: E402
from vtkhybrid import (  # noqa: E402
    __version__,
    statistics,
    vtkHybridMaterial,
    vtkHybridRayTracingPass,
)
from vtkmodules.vtkCommonCore import vtkVersion  # noqa: E402
from vtkmodules.vtkRenderingCore import vtkRenderWindow  # noqa: E402

SIZE = (800, 600)
WARM_UP = 3


def scene(model, mirror=False, glass=False):
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


def move_camera(renderer, _light, i):
    renderer.GetActiveCamera().Azimuth(1.0 if i % 20 < 10 else -1.0)


def move_light(_renderer, light, i):
    light.SetPosition(1 + 0.02 * (i % 10), 3, 2)


def move_nothing(_renderer, _light, _i):
    pass


# name, what it shows, scene keywords, pass settings, what changes from frame to frame
CASES = [
    ("no effects", "camera moves", {}, {"ShadowMode": 0}, move_camera),
    ("one shadow map", "camera moves", {}, {}, move_camera),
    ("one shadow map, direct", "camera moves", {}, {"Visibility": 1}, move_camera),
    ("one shadow map", "light moves", {}, {}, move_light),
    ("one shadow map", "still", {}, {}, move_nothing),
    ("mirror floor", "camera moves", {"mirror": True}, {}, move_camera),
    ("mirror floor", "still", {"mirror": True}, {}, move_nothing),
    ("glass model, mirror floor", "camera moves", {"mirror": True, "glass": True}, {}, move_camera),
]


def timed(window):
    start = time.perf_counter()
    window.Render()
    window.WaitForCompletion()
    return 1000 * (time.perf_counter() - start)


def run(model, keywords, settings, move, frames):
    renderer, light = scene(model, **keywords)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    rt = vtkHybridRayTracingPass()
    for name, value in settings.items():
        getattr(rt, "Set" + name)(value)
    vtk, hybrid = [], []
    for i in range(WARM_UP + frames):
        move(renderer, light, i)
        renderer.SetPass(None)
        vtk.append(timed(window))
        renderer.SetPass(rt)
        hybrid.append(timed(window))
    counters = statistics(rt)
    device = next(
        (s.partition(":")[2].strip() for s in window.ReportCapabilities().splitlines()
         if "renderer string" in s), "unknown")
    window.Finalize()
    vtk, hybrid = vtk[WARM_UP:], hybrid[WARM_UP:]
    return {
        "vtk_ms": st.quantiles(vtk, n=4),
        "hybrid_ms": st.quantiles(hybrid, n=4),
        "ratio": st.quantiles([h / v for h, v in zip(hybrid, vtk)], n=4),
        "stages_ms": {k: s["ms"] for k, s in counters["stages"].items() if s["ran"]},
        "rays_traced": {k: r["traced"] for k, r in counters["rays"].items()},
        "triangles": counters["triangles"],
        "device": device,
    }


def models():
    yield "torus", scenes.torus()
    root = os.environ.get("HRT_DATA_ROOT")
    path = pathlib.Path(root, "bunny/bunny.ply") if root else None
    if path and path.is_file():
        yield "bunny", scenes.bunny(str(path))
    else:
        print("bunny: skipped, no scene data (see Data/README.md)")


def run_core():
    """The table of hrtCoreBenchmark, which is built only where google-benchmark is installed."""
    program = pathlib.Path(__file__).resolve().parents[2] / "build/bin/hrtCoreBenchmark"
    if not program.is_file():
        print("core: skipped, not built (needs libbenchmark-dev)")
        return
    print("\ncore:", flush=True)
    subprocess.run([str(program)], check=True, stderr=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few frames, for a first impression")
    parser.add_argument("--frames", type=int, help="frames a case after warm-up (default 25)")
    parser.add_argument("--json", help="also write all figures to this file")
    parser.add_argument("--no-core", action="store_true", help="leave out the core's own benchmark")
    arguments = parser.parse_args()
    frames = arguments.frames or (7 if arguments.quick else 25)

    print(f"vtkhybrid {__version__}, VTK {vtkVersion.GetVTKVersion()}, {os.cpu_count()} cores,"
          f" {SIZE[0]} x {SIZE[1]}, median of {frames} frames [quartiles]")
    print(f"{'scene':7s} {'case':26s} {'changes':13s} {'VTK ms':>8s} {'hybrid ms':>22s} {'ratio':>19s}")
    results = []
    for name, model in models():
        for case, changes, keywords, settings, move in CASES:
            figures = run(model, keywords, settings, move, frames)
            results.append({"scene": name, "case": case, "changes": changes, **figures})
            low, middle, high = figures["hybrid_ms"]
            r0, r1, r2 = figures["ratio"]
            print(f"{name:7s} {case:26s} {changes:13s} {figures['vtk_ms'][1]:8.1f}"
                  f" {middle:8.1f} [{low:5.1f}, {high:5.1f}] {r1:6.2f} [{r0:4.2f}, {r2:4.2f}]",
                  flush=True)
    print("OpenGL:", results[0]["device"])
    if arguments.json:
        header = {"vtkhybrid": __version__, "vtk": vtkVersion.GetVTKVersion(), "size": SIZE,
                  "cores": os.cpu_count(), "machine": platform.machine(), "frames": frames}
        pathlib.Path(arguments.json).write_text(
            json.dumps({**header, "results": results}, indent=1) + "\n", encoding="utf-8")
    if not arguments.no_core:
        run_core()


if __name__ == "__main__":
    main()
