"""The per-pixel buffers as numpy arrays: shapes, conventions, and values against VTK's own answers."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, set_buffers, vtkHybridRayTracingPass

SIZE = (240, 180)
ALL = ["triangle", "cell", "prop", "barycentric", "position", "normal", "depth", "shadow"]


@pytest.fixture
def rendered(render):
    torus = scenes.actor_of(scenes.torus())
    floor = scenes.actor_of(scenes.plane(2.0, -0.6, 4))
    floor.SetPosition(0, 0.1, 0)
    renderer = scenes.renderer_of(torus, floor)
    renderer.AddLight(scenes.scene_light((1, 3, 2)))
    renderer.AddLight(scenes.scene_light((-1, 3, 2)))
    scenes.look(renderer, (0.5, 2, 5))
    rt = vtkHybridRayTracingPass()
    rt.SetBuffers(ALL)
    renderer.SetPass(rt)
    render(renderer, SIZE)
    return renderer, rt, torus, floor


def test_shapes_types_and_what_no_hit_looks_like(rendered):
    _, rt, _, _ = rendered
    components = dict(barycentric=2, position=3, normal=3, shadow=2)
    miss = buffer(rt, "triangle") < 0
    assert 0.1 < miss.mean() < 0.9
    for name in ALL:
        values = buffer(rt, name)
        count = components.get(name)
        assert values.shape == SIZE[::-1] + ((count,) if count else ())
        if name in ("triangle", "cell", "prop"):
            assert values.dtype == np.int64
            assert (values[miss] == -1).all() and (values[~miss] >= 0).all()
        else:
            assert np.isnan(values[miss]).all() and np.isfinite(values[~miss]).all()


def test_values_agree_with_each_other_and_with_the_data(rendered):
    renderer, rt, torus, floor = rendered
    prop, cell, triangle = (buffer(rt, n) for n in ("prop", "cell", "triangle"))
    position, uv = buffer(rt, "position"), buffer(rt, "barycentric")
    actors = [torus, floor]
    for k, actor in enumerate(actors):
        assert rt.GetPropFromId(k) is actor
    assert rt.GetPropFromId(-1) is None and rt.GetPropFromId(2) is None
    data = torus.GetMapper().GetInput()
    rows, columns = np.nonzero(prop == 0)
    for row, column in list(zip(rows, columns))[:: len(rows) // 50]:
        corners = data.GetCell(cell[row, column]).GetPoints()
        a, b, c = (np.array(corners.GetPoint(i)) for i in range(3))
        u, v = uv[row, column]
        # Positions are floats of size 1.4: three terms of one rounding each.
        assert np.allclose(a + u * (b - a) + v * (c - a), position[row, column], atol=1e-6)
        assert triangle[row, column] == cell[row, column]  # one triangle a cell, first part
    # The floor's quads are two triangles each, and its matrix shifts it.
    on_floor = prop == 1
    assert np.allclose(position[on_floor][:, 1], -0.5, atol=1e-6)
    assert (cell[on_floor] < 16).all()
    assert (triangle[on_floor] >= data.GetNumberOfCells()).all()


def test_position_and_depth_lie_on_the_pixels_ray(rendered):
    renderer, rt, _, _ = rendered
    position, depth = buffer(rt, "position"), buffer(rt, "depth")
    camera = renderer.GetActiveCamera()
    eye = np.array(camera.GetPosition())
    forward = np.array(camera.GetDirectionOfProjection())
    rows, columns = np.nonzero(np.isfinite(depth))
    for row, column in list(zip(rows, columns))[:: len(rows) // 40]:
        p = position[row, column]
        assert np.dot(p - eye, forward) == pytest.approx(depth[row, column], abs=1e-9)
        renderer.SetWorldPoint(*p, 1.0)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        # VTK's display coordinates count from the corner of the first pixel. Off by at most the
        # distance by which a rasteriser's snapped edge may miss a pixel's centre, 2^-8 of a pixel.
        assert abs(x - (column + 0.5)) < 2.0**-8 and abs(y - (row + 0.5)) < 2.0**-8


def test_normals_face_the_viewer(rendered):
    renderer, rt, _, _ = rendered
    position, normal = buffer(rt, "position"), buffer(rt, "normal")
    hit = np.isfinite(buffer(rt, "depth"))
    assert np.allclose(np.linalg.norm(normal[hit], axis=1), 1.0)
    toward = np.array(renderer.GetActiveCamera().GetPosition()) - position[hit]
    # Interpolated normals may lean away at the outline by up to the mesh's fold.
    assert (np.sum(toward * normal[hit], axis=1) > 0).mean() > 0.98


def test_still_frame_keeps_the_buffers(rendered, render):
    renderer, rt, _, _ = rendered
    before = buffer(rt, "position").copy()
    render(renderer, SIZE)
    assert np.array_equal(before, buffer(rt, "position"), equal_nan=True)


def test_what_was_not_asked_for_is_an_error(rendered, render):
    renderer, rt, _, _ = rendered
    rt.SetBuffers(["depth"])
    with pytest.raises(RuntimeError, match="render"):
        buffer(rt, "depth")
    render(renderer, SIZE)
    assert np.isfinite(buffer(rt, "depth")).any()
    with pytest.raises(RuntimeError, match="asked"):
        buffer(rt, "position")
    with pytest.raises(ValueError, match="triangle"):
        buffer(rt, "nonsense")
    with pytest.raises(ValueError, match="nonsense"):
        set_buffers(rt, ["nonsense"])
