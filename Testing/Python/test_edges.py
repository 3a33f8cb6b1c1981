"""Actors that show the edges of their cells are traced: widths, colours and fading are VTK's own."""

import numpy as np
import pytest
import scenes
from test_parity import check, compare, near_silhouette
from test_textures import MODES, photograph, sheet, texture_of
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPlane, vtkPolyData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersCore import vtkStripper, vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkRegularPolygonSource


def edged(source, **properties):
    properties = {"Color": (0.9, 0.7, 0.5), "EdgeColor": (0.1, 0.2, 0.6), **properties}
    return scenes.actor_of(source, EdgeVisibility=True, **properties)


def lit(*actors, position=(0.5, 1.5, 2.0)):
    renderer = scenes.renderer_of(*actors)
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    return scenes.look(renderer, position)


def quads(**properties):
    return lit(edged(scenes.plane(1.0, 0.0, 12), **properties))


def triangles(**properties):
    return lit(edged(scenes.torus(2048), Specular=0.3, **properties), position=(1, 2, 5))


def polygons(**properties):
    """A cylinder's caps have 17 corners; a plate of 9 corners lies before it."""
    cylinder = scenes.vtkCylinderSource()
    cylinder.SetResolution(17)
    plate = vtkRegularPolygonSource()
    plate.SetNumberOfSides(9)
    plate.SetRadius(0.4)
    plate.SetCenter(0.3, 0.2, 0.9)
    plate.SetNormal(1, 0.3, 2)
    plate.GeneratePolylineOff()
    return lit(
        edged(cylinder, Interpolation=0, **properties), edged(plate, **properties), position=(1, 1.4, 2.5)
    )


def ball(**properties):
    """Smooth shading over four-sided cells and the triangles around the poles."""
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(24)
    source.SetPhiResolution(16)
    source.LatLongTessellationOn()
    return lit(edged(source, Specular=0.4, **properties), position=(0.5, 0.8, 1.5))


def face_on(**properties):
    """Equal depths everywhere: what is drawn last is seen."""
    actor = edged(scenes.plane(1.0, 0.0, 12), **properties)
    actor.RotateX(90)
    return lit(actor, position=(0, 0, 4))


def strips(**properties):
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(20)
    source.SetPhiResolution(14)
    triangle_filter = vtkTriangleFilter()
    triangle_filter.SetInputConnection(source.GetOutputPort())
    stripper = vtkStripper()
    stripper.SetInputConnection(triangle_filter.GetOutputPort())
    return lit(edged(stripper, **properties), position=(0.5, 0.8, 1.5))


def coloured(**properties):
    """Cell scalars under the edges, and an actor that is not lit."""
    source = scenes.plane(1.0, 0.0, 8)
    source.Update()
    data = vtkPolyData()
    data.ShallowCopy(source.GetOutput())
    values = vtkFloatArray()
    for i in range(64):
        values.InsertNextValue((i * 37) % 64)
    data.GetCellData().SetScalars(values)
    actor = edged(data, **properties)
    actor.GetMapper().SetScalarRange(0, 63)
    unlit = edged(scenes.vtkCubeSource(), Lighting=False, **properties)
    unlit.SetScale(0.5)
    unlit.SetPosition(0, 0.5, 0)
    return lit(actor, unlit)


def textured(**properties):
    """VTK multiplies the edges with the texture too."""
    actor = sheet(texture_of(photograph(), True), EdgeVisibility=True, EdgeColor=(1, 0.9, 0.2), **properties)
    actor.RotateX(-60)
    return lit(actor)


def turned_over(**properties):
    """A mirroring matrix, and sides that are culled: of the edges the half on the shown side stays."""
    mirrored = edged(scenes.vtkCubeSource(), **properties)
    matrix = vtkMatrix4x4()
    for i, value in enumerate((-0.6, 0.8, 0.7)):
        matrix.SetElement(i, i, value)
    matrix.SetElement(0, 3, 0.7)
    mirrored.SetUserMatrix(matrix)
    culled = edged(scenes.vtkCubeSource(), BackfaceCulling=True, **properties)
    culled.SetPosition(-0.7, 0, 0)
    culled.RotateY(20)
    return lit(mirrored, culled, position=(0.6, 1.5, 3.0))


def clipped(**properties):
    """A mapper's clipping plane cuts cells; the cut is no edge."""
    actor = edged(scenes.plane(1.0, 0.0, 12), **properties)
    plane = vtkPlane()
    plane.SetOrigin(0.2, 0, 0.1)
    plane.SetNormal(-1, 0, 0.3)
    actor.GetMapper().AddClippingPlane(plane)
    return lit(actor)


def tubes(**properties):
    return ball(RenderLinesAsTubes=True, Ambient=0.1, **properties)


SCENES = [quads, triangles, polygons, ball, face_on, strips, coloured, textured, turned_over, clipped]


def from_one_of(mask):
    grown = mask.copy()
    for axis in (0, 1):
        for step in (-1, 1):
            grown |= np.roll(mask, step, axis)
    return grown


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("width", [1.0, 3.0])
def test_same_picture_as_vtk(scene, width, render):
    pictures = []
    for visibility, shading in MODES:
        renderer = scene(LineWidth=width)
        figures = compare(renderer, render, visibility, shading=shading)
        check(f"{scene.__name__}, width {width:g}, {visibility} {shading}", figures)
        pictures.append(render(renderer, (400, 300)).astype(int))
    for other in (2, 3):
        assert (np.abs(pictures[0] - pictures[other]).max(axis=2) <= 1).mean() >= 0.9999


@pytest.mark.parametrize("width", [1.0, 3.0])
def test_tubes(width, render):
    for visibility, shading in MODES:
        figures = compare(tubes(LineWidth=width), render, visibility, shading=shading)
        check(f"tubes, width {width:g}, {visibility} {shading}", figures)


def test_parallel_projection(render):
    renderer = quads(LineWidth=2.0)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(1.1)
    renderer.ResetCameraClippingRange()
    check("parallel", compare(renderer, render))


def test_concave_cells_show_their_border_alone(render):
    """VTK fills such a cell wrongly; of ours the inside is whole and no diagonal is drawn."""
    points = vtkPoints()
    for point in ((0, 0, 0), (2, 0, 0), (2, 2, 0), (1, 0.5, 0), (0, 2, 0)):
        points.InsertNextPoint(*point)
    cells = vtkCellArray()
    cells.InsertNextCell(5, (3, 4, 0, 1, 2))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    actor = edged(data, Lighting=False, Ambient=0.0, Diffuse=1.0, Color=(1, 1, 1), EdgeColor=(1, 0, 0), LineWidth=3)
    renderer = scenes.look(scenes.renderer_of(actor, background=(0, 0, 0)), (1, 1, 5), (1, 1, 0))
    rt = vtkHybridRayTracingPass()
    rt.SetBuffers(["position", "prop"])
    renderer.SetPass(rt)
    shown = render(renderer, (400, 300))
    position, prop = buffer(rt, "position"), buffer(rt, "prop")
    pixel = 5 * 2 * np.tan(np.radians(15)) / 300
    corners = np.array(((0, 0), (2, 0), (2, 2), (1, 0.5), (0, 2)))
    distance = np.full(prop.shape, np.inf)
    for k in range(5):
        a, b = corners[k], corners[(k + 1) % 5]
        along = np.clip(((position[..., :2] - a) @ (b - a)) / ((b - a) @ (b - a)), 0, 1)
        distance = np.fmin(distance, np.linalg.norm(position[..., :2] - a - along[..., None] * (b - a), axis=-1))
    inside = prop == 0
    assert inside.sum() > 5000
    # A triangle knows its own sides: beyond a diagonal's end another one may be near an edge without it.
    at_corner = np.min([np.linalg.norm(position[..., :2] - c, axis=-1) for c in corners], axis=0) < 6 * pixel
    far, near = inside & (distance > 2.1 * pixel), inside & (distance < 0.9 * pixel) & ~at_corner
    assert near.sum() > 200
    assert (shown[far] == 255).all()
    assert (shown[near] == (255, 0, 0)).all()


def test_edges_in_a_mirror_are_as_wide_as_those_before_it(render):
    """A grid, and its image in a mirror that lies in the middle between: the image's lines are as far
    from the eye as those of a grid that stood where the image seems to be."""
    shares = []
    for seen_in_mirror in (True, False):
        grid = edged(scenes.plane(1.0, 0.0, 8), Lighting=False, Ambient=0.0, Diffuse=1.0, Color=(1, 1, 1), EdgeColor=(0, 0, 0), LineWidth=3)
        actors = [grid]
        if seen_in_mirror:
            grid.SetPosition(0, 1, 0)
            mirror = scenes.actor_of(scenes.plane(6.0), Diffuse=0.0, Ambient=0.0)
            vtkHybridMaterial.SetReflectance(mirror, 1.0)
            actors.append(mirror)
        else:
            grid.SetPosition(0, -1, 0)
        renderer = scenes.renderer_of(*actors, background=(0, 0, 1))
        scenes.look(renderer, (0, 0.6, 4), (0, -0.8, 0))
        renderer.SetPass(vtkHybridRayTracingPass())
        shown = render(renderer, (400, 300)).astype(int)
        image = shown[:140]
        on_grid = image[..., 2] - image[..., 0] < 100
        shares.append((on_grid.sum(), (image[on_grid].max(axis=1) < 128).mean()))
    print(f"grid pixels and the lines' share: in the mirror {shares[0]}, directly {shares[1]}")
    assert shares[0][0] > 3000
    assert abs(shares[0][0] / shares[1][0] - 1) < 0.02
    assert abs(shares[0][1] / shares[1][1] - 1) < 0.03


def test_interleaving_loses_no_edge(render):
    """Lines thinner than the distance of the samples are traced all the same."""
    pictures = []
    for interleave in (1, 4):
        rt = vtkHybridRayTracingPass()
        rt.SetPrimaryShadingToCPU()
        rt.SetInterleave(interleave)
        renderer = quads()
        renderer.SetPass(rt)
        pictures.append(render(renderer))
    assert (pictures[0] == pictures[1]).all()


def test_a_scene_without_edges_keeps_its_shader_and_geometry(render):
    renderer = quads()
    actor = renderer.GetActors().GetLastActor()
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    render(renderer)
    assert statistics(rt)["surfaces"]["with_edges"] == 1
    actor.GetProperty().SetEdgeColor(1, 0, 0)
    render(renderer)
    assert not statistics(rt)["stages"]["geometry_upload"]["ran"]
    assert statistics(rt)["stages"]["primary_shading"]["reason"] == "a material changed"
    actor.GetProperty().EdgeVisibilityOff()
    render(renderer)
    assert statistics(rt)["surfaces"]["with_edges"] == 0


def test_silhouettes_are_left_out_of_parity_for_this_reason(render):
    """VTK's widened triangles reach over the silhouette by a quarter of the line's width; ours end there.
    Nothing else differs."""
    renderer = face_on(LineWidth=6.0)
    expected = render(renderer, (400, 300)).astype(int)
    rt = vtkHybridRayTracingPass()
    rt.SetShadowModeToOff()
    rt.SetBuffers(["prop", "block", "glyph", "position", "normal"])
    renderer.SetPass(rt)
    shown = render(renderer, (400, 300)).astype(int)
    different = np.abs(shown - expected).max(axis=2) > 1
    assert different.any()
    near = from_one_of(near_silhouette(rt))
    assert not (different & ~near).any()
