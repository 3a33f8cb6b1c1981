"""Mirrors and glass through the whole chain against optics on paper: a plane mirror, and a sphere of
glass with its two refractions. What is seen in them is a board of unlit coloured cells, so that the
colour of a pixel tells which cell its ray met."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

CELLS = 8
BACKGROUND = (51, 102, 153)


def cell_colors():
    """A different colour for each cell, none equal to the background."""
    k = np.arange(CELLS * CELLS)
    return np.stack([255 - 3 * k, 40 + 3 * k, (k * 61) % 200], axis=1).astype(np.uint8)


def board(origin, point1, point2):
    """An unlit board of CELLS x CELLS coloured cells."""
    source = scenes.vtkPlaneSource()
    source.SetOrigin(*origin)
    source.SetPoint1(*point1)
    source.SetPoint2(*point2)
    source.SetResolution(CELLS, CELLS)
    source.Update()
    data = vtkPolyData()
    data.ShallowCopy(source.GetOutput())
    colors = vtkUnsignedCharArray()
    colors.SetName("colors")
    colors.SetNumberOfComponents(3)
    for color in cell_colors():
        colors.InsertNextTuple3(*(int(c) for c in color))
    data.GetCellData().SetScalars(colors)
    return scenes.actor_of(data, Lighting=False, Ambient=0.0, Diffuse=1.0)


def expected_colors(origin, direction, corner, side1, side2):
    """The colours that rays see on the board, and by how much of a cell each clears the nearest cell
    border (so that a pixel on a border is not held against the picture)."""
    side1, side2, corner = (np.asarray(v, float) for v in (side1, side2, corner))
    normal = np.cross(side1, side2)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.sum((corner - origin) * normal, axis=1) / np.sum(direction * normal, axis=1)
        point = origin + t[:, None] * direction - corner
        a = np.sum(point * side1, axis=1) / np.dot(side1, side1) * CELLS
        b = np.sum(point * side2, axis=1) / np.dot(side2, side2) * CELLS
    inside = (t > 0) & (a > 0) & (a < CELLS) & (b > 0) & (b < CELLS)
    colors = np.tile(np.array(BACKGROUND, np.uint8), (len(t), 1))
    column = np.clip(np.nan_to_num(a), 0, CELLS - 1).astype(int)
    row = np.clip(np.nan_to_num(b), 0, CELLS - 1).astype(int)
    colors[inside] = cell_colors()[(row * CELLS + column)[inside]]
    # Distance to the border lines; beyond the board only its outline counts.
    to_line = np.minimum(np.abs(a - np.round(a)), np.abs(b - np.round(b)))
    outline = np.maximum(
        np.maximum(-a, a - CELLS), np.maximum(-b, b - CELLS)
    )
    clearance = np.where(inside, to_line, np.where(t > 0, outline, np.inf))
    return colors, np.nan_to_num(clearance, nan=0.0, posinf=np.inf)


def rays_to(renderer, position):
    camera = renderer.GetActiveCamera()
    direction = position - np.array(camera.GetPosition())
    return direction / np.linalg.norm(direction, axis=1, keepdims=True)


@pytest.mark.parametrize("size", [(300, 300), (500, 200)], ids=lambda s: f"{s[0]}x{s[1]}")
@pytest.mark.parametrize("visibility", ["ItemBuffer", "DirectRendering"])
def test_plane_mirror(render, size, visibility):
    mirror = scenes.actor_of(scenes.plane(2.0, 0.0), Diffuse=0.0, Ambient=0.0)
    vtkHybridMaterial.SetReflectance(mirror, 1.0)
    corner, side1, side2 = (-1.0, 0.2, -1.0), (2.0, 0.0, 0.5), (0.0, 1.5, 0.0)
    wall = board(corner, np.add(corner, side1), np.add(corner, side2))
    renderer = scenes.renderer_of(mirror, wall, background=np.array(BACKGROUND) / 255)
    scenes.look(renderer, (0.5, 1.5, 3.5), (0, 0.3, 0))
    rt = vtkHybridRayTracingPass()
    getattr(rt, "SetVisibilityTo" + visibility)()
    rt.SetBuffers(["prop", "position"])
    renderer.SetPass(rt)
    shown = render(renderer, size)

    in_mirror = buffer(rt, "prop") == 0
    position = buffer(rt, "position")[in_mirror]
    direction = rays_to(renderer, position) * (1, -1, 1)
    colors, clearance = expected_colors(position, direction, corner, side1, side2)
    # Rays start in double precision from float corners: 2^-23 of the scene's size of 4 over a path of
    # about that length and a cell of 0.19, so 1e-5 of a cell.
    certain = clearance > 1e-5
    wrong = np.any(np.abs(shown[in_mirror].astype(int) - colors) > 1, axis=1) & certain
    print(f"mirror {size} {visibility}: {wrong.sum()} wrong of {certain.sum()} mirror pixels")
    seen = np.any(colors != np.array(BACKGROUND, np.uint8), axis=1)
    assert seen.sum() > 1000 and (~seen).sum() > 1000
    assert wrong.sum() == 0
    assert statistics(rt)["rays"]["reflection"]["traced"] >= seen.sum()


def test_half_mirror_mixes_its_own_colour_with_the_image(render):
    mirror = scenes.actor_of(scenes.plane(2.0), Lighting=False, Color=(1, 1, 1), Ambient=0.0)
    vtkHybridMaterial.SetReflectance(mirror, 0.25)
    renderer = scenes.renderer_of(mirror, background=(0.0, 0.0, 0.4))
    scenes.look(renderer, (0, 3, 3))
    renderer.SetPass(vtkHybridRayTracingPass())
    shown = render(renderer)
    expected = 0.75 * np.array([255, 255, 255]) + 0.25 * np.array([0, 0, 0.4 * 255])
    middle = shown[150, 150].astype(int)
    assert (np.abs(middle - expected) <= 1).all()


def refract(direction, normal, ratio):
    """Snell's law for unit vectors, the normal against the ray; no total reflection occurs here."""
    cosine = -np.sum(direction * normal, axis=1, keepdims=True)
    sine2 = ratio * ratio * (1.0 - cosine * cosine)
    return ratio * direction + (ratio * cosine - np.sqrt(1.0 - sine2)) * normal


def test_glass_sphere(render):
    """Every ray through a sphere of glass enters, crosses a chord, leaves: against the same path on a
    perfect sphere. Reflections are off, so that all light goes through."""
    radius, ior = 0.8, 1.5
    facets = 400
    source = scenes.vtkSphereSource()
    source.SetRadius(radius)
    source.SetThetaResolution(facets)
    source.SetPhiResolution(facets)
    ball = scenes.actor_of(source, Specular=0.0)
    vtkHybridMaterial.SetGlass(ball, ior)
    corner, side1, side2 = (-2.0, -2.0, -2.5), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)
    wall = board(corner, np.add(corner, side1), np.add(corner, side2))
    renderer = scenes.renderer_of(ball, wall, background=np.array(BACKGROUND) / 255)
    scenes.look(renderer, (0.3, 0.2, 5.0), angle=24)
    rt = vtkHybridRayTracingPass()
    rt.ReflectionsOff()
    rt.SetShadowModeToOff()
    rt.SetBuffers(["prop", "position"])
    renderer.SetPass(rt)
    shown = render(renderer, (300, 300))

    on_ball = buffer(rt, "prop") == 0
    eye = np.array(renderer.GetActiveCamera().GetPosition())
    direction = rays_to(renderer, buffer(rt, "position")[on_ball])
    b = np.sum(direction * eye, axis=1)
    discriminant = b * b - (eye @ eye - radius * radius)
    # Rays that meet the sphere at less than 60 degrees: towards the rim the facets' own shape counts.
    good = discriminant > (0.5 * radius) ** 2
    enter = eye + (-b - np.sqrt(np.maximum(discriminant, 0)))[:, None] * direction
    inner = refract(direction, enter / radius, 1 / ior)
    leave = enter - 2 * np.sum(enter * inner, axis=1, keepdims=True) * inner
    outer = refract(inner, -leave / radius, ior)
    colors, clearance = expected_colors(leave, outer, corner, side1, side2)
    # The facets' flat shape: points lie up to radius * h^2 / 8 inside the sphere and interpolated
    # normals turn by up to h^2 / 8 more, with h = 2 pi / facets; the two refractions and the path of
    # 3.3 to the wall amplify that by less than 3 * (1 + 3.3 / radius * 2), in cells of half a unit.
    h = 2 * np.pi / facets
    certain = good & (clearance > 3 * (1 + 2 * 3.3 / radius) * h * h / 8 / 0.5)
    wrong = np.any(np.abs(shown[on_ball].astype(int) - colors) > 1, axis=1) & certain
    print(f"glass sphere: {wrong.sum()} wrong of {certain.sum()} certain pixels of {on_ball.sum()}")
    assert certain.sum() > 0.5 * on_ball.sum()
    assert wrong.sum() == 0


def test_reflectance_of_glass_head_on(render):
    """Fresnel at normal incidence: a slab's two surfaces of 4 % each (n = 1.5) in front of white, black
    behind the viewer: what comes through is (1 - 0.04)^2 to first order."""
    near = scenes.actor_of(scenes.vtkCubeSource())
    vtkHybridMaterial.SetGlass(near, 1.5)
    renderer = scenes.renderer_of(near, background=(1, 1, 1))
    scenes.look(renderer, (0, 0, 6))
    rt = vtkHybridRayTracingPass()
    rt.ReflectionsOff()
    renderer.SetPass(rt)
    assert (render(renderer)[150, 150] == 255).all()  # all energy goes through
    rt.ReflectionsOn()
    # White all around: what is reflected outside is white too; inside, depth 3 cuts the series off
    # after three bounces, which loses at most F^2 (1 - F) < 0.002, less than one step.
    assert (render(renderer)[150, 150] >= 254).all()


def test_depth_limits_the_recursion(render):
    """Two facing mirrors: each bounce more shows one more image."""
    front = scenes.actor_of(scenes.plane(12.0), Lighting=False, Color=(1, 1, 1), Ambient=0.0)
    back = scenes.actor_of(scenes.plane(12.0, 1.0), Lighting=False, Color=(1, 1, 1), Ambient=0.0)
    for actor in (front, back):
        vtkHybridMaterial.SetReflectance(actor, 0.5)
    renderer = scenes.renderer_of(front, back, background=(0, 0, 0))
    scenes.look(renderer, (0.0, 0.5, 0.9), (0.0, 0.45, 0.0), angle=60)
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    sums = []
    for depth in range(4):
        rt.SetMaximumDepth(depth)
        sums.append(int(render(renderer, (200, 200)).astype(int).sum()))
    assert sums[1] < sums[0]  # depth 0: mirrors are off and show their full own colour
    assert sums[1] < sums[2] < sums[3]  # more images add light
