"""What a mesh of a million triangles takes of the host's memory, beyond the vtkPolyData itself: by VTK alone, by
the pass with a shadow map, and with mirrors.

Each is measured in a process of its own, as the growth of its resident memory until the third frame. What
grows before is left out: the data, and an empty window, whose OpenGL takes tens of MiB. With OpenGL in
software its copy is part of the figure. The camera moves, so that no frame is the last one's. `in use` leaves
out what the allocator keeps after it was freed, which depends on how threads happened to meet.

    python memory.py KIND     one measurement, as JSON; run by bench.py and compare.py
"""

import ctypes
import gc
import json
import os
import pathlib
import statistics as st
import subprocess
import sys

import cases
from measure import model_on_floor, scenes, window_of
from vtkmodules.vtkRenderingCore import vtkRenderer

TRIANGLES = 1_000_000
FRAMES = 3
KINDS = {"VTK alone": {}, "shadow map": {}, "mirrors": {"mirror": True}}


def status(field):
    """Bytes of this process by a field of the kernel's: VmRSS are resident, VmHWM were at most."""
    lines = pathlib.Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith(field + ":"))


def give_back():
    """Returns what the allocator holds free: it would hide as much of a later growth."""
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc has it
    if trim:
        trim(0)


def measure(kind):
    data = scenes.torus(TRIANGLES)
    empty = window_of(vtkRenderer())
    empty.Render()
    give_back()
    before = status("VmRSS")
    renderer, light = model_on_floor(data, **KINDS[kind])
    stage = cases.Stage(renderer, {}, lambda i: cases.move_camera(renderer, light, i))
    if kind != "VTK alone":
        renderer.SetPass(stage.rt)
    for i in range(FRAMES):
        stage.advance(i)
        stage.window.Render()
        stage.window.WaitForCompletion()
    bytes_resident, bytes_at_most = status("VmRSS") - before, status("VmHWM") - before
    give_back()
    bytes_in_use = status("VmRSS") - before
    count = data.GetNumberOfCells()
    figures = {"kind": kind, "triangles": count, "bytes_a_triangle": bytes_resident / count,
               "bytes_in_use_a_triangle": bytes_in_use / count,
               "most_bytes_a_triangle": bytes_at_most / count}
    if kind != "VTK alone":
        # A figure of a scene that the pass left to VTK would be VTK's.
        figures["traced"] = cases.traced_triangles(stage)
    empty.Finalize()
    stage.close()
    return figures


def in_own_process(kind):
    """The figures of one measurement."""
    output = subprocess.run([sys.executable, __file__, kind], check=True, text=True,
                            stdout=subprocess.PIPE).stdout
    return json.loads(output.splitlines()[-1])


def run(repeats):
    """Prints the table, medians of `repeats` processes; returns its rows."""
    if not os.path.exists("/proc/self/status"):
        print("\nmemory: skipped, this system has no /proc")
        return []
    print(f"\nmemory at {TRIANGLES:,} triangles, frame {FRAMES}, bytes a triangle beyond the vtkPolyData:")
    rows = []
    for kind in KINDS:
        taken = [in_own_process(kind) for _ in range(repeats)]
        row = {**taken[0], **{key: st.median(figures[key] for figures in taken)
                              for key in taken[0] if "bytes" in key}}
        rows.append(row)
        print(f"{kind:10s} {row['bytes_a_triangle']:6.0f} resident, of which"
              f" {row['bytes_in_use_a_triangle']:6.0f} in use; at most"
              f" {row['most_bytes_a_triangle']:6.0f} on the way", flush=True)
    return rows


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1])))
