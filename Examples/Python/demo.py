"""The first thing a newcomer sees: the same script drawn by VTK's own renderer and by the hybrid pass.

    ./run demo [folder]

Writes PNG files and ends with a summary of one screen. The Stanford bunny is used when the scene data
are found (HRT_DATA_ROOT), else a torus of 1,024 triangles made here.
"""

import pathlib
import statistics as statistics_of
import sys
import time

from common import actor, save, scene_data, window_of
from vtkhybrid import __version__, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkCommonComputationalGeometry import vtkParametricTorus
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkTriangleFilter
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersSources import (
    vtkParametricFunctionSource,
    vtkPlaneSource,
    vtkSphereSource,
)
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer


def bunny(path):
    reader = vtkPLYReader()
    reader.SetFileName(path)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(reader.GetOutputPort())
    normals.SplittingOff()
    return normals


def torus():
    """1,024 triangles: 32 x 16 quadrilaterals, cut in two."""
    shape = vtkParametricTorus()
    source = vtkParametricFunctionSource()
    source.SetParametricFunction(shape)
    source.SetUResolution(32)
    source.SetVResolution(16)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(source.GetOutputPort())
    return triangles


def standing(source):
    """The object, one unit high and standing on the plane y = 0."""
    source.Update()
    x0, x1, y0, y1, z0, z1 = source.GetOutput().GetBounds()
    size = max(x1 - x0, y1 - y0, z1 - z0)
    placed = vtkTransform()
    placed.Scale(*(3 * (1.0 / size,)))
    placed.Translate(-(x0 + x1) / 2, -y0, -(z0 + z1) / 2)
    result = vtkTransformPolyDataFilter()
    result.SetInputConnection(source.GetOutputPort())
    result.SetTransform(placed)
    return result


def floor(size=4.0):
    source = vtkPlaneSource()
    source.SetOrigin(-size, 0, -size)
    source.SetPoint1(-size, 0, size)
    source.SetPoint2(size, 0, -size)
    return source


def scene(model, mirror, glass):
    """The script of every picture: an object on a floor under one spot light."""
    renderer = vtkRenderer()
    renderer.SetBackground(0.86, 0.88, 0.92)
    renderer.SetBackground2(0.35, 0.47, 0.66)
    renderer.GradientBackgroundOn()
    renderer.AddActor(actor(standing(model), (0.93, 0.72, 0.45), specular=0.2))
    ground = actor(floor(), (0.62, 0.64, 0.68))
    renderer.AddActor(ground)
    if mirror:
        vtkHybridMaterial.SetReflectance(ground, 0.4)
    if glass:
        sphere = vtkSphereSource()
        sphere.SetRadius(0.24)
        sphere.SetCenter(0.72, 0.24, 0.42)
        sphere.SetThetaResolution(160)
        sphere.SetPhiResolution(160)
        ball = actor(sphere, (1, 1, 1), specular=0.6, power=80.0)
        vtkHybridMaterial.SetGlass(ball, 1.5)
        renderer.AddActor(ball)
    light = vtkLight()
    light.SetLightTypeToSceneLight()
    light.PositionalOn()
    light.SetPosition(1.6, 3.2, 1.9)
    light.SetFocalPoint(0, 0.3, 0)
    light.SetConeAngle(55)
    renderer.AddLight(light)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(0.6, 1.25, 2.9)
    camera.SetFocalPoint(0.12, 0.42, 0)
    renderer.ResetCameraClippingRange()
    return renderer


def milliseconds(renderer, window, turn=0.01):
    """Median of a few frames, the camera turning a little from one to the next."""
    times = []
    for _ in range(5):
        renderer.GetActiveCamera().Azimuth(turn)
        start = time.perf_counter()
        window.Render()
        window.WaitForCompletion()
        times.append(1000 * (time.perf_counter() - start))
    return statistics_of.median(times)


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    folder.mkdir(parents=True, exist_ok=True)
    path = scene_data("bunny/bunny.ply")
    name, model = ("Stanford bunny", bunny(path)) if path else ("torus", torus())
    lines = [f"VTK Hybrid Ray Tracing {__version__}: the {name}, the same script drawn twice"]
    if not path:
        lines.append("(no scene data found: set HRT_DATA_ROOT to see the Stanford bunny)")
    for title, mirror, glass in (
        ("shadow", False, False),
        ("mirror", True, False),
        ("mirror and glass", True, True),
    ):
        file = title.replace(" ", "_")
        renderer = scene(model, mirror, glass)
        window = window_of(renderer)
        before = save(window, folder / f"{file}_vtk.png")
        plain = milliseconds(renderer, window)
        rt = vtkHybridRayTracingPass()
        renderer.SetPass(rt)
        moving = milliseconds(renderer, window)
        rays = sum(kind["traced"] for kind in statistics(rt)["rays"].values())
        triangles = statistics(rt)["triangles"]
        still = milliseconds(renderer, window, turn=0.0)
        after = save(window, folder / f"{file}_hybrid.png")
        lines += [
            f"\n{title}: {triangles:,} triangles, {rays:,} rays traced",
            f"  VTK's renderer {plain:7.1f} ms a frame   {before}",
            f"  hybrid pass    {moving:7.1f} ms a frame   {after}",
            f"  ... nothing changed: {still:.1f} ms, only the blit runs",
        ]
    capabilities = window.ReportCapabilities()
    device = next((s for s in capabilities.splitlines() if "renderer string" in s), "")
    lines += [
        "\nOpenGL" + device.partition(":")[2],
        "Next: Examples/Python/two_lines.py, and the table of settings in Documentation/settings.md",
    ]
    print("\n".join(lines))


if __name__ == "__main__":
    main()
