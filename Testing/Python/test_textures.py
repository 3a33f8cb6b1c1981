"""Textured actors are traced: the picture without effects is VTK's own, mirrors show what one sees
directly, and light goes through holes."""

import numpy as np
import pytest
import scenes
from test_parity import check, compare
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkLookupTable, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkTexturedSphereSource
from vtkmodules.vtkRenderingCore import vtkTexture

NOTHING = {"textured": 0, "texels": 0, "with_edges": 0, "physically_based": 0}
WRAPS = {"clamp": 0, "repeat": 1, "mirror": 2, "border": 3}


def image(texels):
    """A vtkImageData of an array (height, width, components)."""
    texels = np.ascontiguousarray(texels)
    height, width, components = texels.shape
    data = vtkImageData()
    data.SetDimensions(width, height, 1)
    data.GetPointData().SetScalars(numpy_to_vtk(texels.reshape(-1, components), deep=1))
    return data


def photograph(components=3, width=32, height=24):
    """Colours without edges, as in most images. Drivers may interpolate between texels with weights of
    eight bits, llvmpipe does: between black and white VTK's own picture is off by up to two steps."""
    y, x = np.mgrid[0:height, 0:width]
    waves = [np.sin(x / 3.0 + k) + np.cos(y / 4.0 - 2 * k) + 0.5 * np.sin((x + y) / 2.0) for k in range(4)]
    texels = np.stack([127 + 36 * w for w in waves[:components]], axis=-1).astype(np.uint8)
    if components in (2, 4):
        texels[..., -1] = 255
    return texels


def tiles(components=3, seed=1):
    texels = np.random.default_rng(seed).integers(0, 256, (6, 8, components)).astype(np.uint8)
    if components in (2, 4):
        texels[..., -1] = 255
    return texels


def texture_of(texels, interpolate=False, wrap="repeat"):
    texture = vtkTexture()
    texture.SetInputData(image(texels))
    texture.SetInterpolate(interpolate)
    texture.SetWrap(WRAPS[wrap])
    texture.SetBorderColor(0.3, 0.6, 0.9, 1.0)
    return texture


def sheet(texture, low=-0.7, high=2.3, **properties):
    """A square of 6 x 5 cells whose texture coordinates run from low to high."""
    source = vtkPlaneSource()
    source.SetOrigin(-1, -1, 0)
    source.SetPoint1(1, -1, 0)
    source.SetPoint2(-1, 1, 0)
    source.SetResolution(6, 5)
    source.Update()
    data = vtkPolyData()
    data.DeepCopy(source.GetOutput())
    coordinates = data.GetPointData().GetTCoords()
    for i in range(coordinates.GetNumberOfTuples()):
        s, t = coordinates.GetTuple2(i)
        coordinates.SetTuple2(i, low + (high - low) * s, low + (high - low) * t)
    properties = {"Color": (0.9, 0.8, 0.7), "Specular": 0.3, "Ambient": 0.2, **properties}
    actor = scenes.actor_of(data, **properties)
    actor.SetTexture(texture)
    return actor


def lit(*actors):
    renderer = scenes.renderer_of(*actors)
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    return scenes.look(renderer, (0.8, -1.5, 3.5))


MODES = [("ItemBuffer", "GPU"), ("DirectRendering", "GPU"), ("ItemBuffer", "CPU"), ("RayCasting", "CPU")]


def hold_to_vtk(name, scene, render):
    """Parity with VTK in each mode; between GPU and CPU at most one step, everywhere."""
    pictures = []
    for visibility, shading in MODES:
        renderer = scene()
        figures = compare(renderer, render, visibility, shading=shading)
        check(f"{name} {visibility} {shading}", figures)
        pictures.append(render(renderer, (400, 300)).astype(int))
    for other in (2, 3):
        assert (np.abs(pictures[0] - pictures[other]).max(axis=2) <= 1).mean() >= 0.9999


@pytest.mark.parametrize("components", [1, 2, 3, 4])
@pytest.mark.parametrize("interpolate", [False, True], ids=["nearest", "linear"])
def test_components(components, interpolate, render):
    texels = photograph(components) if interpolate else tiles(components)
    hold_to_vtk(
        f"{components} components, {'linear' if interpolate else 'nearest'}",
        lambda: lit(sheet(texture_of(texels, interpolate))),
        render,
    )


@pytest.mark.parametrize("wrap", WRAPS)
@pytest.mark.parametrize("interpolate", [False, True], ids=["nearest", "linear"])
def test_wraps(wrap, interpolate, render):
    texels = photograph() if interpolate else tiles()
    hold_to_vtk(
        f"{wrap}, {'linear' if interpolate else 'nearest'}",
        lambda: lit(sheet(texture_of(texels, interpolate, wrap))),
        render,
    )


def transformed():
    """A texture that brings a transform: turned, scaled and moved."""
    texture = texture_of(photograph(), True)
    transform = vtkTransform()
    transform.Translate(0.3, -0.2, 0)
    transform.RotateZ(25)
    transform.Scale(1.7, 0.6, 1)
    texture.SetTransform(transform)
    return lit(sheet(texture))


def ball():
    """Smooth shading with highlights, and texture coordinates that meet in a seam."""
    source = vtkTexturedSphereSource()
    source.SetThetaResolution(40)
    source.SetPhiResolution(30)
    actor = scenes.actor_of(source, Diffuse=0.8, Specular=0.2, SpecularPower=20.0)
    actor.SetTexture(texture_of(photograph(), True))
    return scenes.look(scenes.renderer_of(actor), (0.5, 1.0, 2.5))


def over_scalars(cells):
    """Colours of scalars times a texture."""

    def scene():
        actor = sheet(texture_of(photograph(), True), Interpolation=0)
        data = actor.GetMapper().GetInput()
        attributes = data.GetCellData() if cells else data.GetPointData()
        count = data.GetNumberOfCells() if cells else data.GetNumberOfPoints()
        values = vtkFloatArray()
        values.SetName("values")
        for i in range(count):
            values.InsertNextValue((i * 37) % 64)
        attributes.SetScalars(values)
        actor.GetMapper().SetScalarRange(0, 63)
        return lit(actor)

    scene.__name__ = "over_cell_scalars" if cells else "over_point_scalars"
    return scene


def looked_up():
    """Values that the texture's own table turns into colours."""
    y, x = np.mgrid[0:16, 0:16]
    texture = vtkTexture()
    texture.SetInputData(image((np.hypot(x - 7, y - 8).astype(np.float32))[..., None]))
    table = vtkLookupTable()
    table.SetRange(0, 10)
    table.SetNumberOfTableValues(12)
    table.Build()
    texture.SetLookupTable(table)
    return lit(sheet(texture))


def wide_colours():
    """Floating-point and sRGB images beside each other."""
    floats = vtkTexture()
    floats.SetInputData(image((photograph() / 255.0 * 1.5).astype(np.float32)))
    floats.SetColorModeToDirectScalars()
    floats.InterpolateOn()
    left = sheet(floats)
    left.SetScale(0.5, 1, 1)
    left.SetPosition(-0.6, 0, 0)
    decoded = texture_of(photograph(), True)
    decoded.UseSRGBColorSpaceOn()
    right = sheet(decoded)
    right.SetScale(0.5, 1, 1)
    right.SetPosition(0.6, 0, 0)
    return lit(left, right)


def one_side_only():
    """An open cylinder that shows its texture on the front alone."""
    actor = sheet(texture_of(tiles()), BackfaceCulling=False)
    actor.GetProperty().ShowTexturesOnBackfaceOff()
    back = sheet(texture_of(tiles()))
    back.GetProperty().ShowTexturesOnBackfaceOff()
    back.RotateY(180)
    back.SetPosition(0, 0.9, 0.4)
    return lit(actor, back)


def several():
    """An actor's texture and two of its property, each blended in a way of its own."""
    actor = sheet(texture_of(tiles()))
    for name, mode, seed in (("first", 3, 2), ("second", 2, 3)):  # add, modulate
        other = texture_of(tiles(4, seed))
        other.SetBlendingMode(mode)
        actor.GetProperty().SetTexture(name, other)
    return lit(actor)


def unlit():
    return lit(sheet(texture_of(photograph(), True), Lighting=False))


def without_coordinates():
    """VTK shows no texture where there are no coordinates."""
    actor = sheet(texture_of(tiles()))
    actor.GetMapper().GetInput().GetPointData().SetTCoords(None)
    return lit(actor)


@pytest.mark.parametrize(
    "scene",
    [
        transformed,
        ball,
        over_scalars(False),
        over_scalars(True),
        looked_up,
        wide_colours,
        one_side_only,
        several,
        unlit,
        without_coordinates,
    ],
    ids=lambda scene: scene.__name__,
)
def test_same_picture_as_vtk(scene, render):
    hold_to_vtk(scene.__name__, scene, render)


def holes():
    texels = np.zeros((12, 12, 4), np.uint8)
    texels[..., :3] = (240, 180, 40)
    y, x = np.mgrid[0:12, 0:12]
    texels[..., 3] = np.where((x // 2 + y // 2) % 2 == 0, 255, 0)
    return texels


def test_holes_are_not_there(render):
    """In every engine, as in VTK's picture: what is behind a hole is seen."""
    for visibility, shading in MODES:
        card = sheet(texture_of(holes()), 0, 1)
        behind = scenes.actor_of(scenes.plane(3.0, -1.0), Color=(0.3, 0.4, 0.9))
        figures = compare(lit(card, behind), render, visibility, shading=shading)
        check(f"holes {visibility} {shading}", figures)
    assert not statistics(card_pass(render))["hosted"]


def card_pass(render):
    renderer = lit(sheet(texture_of(holes()), 0, 1))
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    render(renderer)
    return rt


# Exact shadows are shaded on the CPU.
@pytest.mark.parametrize("mode, shading", [("ShadowMaps", "GPU"), ("ShadowMaps", "CPU"), ("Exact", "CPU")])
def test_light_goes_through_holes(mode, shading, render):
    """A card of squares between light and floor; the lit share of its shadow is that of the holes."""
    floor = scenes.actor_of(scenes.plane(3.0, 0.0), Color=(1, 1, 1))
    card = sheet(texture_of(holes()), 0, 1)
    card.RotateX(-90)
    card.SetPosition(0, 1, 0)
    renderer = scenes.renderer_of(floor, card)
    renderer.AddLight(scenes.scene_light((0, 10, 0)))
    camera = scenes.look(renderer, (0, 0.9, 2.5), (0, 0, 0)).GetActiveCamera()
    camera.SetClippingRange(0.1, 20)
    rt = vtkHybridRayTracingPass()
    getattr(rt, "SetShadowModeTo" + mode)()
    getattr(rt, "SetPrimaryShadingTo" + shading)()
    rt.SetBuffers(["shadow", "position", "prop"])
    renderer.SetPass(rt)
    render(renderer, (400, 300))
    position, prop = buffer(rt, "position"), buffer(rt, "prop")
    share = buffer(rt, "shadow").reshape(prop.shape)
    x, z = position[..., 0], position[..., 2]
    under = (prop == 0) & (np.abs(x) < 1) & (np.abs(z) < 1)
    # The card's s runs with x and t against z; six squares a side, of which every second is a hole.
    column = np.floor((x + 1) * 3)
    row = np.floor((1 - z) * 3)
    solid = (column + row) % 2 == 0
    # Two texels of a map of 1,024 over a card of 2, in squares of a third.
    edge = 0.012 if mode == "ShadowMaps" else 1e-5
    from_middle = np.maximum(np.abs((x + 1) * 3 % 1 - 0.5), np.abs((1 - z) * 3 % 1 - 0.5))
    certain = under & (from_middle < 0.5 - edge)
    assert certain.sum() > 5000
    wrong = certain & (share != np.where(solid, 0.0, 1.0))
    print(f"holes {mode} {shading}: {wrong.sum()} wrong of {certain.sum()} pixels")
    assert wrong.sum() == 0


@pytest.mark.parametrize("kind", ["opacity", "texture", "scalars"])
@pytest.mark.parametrize("alpha", [0, 128, 255])
def test_what_a_card_lets_through(kind, alpha, render):
    """Opacity of the property, of texels and of scalars let the same share of light through."""
    texels = np.full((4, 4, 4), 255, np.uint8)
    texels[..., 3] = alpha
    card = sheet(texture_of(texels) if kind == "texture" else None, Color=(1, 1, 1), Specular=0.0)
    if kind == "opacity":
        card.GetProperty().SetOpacity(alpha / 255)
    if kind == "scalars":
        data = card.GetMapper().GetInput()
        colors = vtkUnsignedCharArray()
        colors.SetNumberOfComponents(4)
        for _ in range(data.GetNumberOfPoints()):
            colors.InsertNextTuple4(255, 255, 255, alpha)
        data.GetPointData().SetScalars(colors)
    card.SetPosition(0, 0, 1)
    floor = scenes.actor_of(vtkPlaneSource(), Color=(1, 1, 1))
    floor.SetScale(6, 6, 1)
    renderer = scenes.renderer_of(floor, card)
    renderer.AddLight(scenes.scene_light((0, 0, 5)))
    scenes.look(renderer, (5, -7, 6), up=(0, 0, 1))
    rt = vtkHybridRayTracingPass()
    rt.SetShadowModeToExact()
    rt.SetBuffers(["shadow", "prop"])
    renderer.SetPass(rt)
    render(renderer, (400, 300))
    prop = buffer(rt, "prop")
    darkest = np.nanmin(buffer(rt, "shadow").reshape(prop.shape)[prop == 0])
    assert darkest == pytest.approx(1 - alpha / 255, abs=1e-5)


def board(textured):
    """Eight by eight unlit colours: texels of one square, or cells of a mesh."""
    k = np.arange(64)
    colors = np.stack([255 - 3 * k, 40 + 3 * k, (k * 61) % 200], axis=1).astype(np.uint8)
    source = vtkPlaneSource()
    source.SetOrigin(-1.0, 0.2, -1.0)
    source.SetPoint1(1.0, 0.2, -0.5)
    source.SetPoint2(-1.0, 1.7, -1.0)
    size = 1 if textured else 8
    source.SetResolution(size, size)
    source.Update()
    data = vtkPolyData()
    data.ShallowCopy(source.GetOutput())
    actor = scenes.actor_of(data, Lighting=False, Ambient=0.0, Diffuse=1.0)
    if textured:
        actor.SetTexture(texture_of(colors.reshape(8, 8, 3)))
    else:
        array = vtkUnsignedCharArray()
        array.SetNumberOfComponents(3)
        for color in colors:
            array.InsertNextTuple3(*(int(c) for c in color))
        data.GetCellData().SetScalars(array)
    return actor


@pytest.mark.parametrize("shading", ["GPU", "CPU"])
@pytest.mark.parametrize("optics", ["mirror", "glass"])
def test_seen_by_rays_as_cells_of_the_same_colours(optics, shading, render):
    """A textured square in a mirror and through glass, against a mesh that has its colours."""
    pictures = []
    for textured in (True, False):
        body = scenes.actor_of(scenes.plane(2.0) if optics == "mirror" else scenes.superquadric(48))
        if optics == "mirror":
            vtkHybridMaterial.SetReflectance(body, 1.0)
        else:
            body.SetPosition(0, 0.8, 1.0)
            vtkHybridMaterial.SetGlass(body, 1.3)
        renderer = scenes.renderer_of(body, board(textured))
        scenes.look(renderer, (0.5, 1.5, 4.5), (0, 0.5, 0))
        rt = vtkHybridRayTracingPass()
        getattr(rt, "SetPrimaryShadingTo" + shading)()
        renderer.SetPass(rt)
        pictures.append(render(renderer, (300, 300)).astype(int))
        assert not statistics(rt)["left_to_vtk"]
    # Texels and cells have the same borders; only where one runs through a pixel's ray may they differ.
    different = (np.abs(pictures[0] - pictures[1]).max(axis=2) > 1).mean()
    print(f"{optics} {shading}: {100 * different:.4f} % of the pixels differ")
    assert len(np.unique(pictures[0].reshape(-1, 3), axis=0)) > 60
    assert different < 1e-4


def test_a_scene_without_textures_keeps_its_shader(render):
    """What no surface in view has costs nothing; the counters say what is uploaded."""
    actor = sheet(texture_of(tiles()))
    renderer = lit(actor)
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    render(renderer)
    texels = 6 * 8 * 4
    assert statistics(rt)["surfaces"] == {**NOTHING, "textured": 1, "texels": 6 * 8}
    first = statistics(rt)["bytes_uploaded"]
    actor.GetProperty().SetDiffuse(0.7)
    render(renderer)
    assert statistics(rt)["bytes_uploaded"] == 0, "the same texels stay"
    actor.SetTexture(texture_of(tiles(3, 5)))
    render(renderer)
    assert statistics(rt)["bytes_uploaded"] == texels < first
    actor.SetTexture(None)
    render(renderer)
    assert statistics(rt)["surfaces"] == NOTHING


def test_another_image_is_seen_at_once(render):
    actor = sheet(texture_of(tiles()))
    renderer = lit(actor)
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    before = render(renderer)
    actor.GetTexture().SetInputData(image(tiles(3, 7)))
    after = render(renderer)
    assert (before != after).any(axis=2).mean() > 0.05
    assert statistics(rt)["stages"]["primary_shading"]["reason"] == "a material changed"
    assert not statistics(rt)["stages"]["visibility"]["ran"]
    actor.GetTexture().SetInputData(image(holes()))
    render(renderer)
    assert statistics(rt)["stages"]["visibility"]["ran"], "holes are a matter of what is seen"
