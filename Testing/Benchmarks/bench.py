"""What a frame costs: the hybrid pass beside VTK's own renderer, frame by frame in turn in one window, so
that a noisy machine disturbs both alike. Prints medians with quartiles and the ratio; writes JSON. Then ten
thousand actors that VTK draws (hosted.py), the memory of a million triangles (memory.py), a million glyphs
(glyphs.py), interleaved rendering, time against error (interleaving.py), what a step of the robots' animation
costs the ray structures (updates.py), and the core by itself, where hrtCoreBenchmark was built: the kd-tree's
build and rays beside Embree's.

    ./run bench [--quick] [--frames N] [--json FILE] [--no-core]
    ./run bench --compare BUILD [...]   this build against another one, see compare.py
    ./run bench --paper [...]           the paper's tables and figure, see paper.py

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

import cases
import glyphs
import hosted
import interleaving
import memory
import updates
from measure import SIZE, WARM_UP, device_of, header, models, timed
from vtkhybrid import __version__, statistics
from vtkmodules.vtkCommonCore import vtkVersion


def run(model, keywords, settings, move, frames):
    stage = cases.on_floor(model, keywords, settings, move)
    vtk, hybrid = [], []
    for i in range(WARM_UP + frames):
        stage.advance(i)
        stage.renderer.SetPass(None)
        vtk.append(timed(stage.window))
        stage.renderer.SetPass(stage.rt)
        hybrid.append(timed(stage.window))
    counters = statistics(stage.rt)
    device = device_of(stage.window)
    stage.close()
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
    if any(a.split("=")[0] == "--compare" for a in sys.argv[1:]):
        import compare

        return compare.main(sys.argv[1:])
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
        for case, changes, keywords, settings, move in cases.CASES:
            figures = run(model, keywords, settings, move, frames)
            results.append({"scene": name, "case": case, "changes": changes, **figures})
            low, middle, high = figures["hybrid_ms"]
            r0, r1, r2 = figures["ratio"]
            print(f"{name:7s} {case:26s} {changes:13s} {figures['vtk_ms'][1]:8.1f}"
                  f" {middle:8.1f} [{low:5.1f}, {high:5.1f}] {r1:6.2f} [{r0:4.2f}, {r2:4.2f}]",
                  flush=True)
    print("OpenGL:", results[0]["device"])
    crowds = hosted.run(min(frames, hosted.MOST_FRAMES))
    taken = memory.run(1 if arguments.quick else 3)
    glyph_rows = glyphs.run(arguments.quick)
    interleaved = interleaving.run(frames)
    updated = updates.run()
    if arguments.json:
        figures = {**header(), "frames": frames, "results": results, "hosted": crowds, "memory": taken,
                   "glyphs": glyph_rows, "interleaving": interleaved, "structure_updates": updated}
        pathlib.Path(arguments.json).write_text(
            json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    if not arguments.no_core:
        run_core()
    return 0


if __name__ == "__main__":
    sys.exit(main())
