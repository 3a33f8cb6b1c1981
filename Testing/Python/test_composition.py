"""What the tracer does not draw is drawn by VTK over the traced picture, hidden where it should be: with
effects off the picture of a scene of everything equals VTK's own."""

import numpy as np
import pytest
import scenes
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkPiecewiseFunction,
    vtkPlane,
    vtkPolyData,
)
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkElevationFilter
from vtkmodules.vtkFiltersSources import vtkLineSource, vtkPointSource
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkImagingSources import vtkImageCanvasSource2D
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction,
    vtkImageActor,
    vtkPropAssembly,
    vtkTextActor,
    vtkTexture,
    vtkVolume,
    vtkVolumeProperty,
)
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkGaussianBlurPass,
    vtkRenderStepsPass,
    vtkSSAAPass,
    vtkToneMappingPass,
)
from vtkmodules.vtkRenderingVolume import (
    vtkFixedPointVolumeRayCastMapper,
    vtkGPUVolumeRayCastMapper,
)


def ball(x=0.0, radius=0.5, **properties):
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(40)
    source.SetPhiResolution(40)
    source.SetRadius(radius)
    actor = scenes.actor_of(source, **properties)
    actor.SetPosition(x, 0, 0)
    return actor


def lines():
    """A line that passes in front of, through and behind the ball."""
    source = vtkLineSource()
    source.SetPoint1(-1.2, 0.3, 1.0)
    source.SetPoint2(1.0, -0.2, -1.0)
    return scenes.actor_of(source, Color=(1, 1, 0), LineWidth=3.0)


def points():
    source = vtkPointSource()
    source.SetNumberOfPoints(300)
    source.SetRadius(0.9)
    return scenes.actor_of(source, Color=(0, 1, 1), PointSize=3.0)


def wireframe():
    return ball(0.4, 0.6, Representation=1, Color=(0.1, 0.9, 0.1))


def mip_mapped():
    canvas = vtkImageCanvasSource2D()
    canvas.SetScalarTypeToUnsignedChar()
    canvas.SetNumberOfScalarComponents(3)
    canvas.SetExtent(0, 15, 0, 15, 0, 0)
    canvas.SetDrawColor(255, 200, 40)
    canvas.FillBox(0, 15, 0, 15)
    canvas.SetDrawColor(30, 60, 200)
    canvas.FillBox(4, 11, 4, 11)
    texture = vtkTexture()
    texture.SetInputConnection(canvas.GetOutputPort())
    texture.InterpolateOn()
    texture.MipmapOn()
    actor = scenes.actor_of(scenes.plane(1.0, -0.3))
    actor.SetTexture(texture)
    return actor


def translucent():
    return ball(0.3, 0.6, Opacity=0.4, Color=(0.9, 0.2, 0.9))


def physically_based(**properties):
    return ball(0.5, 0.4, Interpolation=3, Metallic=0.4, Roughness=0.3, Color=(0.9, 0.9, 0.5), **properties)


def anisotropic():
    return physically_based(Anisotropy=0.5)


def text():
    actor = vtkTextActor()
    actor.SetInput("overlay")
    actor.SetPosition(20, 20)
    actor.GetTextProperty().SetFontSize(30)
    return actor


def volume(mapper=None):
    wavelet = vtkRTAnalyticSource()
    wavelet.SetWholeExtent(-5, 5, -5, 5, -5, 5)
    mapper = mapper or vtkFixedPointVolumeRayCastMapper()
    mapper.SetInputConnection(wavelet.GetOutputPort())
    colors = vtkColorTransferFunction()
    colors.AddRGBPoint(50, 0.9, 0.9, 0.2)
    colors.AddRGBPoint(280, 0.2, 0.3, 0.9)
    opacity = vtkPiecewiseFunction()
    opacity.AddPoint(50, 0.0)
    opacity.AddPoint(280, 0.3)
    prop = vtkVolumeProperty()
    prop.SetColor(colors)
    prop.SetScalarOpacity(opacity)
    actor = vtkVolume()
    actor.SetMapper(mapper)
    actor.SetProperty(prop)
    actor.SetScale(0.12)
    actor.SetPosition(0.5, 0.2, 0.2)
    return actor


GUESTS = [lines, points, wireframe, mip_mapped, translucent, anisotropic, text, volume]


def compare(renderer, render):
    expected = render(renderer).astype(int)
    rt = vtkHybridRayTracingPass()
    rt.SetShadowModeToOff()
    renderer.SetPass(rt)
    shown = render(renderer).astype(int)
    return rt, np.count_nonzero(np.abs(shown - expected).max(axis=2) > 1) / expected[..., 0].size


# The traced ball covers 8 % of the picture with an outline of 0.5 %; where it meets a guest the depth
# of the two rasterisations may differ in the last bits, on a line one pixel wide.
OUTLINE_SHARE = 0.005


@pytest.mark.parametrize("guest", GUESTS, ids=lambda guest: guest.__name__)
def test_drawn_by_vtk_where_it_belongs(guest, render):
    actor = guest()
    renderer = scenes.renderer_of(ball(Color=(0.7, 0.7, 0.8)), actor)
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    scenes.look(renderer, (0.6, 1.2, 4))
    alone = render(renderer)
    actor.VisibilityOff()
    assert (render(renderer) != alone).any(), "the guest must be seen"
    actor.VisibilityOn()
    rt, wrong = compare(renderer, render)
    print(f"{guest.__name__}: {100 * wrong:.3f} % of the pixels differ")
    assert wrong < OUTLINE_SHARE
    assert statistics(rt)["stages"]["visibility"]["ran"]


def test_assembly_with_a_part_that_vtk_draws(render):
    """Nothing of it is drawn twice: its traced part would be overdrawn without its shadow."""
    assembly = scenes.vtkAssembly()
    assembly.AddPart(ball())
    assembly.AddPart(mip_mapped())
    assembly.SetPosition(0.2, 0.1, 0)
    renderer = scenes.renderer_of(assembly, ball(-0.9, 0.3))
    scenes.look(renderer, (0.6, 1.2, 4))
    rt, wrong = compare(renderer, render)
    assert wrong < OUTLINE_SHARE
    assert len(statistics(rt)["left_to_vtk"]) == 1


def image_actor():
    canvas = vtkImageCanvasSource2D()
    canvas.SetScalarTypeToUnsignedChar()
    canvas.SetNumberOfScalarComponents(3)
    canvas.SetExtent(0, 63, 0, 63, 0, 0)
    canvas.SetDrawColor(255, 220, 40)
    canvas.FillBox(0, 63, 0, 63)
    actor = vtkImageActor()
    actor.GetMapper().SetInputConnection(canvas.GetOutputPort())
    actor.SetScale(0.02)
    return actor


@pytest.mark.parametrize("kind", [scenes.vtkAssembly, vtkPropAssembly])
def test_assembly_with_a_prop_that_is_no_actor(kind, render):
    """Nothing of it may vanish because the tracer draws another part of it."""
    assembly = kind()
    assembly.AddPart(ball(-0.6))
    assembly.AddPart(image_actor())
    renderer = scenes.renderer_of(assembly, ball(0.9, 0.3))
    scenes.look(renderer, (0.6, 1.2, 4))
    rt, wrong = compare(renderer, render)
    assert wrong < OUTLINE_SHARE
    assert "not an actor" in next(iter(statistics(rt)["hosted"].values()))


def test_image_based_lighting_survives(render):
    """VTK binds the environment's textures before a pass runs and expects them there afterwards."""
    canvas = vtkImageCanvasSource2D()
    canvas.SetScalarTypeToUnsignedChar()
    canvas.SetNumberOfScalarComponents(3)
    canvas.SetExtent(0, 63, 0, 31, 0, 0)
    canvas.SetDrawColor(200, 100, 50)
    canvas.FillBox(0, 63, 0, 31)
    texture = vtkTexture()
    texture.SetInputConnection(canvas.GetOutputPort())
    texture.MipmapOn()
    texture.InterpolateOn()
    renderer = scenes.renderer_of(physically_based(), scenes.actor_of(scenes.plane(2.0, -0.6)))
    renderer.UseImageBasedLightingOn()
    renderer.SetEnvironmentTexture(texture)
    scenes.look(renderer, (0.6, 1.2, 4))
    render(renderer)  # the maps are computed
    _, wrong = compare(renderer, render)
    assert wrong < OUTLINE_SHARE


def test_volumes_are_peeled_when_asked(render):
    renderer = scenes.renderer_of(ball(-0.8, 0.3), translucent(), volume(vtkGPUVolumeRayCastMapper()))
    renderer.SetUseDepthPeeling(True)
    renderer.SetUseDepthPeelingForVolumes(True)
    scenes.look(renderer, (0.6, 1.2, 4))
    _, wrong = compare(renderer, render)
    assert wrong < OUTLINE_SHARE


@pytest.mark.parametrize("host", [vtkSSAAPass, vtkGaussianBlurPass, vtkToneMappingPass])
def test_as_delegate_of_another_pass(host, render):
    """An image processing pass hands on a framebuffer of its own, of another size than the viewport."""
    pictures = []
    for delegate in (vtkRenderStepsPass(), vtkHybridRayTracingPass()):
        renderer = scenes.renderer_of(ball(), lines(), background=(0.1, 0.2, 0.3))
        renderer.SetViewport(0.3, 0.2, 0.9, 0.8)
        scenes.look(renderer, (0.6, 1.2, 4))
        if isinstance(delegate, vtkHybridRayTracingPass):
            delegate.SetShadowModeToOff()
        outer = host()
        outer.SetDelegatePass(delegate)
        renderer.SetPass(outer)
        pictures.append(render(renderer).astype(int))
    differ = np.abs(pictures[0] - pictures[1]).max(axis=2) > 1
    assert differ.mean() < OUTLINE_SHARE
    assert (pictures[0] != pictures[0][0, 0]).any()


@pytest.mark.parametrize("peeling", [False, True], ids=["blended", "peeled"])
def test_translucent_layers(peeling, render):
    renderer = scenes.renderer_of(ball(), translucent(), ball(-0.3, 0.7, Opacity=0.3, Color=(0, 1, 0)))
    renderer.SetUseDepthPeeling(peeling)
    renderer.SetMaximumNumberOfPeels(20)
    scenes.look(renderer, (0.6, 1.2, 4))
    _, wrong = compare(renderer, render)
    assert wrong < OUTLINE_SHARE


def test_statistics_name_what_is_left_to_vtk(render):
    """Surfaces that are not traced apart from what VTK draws by its nature."""
    streamed = ball(0.5)
    streamed.GetMapper().SetNumberOfSubPieces(2)
    guests = [streamed, lines(), wireframe(), translucent(), volume()]
    renderer = scenes.renderer_of(ball(), *guests)
    scenes.look(renderer, (0.6, 1.2, 4))
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    render(renderer)
    report = statistics(rt)
    assert [name.split("#")[1] for name in report["left_to_vtk"]] == ["1"]
    assert [name.split("#")[1] for name in report["hosted"]] == ["2", "3", "4", "5"]
    assert all({**report["left_to_vtk"], **report["hosted"]}.values())


def test_what_planes_cut_away_is_seen_by_nobody(render):
    """Two planes through a ball and its scalars, on a turned actor: VTK's picture; and the part of the
    shadow that the missing part would cast is lit."""
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(30)
    source.SetPhiResolution(30)
    source.SetRadius(0.8)
    elevation = vtkElevationFilter()
    elevation.SetInputConnection(source.GetOutputPort())
    elevation.SetLowPoint(0, 0, -0.8)
    elevation.SetHighPoint(0, 0, 0.8)
    actor = scenes.actor_of(elevation)
    actor.RotateX(30)
    for origin, normal in (((0.1, 0, 0), (1, 0.1, 0)), ((0, 0, 0.3), (0, 0, -1))):
        plane = vtkPlane()
        plane.SetOrigin(origin)
        plane.SetNormal(normal)
        actor.GetMapper().AddClippingPlane(plane)
    renderer = scenes.renderer_of(actor, scenes.actor_of(scenes.plane(2.0, -1.0)))
    renderer.AddLight(scenes.scene_light((0, 5, 0)))
    scenes.look(renderer, (2.0, 3.0, 3))
    rt, wrong = compare(renderer, render)
    assert not statistics(rt)["left_to_vtk"]
    print(f"clipped: {100 * wrong:.3f} % of the pixels differ")
    assert wrong < OUTLINE_SHARE
    rt.SetShadowModeToExact()
    rt.SetBuffers(["shadow", "prop"])
    shadows = []
    for cut in (True, False):
        if not cut:
            actor.GetMapper().RemoveAllClippingPlanes()
        render(renderer)
        shadows.append(((buffer(rt, "prop") == 1) & (buffer(rt, "shadow") == 0)).sum())
    assert 0.1 * shadows[1] < shadows[0] < 0.8 * shadows[1]


@pytest.mark.parametrize("kind", ["lines", "vertices", "shown vertices"])
def test_lines_and_vertices_of_a_traced_surface_are_seen_on_it(kind, render):
    """The surface is traced; VTK draws the rest where it draws it itself."""
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(24)
    source.SetPhiResolution(16)
    source.Update()
    mesh = source.GetOutput()
    cells = vtkCellArray()
    for i in range(mesh.GetNumberOfPolys()):
        corners = mesh.GetCell(i).GetPointIds()
        ids = [corners.GetId(k) for k in range(3)]
        if kind == "lines":
            cells.InsertNextCell(4, [*ids, ids[0]])
        else:
            cells.InsertNextCell(3, ids)
    # Off the surface by more than two rasterisers' depths differ.
    lifted = vtkPolyData()
    lifted.DeepCopy(mesh)
    points = lifted.GetPoints()
    for i in range(points.GetNumberOfPoints()):
        points.SetPoint(i, [1.01 * x for x in points.GetPoint(i)])
    both = vtkAppendPolyData()
    both.AddInputData(mesh)
    if kind == "lines":
        lifted.SetPolys(vtkCellArray())
        lifted.SetLines(cells)
        both.AddInputData(lifted)
    elif kind == "vertices":
        lifted.SetPolys(vtkCellArray())
        lifted.SetVerts(cells)
        both.AddInputData(lifted)
    both.Update()
    actor = scenes.actor_of(both, Color=(0.9, 0.7, 0.3), PointSize=4.0, LineWidth=2.0)
    if kind == "shown vertices":
        actor.GetProperty().VertexVisibilityOn()
        actor.GetProperty().SetVertexColor(0.1, 0.1, 0.6)
    renderer = scenes.renderer_of(actor)
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    scenes.look(renderer, (0.6, 1.2, 2.5))
    rt, wrong = compare(renderer, render)
    report = statistics(rt)
    assert not report["left_to_vtk"] and not report["hosted"] and report["triangles"] > 500
    print(f"{kind}: {100 * wrong:.3f} % of the pixels differ")
    assert wrong < (0.02 if kind == "shown vertices" else OUTLINE_SHARE)


def test_glass_actor_with_opacity_is_drawn_once(render):
    """Glass on request wins over opacity; VTK's translucent pass must not draw the actor again."""
    glass = ball(Opacity=0.5)
    vtkHybridMaterial.SetGlass(glass, 1.0)
    renderer = scenes.renderer_of(glass, background=(0.2, 0.4, 0.6))
    scenes.look(renderer, (0, 0, 4))
    renderer.SetPass(vtkHybridRayTracingPass())
    picture = render(renderer).astype(int)
    # Glass of index 1 neither reflects nor bends: only the background is seen through it.
    assert (np.abs(picture - picture[0, 0]) <= 1).all()


def test_hidden_lines_are_removed(render):
    """A wireframe whose far lines its near faces hide, before a traced plane."""
    wires = ball(Representation=1, Color=(0.9, 0.3, 0.2), Lighting=False)
    renderer = scenes.renderer_of(wires, scenes.actor_of(scenes.plane(2.0, -0.6)))
    scenes.look(renderer, (0.6, 1.2, 4))
    counts = []
    for hidden in (False, True):
        renderer.SetUseHiddenLineRemoval(hidden)
        for rt in (None, vtkHybridRayTracingPass()):
            renderer.SetPass(rt)
            picture = render(renderer).astype(int)
            counts.append(np.count_nonzero(picture[..., 0] > picture[..., 1] + 60))
    assert counts[1] == pytest.approx(counts[0], rel=0.01)
    assert counts[3] == pytest.approx(counts[2], rel=0.01)
    assert counts[3] < 0.8 * counts[1]


@pytest.mark.parametrize("others", [False, True])
def test_depth_buffer_is_true_gl_depth(render, others):
    """What VTK reads from the window (for picking, widgets, composites) is what its own picture has. Where
    VTK draws more, it is a little behind that, by what rounding explains: what VTK draws in the same place
    must be seen."""
    renderer = scenes.renderer_of(ball(), scenes.actor_of(scenes.plane(2.0, -0.6)))
    if others:
        wires = ball(Representation=1)
        wires.SetScale(0.1)  # within the other
        renderer.AddActor(wires)
    scenes.look(renderer, (0.6, 1.2, 4))
    depths = []
    for rt in (None, vtkHybridRayTracingPass()):
        renderer.SetPass(rt)
        render(renderer)
        depths.append(
            np.array([[renderer.GetZ(x, y) for x in range(20, 290, 9)] for y in range(20, 290, 9)])
        )
    behind = depths[1] - depths[0]
    # 24 bits in the window, float arithmetic of 2^-23 in both rasterisations.
    rounding = 4 * 2.0**-23
    if not others:
        assert np.quantile(np.abs(behind), 0.97) < rounding
        return
    seen = depths[0] < 1
    assert np.quantile(-behind[seen], 0.97) < rounding
    # Rendering/OpenGL2/DepthMargin.h: 3 u (S(z) + S(w)) / w + 8 u, and the depth's change to the next
    # pixel over 128. All is within 2 of the origin in each axis, and nothing nearer than 2 to the camera.
    camera = renderer.GetActiveCamera()
    matrix = camera.GetCompositeProjectionTransformMatrix(1, -1, 1)
    sums = sum(
        abs(matrix.GetElement(row, column)) * (2, 2, 2, 1)[column] for row in (2, 3) for column in range(4)
    )
    # Nine pixels from one sample to the next.
    change = np.abs(np.gradient(depths[0])).max(axis=0)[seen] / 9
    margin = (3 * sums / 2 + 8 + 4) * 2.0**-24 + np.minimum(change, 2.0**-10) / 64
    assert np.quantile(behind[seen] - margin, 0.97) < 0
    assert np.median(behind[seen]) > 0
