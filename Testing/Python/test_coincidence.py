"""Surfaces that lie in one place: which of them is seen, what passes from one to the other, and that
rounding decides nothing."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkMapper

SIZE = (200, 150)

MODES = [
    {},
    {"ShadowMode": "Exact"},
    {"Visibility": "DirectRendering"},
    {"Visibility": "RayCasting"},
    {"Visibility": "RayCasting", "PrimaryShading": "CPU"},
]
RAYS = MODES[-1]

# The outline of a square of a hundred pixels that the rasteriser and the rays may see differently.
OUTLINE = 4


def trace(renderer, **settings):
    rt = vtkHybridRayTracingPass()
    for name, value in settings.items():
        getattr(rt, f"Set{name}To{value}")()
    renderer.SetPass(rt)
    return rt


def square(resolution=1, height=0.0, size=1.0):
    source = vtkPlaneSource()
    source.SetOrigin(-size, -size, height)
    source.SetPoint1(size, -size, height)
    source.SetPoint2(-size, size, height)
    source.SetResolution(resolution, resolution)
    return source


def red_and_green(picture):
    red, green = picture[..., 0].astype(int), picture[..., 1].astype(int)
    return np.array(
        [np.count_nonzero((red > 60) & (green < 30)), np.count_nonzero((green > 60) & (red < 30))]
    )


@pytest.fixture
def topology():
    """Lets a test resolve coincident topology in its own way."""
    yield vtkMapper
    vtkMapper.SetResolveCoincidentTopologyToDefault()


@pytest.mark.parametrize("offset", [None, (-2, -2), (2, 2), (0, 40)])
@pytest.mark.parametrize("resolution", [1, 7])
def test_the_camera_sees_what_vtk_draws(render, topology, offset, resolution):
    """That drawn last; with polygon offsets that nearer by them. Other triangles in the same plane are
    parted by rounding, and VTK decides by noise: an offset is needed to say what is right."""
    if offset is None and resolution != 1:
        return
    red = scenes.actor_of(square(), Color=(1, 0, 0))
    green = scenes.actor_of(square(resolution), Color=(0, 1, 0))
    if offset:
        topology.SetResolveCoincidentTopologyToPolygonOffset()
        green.GetMapper().SetRelativeCoincidentTopologyPolygonOffsetParameters(*offset)
    renderer = scenes.renderer_of(red, green)
    renderer.AddLight(scenes.scene_light((1, -1, 5)))
    scenes.look(renderer, (0, -3, 3))
    truth = red_and_green(render(renderer, SIZE))
    assert truth.min() == 0 and truth.max() > 3000
    for mode in MODES:
        trace(renderer, **mode)
        assert np.abs(red_and_green(render(renderer, SIZE)) - truth).max() <= OUTLINE, mode


@pytest.mark.parametrize("mode", MODES, ids=str)
@pytest.mark.parametrize("distance", [3.0, 30.0])
def test_a_translucent_twin_is_drawn_over_what_is_traced(render, mode, distance):
    """The depth that is left for VTK does not hide what VTK draws in the same place."""
    red = scenes.actor_of(square(), Color=(1, 0, 0))
    green = scenes.actor_of(square(), Color=(0, 1, 0), Opacity=0.999)
    renderer = scenes.renderer_of(red, green)
    renderer.AddLight(scenes.scene_light((1, -1, 5)))
    scenes.look(renderer, (0, -distance, distance), angle=90.0 / distance)
    trace(renderer, **mode)
    shown = red_and_green(render(renderer, SIZE))
    assert shown[0] == 0 and shown[1] > 1000


@pytest.mark.parametrize("shadows, share", [("ShadowMaps", 1e-3), ("Exact", 0.0)])
def test_twins_do_not_shadow_each_other(render, shadows, share):
    """A mesh that a filter has moved, and the same that a matrix moves: where one alone is lit both are.
    Of two facets that meet in a texel of a shadow map the nearer counts, and twins are not in quite the
    same texels: a few pixels at creases may be darker in that mode."""
    ball = vtkSphereSource()
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(24)
    move = vtkTransform()
    move.Translate(0.3, -0.1, 0.7)
    move.RotateWXYZ(33, 1, 2, 3)
    move.Scale(1.3, 0.9, 1.1)
    baked = vtkTransformPolyDataFilter()
    baked.SetTransform(move)
    baked.SetInputConnection(ball.GetOutputPort())
    one = scenes.actor_of(baked, Interpolation=0)
    other = scenes.actor_of(ball, Interpolation=0)
    other.SetUserTransform(move)
    floor = scenes.actor_of(square(size=3.0))
    pictures = []
    for actors in ((floor, one), (floor, one, other)):
        renderer = scenes.renderer_of(*actors)
        renderer.AddLight(scenes.scene_light((3, 1, 5)))
        scenes.look(renderer, (2, -4, 3), (0, 0, 0.5))
        trace(renderer, ShadowMode=shadows)
        pictures.append(render(renderer, SIZE).astype(int))
    assert ((pictures[0] - pictures[1]).max(axis=2) > 2).mean() <= share


def test_a_caster_just_above_a_surface_casts(render):
    """Ten times farther away than what rounding explains: 2 (2^-23 height), by a matrix."""
    height = 1.0
    floor = scenes.actor_of(square(size=3.0, height=height))
    lid = scenes.actor_of(square(height=height))
    lid.SetPosition(0, 0, 10 * 2 * 2.0**-23 * height)
    renderer = scenes.renderer_of(floor, lid, background=(0, 0, 0))
    renderer.AddLight(scenes.scene_light((0, 0, 5)))
    # The camera is shown the floor alone.
    lid.GetProperty().FrontfaceCullingOn()
    lid.GetProperty().BackfaceCullingOn()
    scenes.look(renderer, (0, -3, 4), (0, 0, height))
    rt = trace(renderer, ShadowMode="Exact", **RAYS)
    rt.SetBuffers(["prop", "position"])
    picture = render(renderer, SIZE)
    assert not statistics(rt)["left_to_vtk"]
    floor_seen = buffer(rt, "prop") == 0
    away = np.abs(buffer(rt, "position")[..., :2]).max(axis=2)
    dark = picture.max(axis=2) < 10
    assert dark[floor_seen & (away < 0.999)].all()
    assert not dark[floor_seen & (away > 1.001)].any()


@pytest.mark.parametrize("mode", [{}, RAYS, {"Accelerator": "KdTree"}], ids=str)
@pytest.mark.parametrize("height", [0.0, 0.1])
def test_glass_that_touches_is_glass_with_a_gap(render, mode, height):
    """A glass cube on its floor, and another glass cube at its side: the picture is that with gaps which
    are too small to see."""

    def shot(gap):
        floor = scenes.actor_of(square(size=3.0, resolution=9, height=height - gap), Color=(0.9, 0.6, 0.3))
        actors = [floor]
        for side in (-1, 1):
            cube = vtkCubeSource()
            cube.SetCenter(side * (0.5 + gap), 0, 0.5 + height)
            glass = scenes.actor_of(cube, Color=(0.8, 1, 0.9))
            vtkHybridMaterial.SetGlass(glass, 1.5)
            actors.append(glass)
        renderer = scenes.renderer_of(*actors, background=(0.2, 0.3, 0.5))
        renderer.AddLight(scenes.scene_light((2, -3, 5)))
        scenes.look(renderer, (1.5, -4, 2.5), (0, 0, 0.5))
        rt = trace(renderer, **mode)
        rt.SetMaximumDepth(6)
        rt.SetBuffers(["prop"])
        picture = render(renderer, SIZE).astype(int)
        return picture, buffer(rt, "prop")

    touching, prop = shot(0.0)
    apart, _ = shot(1e-5)
    glass = prop > 0
    assert glass.mean() > 0.15
    off = np.abs(touching - apart).max(axis=2)[glass] > 8
    # A gap of 1e-5 moves an edge by 1e-3 of a pixel: of a picture's few hundred edge pixels, none or one.
    assert np.count_nonzero(off) <= 3


@pytest.mark.parametrize("scale", [1, -1])
def test_normals_under_a_mirroring_matrix_are_seen_from_outside(render, scale):
    ball = vtkSphereSource()
    ball.SetThetaResolution(30)
    ball.SetPhiResolution(30)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(ball.GetOutputPort())
    actor = scenes.actor_of(normals)
    actor.SetScale(scale, 1, 1)
    renderer = scenes.renderer_of(actor)
    scenes.look(renderer, (0.5, -2, 1))
    rt = trace(renderer, **RAYS)
    rt.SetBuffers(["prop", "normal", "position"])
    render(renderer, SIZE)
    there = buffer(rt, "prop") == 0
    outward = np.sum(buffer(rt, "normal")[there] * buffer(rt, "position")[there], axis=1)
    assert there.sum() > 3000
    assert (outward > 0).all()


@pytest.mark.parametrize("mode", ["Off", "ShadowMaps", "Exact"])
@pytest.mark.parametrize("mirror", [False, True])
def test_the_unit_of_length_does_not_show(render, mode, mirror):
    """The same scene in other units is the same picture, from 1e-16 to 1e17."""

    def shot(unit):
        cube = vtkCubeSource()
        cube.SetXLength(unit)
        cube.SetYLength(unit)
        cube.SetZLength(unit)
        cube.SetOutputPointsPrecision(1)  # vtkAlgorithm::DOUBLE_PRECISION
        floor = scenes.actor_of(square(size=2 * unit, height=-0.5 * unit), Color=(0.8, 0.8, 0.8))
        if mirror:
            vtkHybridMaterial.SetReflectance(floor, 0.3)
        renderer = scenes.renderer_of(scenes.actor_of(cube, Color=(0.9, 0.6, 0.3)), floor)
        renderer.AddLight(scenes.scene_light((2 * unit, unit, 3 * unit)))
        scenes.look(renderer, (5 * unit, -6 * unit, 4 * unit))
        trace(renderer, ShadowMode=mode)
        return render(renderer, SIZE).astype(int)

    truth = shot(1.0)
    for exponent in (-16, -12, -9, -6, -3, 3, 6, 9.05, 12, 15, 17):
        off = np.abs(shot(10.0**exponent) - truth).max(axis=2) > 2
        # Coordinates round otherwise: edges may lie on the other side of a pixel's middle.
        assert off.mean() <= 5e-4, exponent


@pytest.mark.parametrize("unit", [1.5e20, 1.5e25])
def test_what_the_range_of_float_cannot_hold_is_vtks(render, unit):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    floor = scenes.actor_of(square(size=unit), Color=(0.8, 0.8, 0.8))
    renderer = scenes.renderer_of(floor)
    renderer.AddLight(scenes.scene_light((unit, unit, 3 * unit)))
    scenes.look(renderer, (2 * unit, -3 * unit, 2 * unit))
    truth = render(renderer, SIZE)
    rt = trace(renderer)
    assert (render(renderer, SIZE) == truth).all()
    assert "too large" in str(statistics(rt)["left_to_vtk"])


def test_a_room_of_mirrors_is_closed_at_its_edges(render):
    """From the middle of a room along its axis, rays start on edges and corners exactly: none gets out."""
    room = scenes.actor_of(vtkCubeSource(), Color=(0.5, 0.5, 0.5), Ambient=1.0, Diffuse=0.0)
    vtkHybridMaterial.SetReflectance(room, 0.9)
    renderer = scenes.renderer_of(room, background=(1, 0, 0))
    scenes.look(renderer, (0, 0, 0), (0, 0, -0.1), angle=90)
    renderer.GetActiveCamera().SetClippingRange(0.01, 10)
    for mode in ({}, RAYS, {"Accelerator": "KdTree", **RAYS}):
        rt = trace(renderer, **mode)
        rt.SetMaximumDepth(8)
        picture = render(renderer, (200, 200)).astype(int)
        outside = picture[..., 0] > picture[..., 1] + 2
        assert np.count_nonzero(outside) == 0, mode
