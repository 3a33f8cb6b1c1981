"""Draws every picture of the documentation into Documentation/images: one pair a setting, OFF beside
ON, with the value written on it.

    ./run python Documentation/make_pictures.py [name ...]

Each half is rendered at twice its size and averaged, because the pass takes one sample a pixel - but for
those that show what becomes of single pixels. Pictures of the Stanford bunny need scene data (see
Data/README.md) and are left as they are without it.
"""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from vtkhybrid import buffer, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextProperty,
    vtkTextRenderer,
    vtkWindowToImageFilter,
)

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parent / "Examples" / "Python"
IMAGES = HERE / "images"
HALF = (400, 300)  # of a pair, after averaging
GAP = 4            # white columns between the halves


# -- pictures as arrays: uint8, (height, width, 3), row 0 at the bottom ------------------------------


def picture(renderer, size=HALF, scale=2):
    """The renderer's picture, averaged over scale x scale pixels."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(size[0] * scale, size[1] * scale)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    result = averaged(array_of(grab.GetOutput()), scale)
    window.RemoveRenderer(renderer)
    window.Finalize()
    return result


def array_of(image):
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[..., :3].copy()


def averaged(pixels, scale):
    height, width, _ = pixels.shape
    blocks = pixels.reshape(height // scale, scale, width // scale, scale, 3)
    return np.round(blocks.mean(axis=(1, 3))).astype(np.uint8)


def labelled(pixels, text):
    """The picture with a line of text on a dark strip in its lower left corner."""
    style = vtkTextProperty()
    style.SetFontSize(15)
    style.SetColor(1, 1, 1)
    image = vtkImageData()
    size = [0, 0]
    vtkTextRenderer.GetInstance().RenderString(style, text, image, size, 72)
    width, height, _ = image.GetDimensions()
    glyphs = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 4)
    glyphs = glyphs[: size[1], : size[0]]
    cover = glyphs[..., 3:] / 255.0
    strip = np.full((size[1] + 8, size[0] + 12, 3), 40, float)
    strip[4:-4, 6:-6] = strip[4:-4, 6:-6] * (1 - cover) + glyphs[..., :3] * cover
    result = pixels.copy()
    result[: strip.shape[0], : strip.shape[1]] = strip.astype(np.uint8)
    return result


def save(name, *halves):
    """Writes (pixels, label) after (pixels, label), side by side."""
    white = np.full((halves[0][0].shape[0], GAP, 3), 255, np.uint8)
    row = []
    for pixels, label in halves:
        row += [white, labelled(pixels, label) if label else pixels]
    sheet = np.ascontiguousarray(np.hstack(row[1:]))
    image = vtkImageData()
    image.SetDimensions(sheet.shape[1], sheet.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(sheet.reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(str(IMAGES / (name + ".png")))
    writer.SetInputData(image)
    writer.Write()
    print(f"{name}.png: {(IMAGES / (name + '.png')).stat().st_size // 1024} kB")


# -- scenes -----------------------------------------------------------------------------------------


def actor(data, color=(1, 1, 1), specular=0.0, power=30.0, lookup=None):
    mapper = vtkPolyDataMapper()
    if isinstance(data, vtkPolyData):
        mapper.SetInputData(data)
    else:
        mapper.SetInputConnection(data.GetOutputPort())
    mapper.SetScalarVisibility(lookup is not None)
    if lookup is not None:
        mapper.SetLookupTable(lookup)
        mapper.UseLookupTableScalarRangeOn()
    result = vtkActor()
    result.SetMapper(mapper)
    terms = result.GetProperty()
    terms.SetColor(*color)
    terms.SetAmbient(0.28)
    terms.SetDiffuse(0.8)
    terms.SetSpecular(specular)
    terms.SetSpecularPower(power)
    return result


def table(colors, low=0.0, high=1.0):
    """A lookup table that runs through the colours."""
    lookup = vtkLookupTable()
    lookup.SetNumberOfTableValues(256)
    lookup.SetTableRange(low, high)
    at = np.linspace(0, len(colors) - 1, 256)
    for k in range(256):
        rgb = [np.interp(at[k], range(len(colors)), [c[i] for c in colors]) for i in range(3)]
        lookup.SetTableValue(k, *rgb, 1.0)
    return lookup


# Five colours of matplotlib's viridis (CC0), dark end lifted so that it is seen in shadow too.
VIRIDIS = [(0.33, 0.17, 0.50), (0.23, 0.32, 0.55), (0.13, 0.57, 0.55), (0.37, 0.79, 0.38), (0.99, 0.91, 0.14)]


def floor(size=4.0, cells=24, light=0.86, dark=0.74):
    """A chequered floor at y = 0: a cell's colour comes from its scalar."""
    plane = vtkPlaneSource()
    plane.SetOrigin(-size, 0, -size)
    plane.SetPoint1(-size, 0, size)
    plane.SetPoint2(size, 0, -size)
    plane.SetResolution(cells, cells)
    plane.Update()
    data = plane.GetOutput()
    scalars = vtkFloatArray()
    for k in range(cells * cells):
        scalars.InsertNextValue((k // cells + k % cells) % 2)
    data.GetCellData().SetScalars(scalars)
    return actor(data, lookup=table([(dark,) * 3, (light, light, 0.98 * light)]))


def knot(height=1.0, size=0.36, radius=0.17):
    """A trefoil knot as a tube, coloured along its length as a stream tube would be."""
    count = 401
    t = np.linspace(0, 2 * np.pi + 0.03, count)  # its ends overlap
    points = vtkPoints()
    line = vtkCellArray()
    line.InsertNextCell(count)
    scalars = vtkFloatArray()
    for k in range(count):
        x = np.sin(t[k]) + 2 * np.sin(2 * t[k])
        y = np.cos(t[k]) - 2 * np.cos(2 * t[k])
        z = -np.sin(3 * t[k])
        points.InsertNextPoint(size * x, height + size * y, 1.3 * size * z)
        line.InsertCellPoint(k)
        scalars.InsertNextValue(0.5 + 0.5 * np.cos(t[k]))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(line)
    data.GetPointData().SetScalars(scalars)
    tube = vtkTubeFilter()
    tube.SetInputData(data)
    tube.SetRadius(radius)
    tube.SetNumberOfSides(40)
    result = actor(tube, specular=0.35, lookup=table(VIRIDIS))
    result.RotateY(25)
    result.SetPosition(0, 0.2, 0)
    return result


def ball(center, radius, color, resolution=160):
    sphere = vtkSphereSource()
    sphere.SetCenter(*center)
    sphere.SetRadius(radius)
    sphere.SetThetaResolution(resolution)
    sphere.SetPhiResolution(resolution)
    return actor(sphere, color, specular=0.5, power=60)


def lamp(position, intensity=1.0, focal_point=(0, 0, 0)):
    light = vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPosition(*position)
    light.SetFocalPoint(*focal_point)
    light.SetIntensity(intensity)
    return light


def stage(*actors, position=(1.2, 2.5, 5.3), focal_point=(0, 0.85, 0), angle=30.0, lights=None):
    renderer = vtkRenderer()
    renderer.SetBackground(0.90, 0.92, 0.95)
    renderer.SetBackground2(0.52, 0.63, 0.78)
    renderer.GradientBackgroundOn()
    for part in actors:
        renderer.AddActor(part)
    for light in lights or [lamp((2.5, 5, 2.5))]:
        renderer.AddLight(light)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*position)
    camera.SetFocalPoint(*focal_point)
    camera.SetViewAngle(angle)
    renderer.ResetCameraClippingRange()
    return renderer


def traced(renderer, **settings):
    rt = vtkHybridRayTracingPass()
    for name, value in settings.items():
        getattr(rt, "Set" + name)(value)
    renderer.SetPass(rt)
    return rt


def pair(name, make, off, on):
    """make() gives a renderer; off and on are (label, settings of the pass)."""
    halves = []
    for label, settings in (off, on):
        renderer = make()
        traced(renderer, **settings)
        halves.append((picture(renderer), label))
    save(name, *halves)


# -- one function a picture -------------------------------------------------------------------------


def shadow_mode():
    pair("shadow_mode", lambda: stage(floor(), knot()),
         ("ShadowMode Off", {"ShadowMode": 0}), ("ShadowMode ShadowMaps", {}))


def shadow_map_resolution():
    pair("shadow_map_resolution", lambda: stage(floor(), knot()),
         ("ShadowMapResolution 128", {"ShadowMapResolution": 128}),
         ("ShadowMapResolution 2048", {}))


def mirror_scene(reflectance=0.55):
    ground = floor(light=0.62, dark=0.42)
    vtkHybridMaterial.SetReflectance(ground, reflectance)
    return stage(ground, knot(), position=(1.0, 2.0, 6.4), focal_point=(0, 0.45, 0))


def reflections():
    pair("reflections", mirror_scene,
         ("Reflections Off", {"Reflections": False}), ("Reflections On", {}))


def reflectance():
    halves = []
    for value in (0.15, 0.8):
        renderer = mirror_scene(value)
        traced(renderer)
        halves.append((picture(renderer), f"SetReflectance(floor, {value})"))
    save("reflectance", *halves)


def glass_scene(index=1.5, make=None):
    sphere = ball((0.75, 0.62, 1.15), 0.62, (1, 1, 1), 240)
    if make:
        make(sphere)
    else:
        vtkHybridMaterial.SetGlass(sphere, index)
    model = knot()
    model.AddPosition(-0.35, 0, -0.5)
    return stage(floor(light=0.9, dark=0.5), model, sphere, position=(0.8, 2.0, 5.7),
                 focal_point=(0.1, 0.82, 0))


def refractions():
    pair("refractions", glass_scene,
         ("Refractions Off", {"Refractions": False}), ("Refractions On", {}))


def glass():
    renderer = glass_scene(make=lambda sphere: sphere.GetProperty().SetOpacity(0.35))
    traced(renderer)
    plain = picture(renderer)
    renderer = glass_scene(1.5)
    traced(renderer)
    save("glass", (plain, "SetOpacity(0.35)"), (picture(renderer), "SetGlass(ball, 1.5)"))


def mirror_room():
    """Two mirrors that face each other, and things between them."""
    parts = [floor(3.0, 18)]
    for z in (-1.5, 2.6):
        plane = vtkPlaneSource()
        plane.SetOrigin(-1.9, 0, z)
        plane.SetPoint1(1.9, 0, z)
        plane.SetPoint2(-1.9, 2.0, z)
        mirror = actor(plane, (0.85, 0.9, 0.92))
        vtkHybridMaterial.SetReflectance(mirror, 0.9)
        # The near mirror is hidden from the camera behind it; rays see both of its sides.
        mirror.GetProperty().SetFrontfaceCulling(z > 0)
        mirror.GetProperty().SetBackfaceCulling(z > 0)
        parts.append(mirror)
    cube = vtkCubeSource()
    cube.SetXLength(0.5)
    cube.SetYLength(0.5)
    cube.SetZLength(0.5)
    box = actor(cube, (0.85, 0.35, 0.2))
    box.SetPosition(-0.75, 0.25, 0.2)
    box.RotateY(30)
    parts += [box, ball((0.55, 0.4, 0.1), 0.4, (0.2, 0.5, 0.75))]
    return stage(*parts, position=(0.55, 1.35, 4.6), focal_point=(0.0, 0.75, 0.0),
                 lights=[lamp((1.5, 5, 0.6))])


def maximum_depth():
    pair("maximum_depth", mirror_room,
         ("MaximumDepth 1", {"MaximumDepth": 1}), ("MaximumDepth 8", {"MaximumDepth": 8}))


def visibility():
    """How far the rasteriser's (u, v) are from those of the intersection, on a logarithmic scale."""
    def make():
        return stage(floor(), knot())

    uv = []
    for mode in (0, 1):
        renderer = make()
        rt = traced(renderer, Visibility=mode, Buffers=["barycentric", "triangle"])
        picture(renderer, scale=1)
        uv.append((buffer(rt, "barycentric").copy(), buffer(rt, "triangle").copy()))
    same = (uv[0][1] == uv[1][1]) & (uv[0][1] >= 0)
    error = np.abs(uv[0][0] - uv[1][0]).max(axis=2)
    print(f"visibility: largest difference in (u, v) {np.nanmax(error[same]):.1e},"
          f" median {np.nanmedian(error[same]):.1e}")
    exponent = np.log10(np.where(same, np.maximum(error, 1e-7), 1e-7))
    colors = coloured(exponent, VIRIDIS, -7.0, -3.0)
    colors[uv[0][1] < 0] = 255
    renderer = make()
    traced(renderer, Visibility=1)
    shown = picture(renderer)
    save("visibility", (shown, "Visibility DirectRendering"),
         (colors, "|(u, v) - ItemBuffer|: 1e-7 blue ... 1e-3 yellow"))


def pixel_bounds():
    pair("pixel_bounds", lambda: stage(floor(), knot()),
         ("everything", {}), ("PixelBounds 200 600 150 450 of 800 x 600", {"PixelBounds": (200, 600, 150, 450)}))


def coloured(values, colors, low, high):
    at = (np.clip(values, low, high) - low) / (high - low) * (len(colors) - 1)
    channels = [np.interp(at, range(len(colors)), [c[i] for c in colors]) for i in range(3)]
    return np.round(255 * np.stack(channels, axis=-1)).astype(np.uint8)


def ids(values):
    """Each number a colour of its own, no hit white."""
    colors = np.stack([(values * k % 223 + 32) for k in (37, 101, 149)], axis=-1).astype(np.uint8)
    colors[values < 0] = 255
    return colors


def object_intersection_buffer():
    """The picture and the triangle visible at each of its pixels, on a mesh of large triangles."""
    mesh = ball((0, 0.8, 0), 0.8, (0.9, 0.6, 0.3), 24)
    renderer = stage(floor(cells=12), mesh, position=(0.9, 1.9, 4.2), focal_point=(0, 0.7, 0))
    rt = traced(renderer, Buffers=["triangle"])
    picture(renderer, scale=1)
    numbers = buffer(rt, "triangle").copy()
    renderer = stage(floor(cells=12), mesh, position=(0.9, 1.9, 4.2), focal_point=(0, 0.7, 0))
    traced(renderer)
    save("object_intersection_buffer", (ids(numbers), "triangle numbers"),
         (picture(renderer), "the picture shaded from them"))


def buffers():
    renderer = stage(floor(), knot())
    rt = traced(renderer, Buffers=["cell", "normal", "depth", "shadow"])
    picture(renderer, scale=1)
    hit = buffer(rt, "cell") >= 0
    depth = buffer(rt, "depth")
    near, far = np.nanmin(depth), np.nanpercentile(depth, 95)
    depth = coloured(np.nan_to_num(depth), VIRIDIS[::-1], near, far)
    normal = np.round(127.5 * (np.nan_to_num(buffer(rt, "normal")) + 1)).astype(np.uint8)
    shadow = np.round(255 * np.nan_to_num(buffer(rt, "shadow"))).astype(np.uint8)
    shadow = np.repeat((40 + 0.75 * shadow).astype(np.uint8)[..., None], 3, axis=2)
    for panel in (depth, normal, shadow):
        panel[~hit] = 255
    save("buffers_depth_normal", (depth, '"depth"'), (normal, '"normal"'))
    save("buffers_cell_shadow", (ids(buffer(rt, "cell")), '"cell": the tube is 40 triangle strips'),
         (shadow, '"shadow"'))


def examples():
    """Runs each example and keeps its picture, averaged to 400 x 300 pixels."""
    for script in sorted(EXAMPLES.glob("*.py")):
        if script.stem in ("common", "demo"):
            continue
        if script.stem == "robots" and not os.environ.get("HRT_DATA_ROOT"):
            print("example_robots.png: left as it is, no scene data (see Data/README.md)")
            continue
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "picture.png")
            # The robots' images have no mip maps: four times four samples for their far ends.
            scale, size = (4, ["--size", "1600", "1200"]) if script.stem == "robots" else (2, [])
            subprocess.run([sys.executable, str(script), str(path), *size], check=True, cwd=folder,
                           stdout=subprocess.DEVNULL)
            reader = vtkPNGReader()
            reader.SetFileName(str(path))
            reader.Update()
            save("example_" + script.stem, (averaged(array_of(reader.GetOutput()), scale), None))


def demo_scene(picture_name, mirror=False, glass=False):
    """The demo's scene with the Stanford bunny; None without scene data."""
    root = os.environ.get("HRT_DATA_ROOT")
    path = pathlib.Path(root, "bunny/bunny.ply") if root else None
    if not path or not path.is_file():
        print(f"{picture_name}.png: left as it is, no scene data (see Data/README.md)")
        return None
    sys.path.insert(0, str(EXAMPLES))
    spec = importlib.util.spec_from_file_location("demo", EXAMPLES / "demo.py")
    demo = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(demo)
    return demo.scene(demo.bunny(str(path)), mirror=mirror, glass=glass)


def before_after():
    """The demo's scene by VTK's renderer and by the pass."""
    halves = []
    for label, setting in (("VTK's renderer", False), ("the same script with the pass", True)):
        renderer = demo_scene("before_after", mirror=True, glass=True)
        if renderer is None:
            return
        if setting:
            traced(renderer)
        halves.append((picture(renderer, (448, 336)), label))
    save("before_after", *halves)


def multisampling():
    """The paper's figure 3: a part of the bunny, each of its pixels four of the picture's. Of all parts the
    one with most pixels that change."""
    zoom, halves = 4, []
    for mode in (0, 2):
        renderer = demo_scene("multisampling")
        if renderer is None:
            return
        renderer.GetActiveCamera().Zoom(0.75)
        traced(renderer, PrimaryShading=1, Multisampling=mode)
        halves.append(picture(renderer, scale=1))
    height, width = HALF[1] // zoom, HALF[0] // zoom
    changed = (halves[0] != halves[1]).any(axis=2)
    print(f"multisampling: {changed.sum()} pixels change")
    sums = np.pad(changed.astype(int).cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    inside = (sums[height:, width:] - sums[:-height, width:]
              - sums[height:, :-width] + sums[:-height, :-width])
    y, x = np.unravel_index(inside.argmax(), inside.shape)
    parts = [h[y:y + height, x:x + width].repeat(zoom, axis=0).repeat(zoom, axis=1) for h in halves]
    save("multisampling", (parts[0], "Multisampling Off"), (parts[1], "Multisampling Lazy3x3"))


def interleave():
    """The paper's figure 4: normal and interleaved rendering; one pixel of it one of the picture's."""
    halves = []
    for label, settings in (("Interleave 1", {}),
                            ("Interleave 4, InterleaveErrorControl Off",
                             {"Interleave": 4, "InterleaveErrorControl": False})):
        renderer = demo_scene("interleave", mirror=True)
        if renderer is None:
            return
        traced(renderer, PrimaryShading=1, **settings)
        halves.append((picture(renderer, scale=1), label))
    save("interleave", *halves)


def interleave_error_control():
    halves = []
    for label, control in (("InterleaveErrorControl Off", False), ("InterleaveErrorControl On", True)):
        renderer = mirror_scene()
        traced(renderer, PrimaryShading=1, Interleave=4, InterleaveErrorControl=control)
        halves.append((picture(renderer, scale=1), label))
    save("interleave_error_control", *halves)


PICTURES = [before_after, shadow_mode, shadow_map_resolution, visibility, reflections, refractions,
            maximum_depth, multisampling, interleave, interleave_error_control, pixel_bounds,
            reflectance, glass, buffers, object_intersection_buffer, examples]


def main():
    IMAGES.mkdir(exist_ok=True)
    wanted = sys.argv[1:]
    unknown = set(wanted) - {draw.__name__ for draw in PICTURES}
    if unknown:
        sys.exit(f"unknown: {', '.join(sorted(unknown))}; the pictures are "
                 + ", ".join(draw.__name__ for draw in PICTURES))
    for draw in PICTURES:
        if not wanted or draw.__name__ in wanted:
            draw()


if __name__ == "__main__":
    main()
