"""What a frame costs: the hybrid pass beside VTK's own renderer, frame by frame in turn in one window, so
that a noisy machine disturbs both alike. Prints medians with quartiles and the ratio; writes JSON. Then
interleaved rendering, time against error (interleaving.py), what a step of the robots' animation costs the
ray structures (updates.py), and the core by itself, where hrtCoreBenchmark was built: the kd-tree's build
and rays beside Embree's.

    ./run bench [--quick] [--frames N] [--json FILE] [--no-core]
    ./run bench --paper [...]     the paper's tables and figure, see paper.py

Each case says what changes between its frames. Times are wall-clock milliseconds of a whole
vtkRenderWindow.Render with the GL commands finished, 800 x 600, no multisampling.
"""

import argparse
import json
import os
import pathlib
import statistics as st
import subprocess
import sys
import time

import interleaving
import updates
from measure import SIZE, WARM_UP, device_of, header, model_on_floor, models, timed, window_of
from vtkhybrid import __version__, statistics, vtkHybridRayTracingPass
from vtkmodules.vtkCommonCore import vtkVersion


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


def run(model, keywords, settings, move, frames):
    renderer, light = model_on_floor(model, **keywords)
    window = window_of(renderer)
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
    device = device_of(window)
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


def run_core():
    """The table of hrtCoreBenchmark, which is built only where google-benchmark is installed."""
    program = pathlib.Path(__file__).resolve().parents[2] / "build/bin/hrtCoreBenchmark"
    if not program.is_file():
        print("core: skipped, not built (needs libbenchmark-dev)")
        return
    print("\ncore:", flush=True)
    subprocess.run([str(program)], check=True, stderr=subprocess.DEVNULL)


def main():
    if "--paper" in sys.argv[1:]:
        import paper

        return paper.main([a for a in sys.argv[1:] if a != "--paper"])
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
    interleaved = interleaving.run(frames)
    updated = updates.run()
    if arguments.json:
        figures = {**header(frames), "results": results, "interleaving": interleaved,
                   "structure_updates": updated}
        pathlib.Path(arguments.json).write_text(
            json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    if not arguments.no_core:
        run_core()
    return 0


if __name__ == "__main__":
    sys.exit(main())
