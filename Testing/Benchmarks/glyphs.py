"""A million glyphs of a hundred triangles, by one vtkGlyph3DMapper: milliseconds of a frame and bytes a glyph,
by VTK alone and by the pass, with shadows. Whether the pass traces them or leaves them to VTK is said.

    python glyphs.py KIND GLYPHS     one measurement, as JSON; bench.py runs each in its own process
"""

import json
import os
import subprocess
import sys

import cases
import numpy as np
from measure import scenes, timed, window_of
from memory import give_back, status
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkGlyph3DMapper, vtkRenderer

KINDS = ("VTK alone", "shadow map", "shadow rays")
# The pass' settings. Shadow rays need their hierarchy, maps do not.
SETTINGS = {"shadow map": {}, "shadow rays": {"ShadowMode": 2, "PrimaryShading": 1}}
# The first frame makes all that the next ones keep; in the second the camera moves; the third is still.
FRAMES = ("first", "camera moves", "still")
GLYPHS = 1_000_000
QUICK_GLYPHS = 27_000


def glyph():
    """A closed mesh of a hundred triangles with point normals: a sphere of ten by six."""
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(10)
    sphere.SetPhiResolution(7)
    sphere.Update()
    return sphere.GetOutput()


def lattice(side):
    """side^3 points, one unit apart."""
    at = np.arange(side, dtype=np.float32)
    grid = np.stack(np.meshgrid(at, at, at, indexing="ij"), axis=-1).reshape(-1, 3)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(grid, deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    return data


def measure(kind, wanted):
    side = round(wanted ** (1 / 3))
    data, source = lattice(side), glyph()
    empty = window_of(vtkRenderer())
    empty.Render()
    give_back()
    before = status("VmRSS")
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceData(source)
    mapper.SetScaleFactor(0.6)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.9, 0.7, 0.5)
    renderer = scenes.renderer_of(actor)
    renderer.AddLight(scenes.scene_light((side, 3 * side, 2 * side), (side / 2, side / 2, side / 2)))
    scenes.look(renderer, (1.2 * side, 1.8 * side, 3.2 * side), (side / 2, side / 2, side / 2))
    stage = cases.Stage(renderer, SETTINGS.get(kind, {}), None)
    if kind in SETTINGS:
        renderer.SetPass(stage.rt)
    times = {}
    for name in FRAMES:
        if name == "camera moves":
            renderer.GetActiveCamera().Azimuth(1.0)
        times[name] = timed(stage.window)
    figures = {"kind": kind, "glyphs": side**3, "triangles_a_glyph": source.GetNumberOfCells(),
               "ms": times, "bytes_a_glyph": (status("VmRSS") - before) / side**3,
               "traced": kind in SETTINGS and cases.traced_triangles(stage) > 0}
    empty.Finalize()
    stage.close()
    return figures


def run(quick):
    """Prints the table; returns its rows."""
    if not os.path.exists("/proc/self/status"):
        print("\nglyphs: skipped, this system has no /proc")
        return []
    rows = []
    for kind in KINDS:
        output = subprocess.run(
            [sys.executable, __file__, kind, str(QUICK_GLYPHS if quick else GLYPHS)], check=True,
            text=True, stdout=subprocess.PIPE).stdout
        row = json.loads(output.splitlines()[-1])
        if not rows:
            print(f"\n{row['glyphs']:,} glyphs of {row['triangles_a_glyph']} triangles:")
        rows.append(row)
        drawn = "" if kind == "VTK alone" else ", traced" if row["traced"] else ", left to VTK"
        print(f"{kind:12s} " + ", ".join(f"{name} {row['ms'][name]:.0f} ms" for name in FRAMES)
              + f"; {row['bytes_a_glyph']:.0f} bytes a glyph{drawn}", flush=True)
    return rows


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1], int(sys.argv[2]))))
