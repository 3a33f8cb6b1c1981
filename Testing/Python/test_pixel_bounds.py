"""Pixel bounds: a frame that is restricted to some of its pixels shows those of the whole frame, bit by
bit, whoever draws it; outside of them it costs nothing and shows nothing."""

import numpy as np
import pytest

import scenes
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkFiltersModeling import vtkOutlineFilter
from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkWindowToImageFilter

SIZE = (161, 117)  # no multiple of anything
# Uneven tiles, one a single column, one a single pixel high.
COLUMNS = (0, 1, 40, 97, 161)
ROWS = (0, 50, 51, 117)
TILES = [
    (x0, x1, y0, y1) for y0, y1 in zip(ROWS, ROWS[1:]) for x0, x1 in zip(COLUMNS, COLUMNS[1:])
]
BACKGROUND = (51, 102, 153)


def everything():
    """A mirror floor, a torus, a glass body, a spot and a directional light; a translucent box and a
    wireframe that VTK draws."""
    floor = scenes.actor_of(scenes.plane(2.0, -0.6))
    vtkHybridMaterial.SetReflectance(floor, 0.5)
    glass = scenes.actor_of(scenes.superquadric(16))
    glass.SetPosition(1.2, 0, 0.7)
    glass.SetScale(0.6, 0.6, 0.6)
    vtkHybridMaterial.SetGlass(glass, 1.5)
    translucent = scenes.actor_of(scenes.superquadric(16), Opacity=0.4, Color=(0.9, 0.2, 0.2))
    translucent.SetPosition(-1.1, 0.1, 0.8)
    translucent.SetScale(0.4, 0.4, 0.4)
    outline = vtkOutlineFilter()
    outline.SetInputData(scenes.torus())
    renderer = scenes.renderer_of(
        floor, scenes.actor_of(scenes.torus()), glass, translucent, scenes.actor_of(outline)
    )
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=30.0))
    renderer.AddLight(scenes.scene_light((-1, 3, 1)))
    return scenes.look(renderer, (0, 2, 5))


def traced(renderer, visibility=0, shading="GPU", buffers=("triangle",)):
    """With a pass that shades on the GPU, on the CPU with shadow maps, or there with shadow rays."""
    rt = vtkHybridRayTracingPass()
    rt.SetVisibility(visibility)
    rt.SetPrimaryShading(int(shading == "CPU"))
    rt.SetShadowMode(2 if shading == "Exact" else 1)
    rt.SetBuffers(list(buffers))
    renderer.SetPass(rt)
    return rt


def cut(pixels, bounds):
    x0, x1, y0, y1 = bounds
    return pixels[y0:y1, x0:x1]


def same(a, b):
    """Equal bit by bit but for the kind of NaN."""
    return np.array_equal(a, b, equal_nan=a.dtype.kind == "f")


@pytest.mark.parametrize("shading", ["GPU", "CPU", "Exact"])
@pytest.mark.parametrize("visibility", [0, 1, 2], ids=["ItemBuffer", "DirectRendering", "RayCasting"])
def test_tiles_are_those_of_the_whole_frame(render, visibility, shading):
    renderer = everything()
    rt = traced(renderer, visibility, shading, vtkHybridRayTracingPass.GetKnownBuffers())
    whole = render(renderer, SIZE)
    buffers = {name: buffer(rt, name).copy() for name in rt.GetBuffers()}
    assert (buffers["triangle"] >= 0).any() and (buffers["triangle"] < 0).any()
    traced_rays = statistics(rt)["rays"]
    rays = dict.fromkeys(traced_rays, 0)
    for bounds in TILES:
        rt.SetPixelBounds(*bounds)
        picture = render(renderer, SIZE)
        assert same(cut(picture, bounds), cut(whole, bounds)), bounds
        outside = np.ones(whole.shape[:2], bool)
        cut(outside, bounds)[:] = False
        for name, values in buffers.items():
            assert same(cut(buffer(rt, name), bounds), cut(values, bounds)), (name, bounds)
            nothing = buffer(rt, name)[outside]
            assert (nothing == -1).all() if values.dtype.kind == "i" else np.isnan(nothing).all()
        for kind, count in statistics(rt)["rays"].items():
            rays[kind] += count["traced"]
    # No ray of another tile's pixels was traced. Buffers trace shadow rays of their own, not counted.
    assert rays == {kind: count["traced"] for kind, count in traced_rays.items()}
    rt.ResetPixelBounds()
    assert same(render(renderer, SIZE), whole)


@pytest.mark.parametrize(
    "visibility, shading, settings",
    [
        (0, "CPU", {"Multisampling": 3}),
        pytest.param(
            0, "GPU", {"Multisampling": 4},
            marks=pytest.mark.expects_vtk_messages("no effect on what the GPU shades"),
        ),
        (0, "CPU", {"Interleave": 5}),
        (0, "Exact", {"Interleave": 7, "InterleaveErrorControl": False, "Multisampling": 5}),
        (2, "CPU", {"Interleave": 3}),
        (2, "GPU", {"Interleave": 4, "InterleaveErrorControl": False}),
    ],
)
def test_what_looks_at_neighbours_finds_them(render, visibility, shading, settings):
    """Multisampling and interleaving: a margin around the tile is drawn and traced, but not shown."""
    renderer = everything()
    rt = traced(renderer, visibility, shading, ("triangle", "shadow"))
    for name, value in settings.items():
        getattr(rt, "Set" + name)(value)
    whole = render(renderer, SIZE)
    buffers = {name: buffer(rt, name).copy() for name in rt.GetBuffers()}
    for bounds in TILES:
        rt.SetPixelBounds(*bounds)
        picture = render(renderer, SIZE)
        assert same(cut(picture, bounds), cut(whole, bounds)), bounds
        outside = np.ones(whole.shape[:2], bool)
        cut(outside, bounds)[:] = False
        for name, values in buffers.items():
            assert same(cut(buffer(rt, name), bounds), cut(values, bounds)), (name, bounds)
        assert (buffer(rt, "triangle")[outside] == -1).all()
        assert np.isnan(buffer(rt, "shadow")[outside]).all()
    # The same bounds with another margin.
    rt.SetMultisampling(1)
    rt.SetInterleave(1)
    picture = render(renderer, SIZE)
    rt = traced(renderer, visibility, shading)
    assert same(cut(render(renderer, SIZE), bounds), cut(picture, bounds))


@pytest.mark.parametrize("shading", ["GPU", "CPU", "Exact"])
def test_windows_with_a_tile_each_make_the_frame(render, shading):
    """Each with its own context, scene and pass, all alive at once."""
    single = everything()
    rt = traced(single, shading=shading)
    whole = render(single, SIZE)
    ids = buffer(rt, "triangle").copy()
    tiles = [(0, 80, 0, 60), (80, 161, 0, 60), (0, 161, 60, 117)]
    workers = []
    for bounds in tiles:
        renderer = everything()
        rt = traced(renderer, shading=shading)
        rt.SetPixelBounds(bounds)
        workers.append((renderer, rt, bounds))
    picture = np.zeros_like(whole)
    assembled = np.full_like(ids, -2)
    for azimuth in (0, 10):  # a second frame: nothing of the first one's shows
        single.GetActiveCamera().Azimuth(azimuth)
        whole = render(single, SIZE)
        ids = buffer(single.GetPass(), "triangle").copy()
        for renderer, rt, bounds in workers:
            renderer.GetActiveCamera().Azimuth(azimuth)
            cut(picture, bounds)[:] = cut(render(renderer, SIZE), bounds)
            cut(assembled, bounds)[:] = cut(buffer(rt, "triangle"), bounds)
        assert same(picture, whole)
        assert same(assembled, ids)


@pytest.mark.parametrize("peeling", [False, True])
def test_outside_keeps_the_background(render, peeling):
    """VTK's own props, opaque and translucent, stay within the bounds too."""
    renderer = everything()
    renderer.SetBackground(*(value / 255 for value in BACKGROUND))
    renderer.SetUseDepthPeeling(peeling)
    rt = traced(renderer)
    whole = render(renderer, SIZE)
    for bounds in [(20, 100, 30, 80), (0, 161, 0, 60), (50, 51, 0, 117)]:
        rt.SetPixelBounds(*bounds)
        picture = render(renderer, SIZE)
        assert same(cut(picture, bounds), cut(whole, bounds))
        assert (cut(picture, bounds) != BACKGROUND).any(axis=2).mean() > 0.5
        cut(picture, bounds)[:] = BACKGROUND
        assert (picture == BACKGROUND).all()


def test_bounds_count_from_the_viewport(render):
    """A renderer that does not begin in the window's corner."""
    renderer = everything()
    renderer.SetViewport(0.25, 0.5, 1.0, 1.0)
    rt = traced(renderer)
    whole = render(renderer, (160, 120))
    rt.SetPixelBounds(20, 90, 10, 33)
    picture = render(renderer, (160, 120))
    bounds = (40 + 20, 40 + 90, 60 + 10, 60 + 33)
    assert same(cut(picture, bounds), cut(whole, bounds))
    assert buffer(rt, "triangle").shape == (60, 120)
    assert (cut(buffer(rt, "triangle"), (0, 20, 0, 60)) == -1).all()


def two_balls():
    """A mirror on the left and a plain body on the right, each a part."""
    mirror = scenes.actor_of(scenes.superquadric(16))
    mirror.SetPosition(-1.2, 0, 0)
    vtkHybridMaterial.SetReflectance(mirror, 0.5)
    plain = scenes.actor_of(scenes.superquadric(16))
    plain.SetPosition(1.2, 0, 0)
    renderer = scenes.renderer_of(mirror, plain, background=(0.2, 0.4, 0.6))
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=30.0))
    return scenes.look(renderer, (0, 0, 6))


def ran(rt):
    return {name for name, stage in statistics(rt)["stages"].items() if stage["ran"]}


def test_what_a_tile_costs(render):
    renderer = two_balls()
    rt = traced(renderer, buffers=())
    render(renderer, (160, 120))
    whole = statistics(rt)
    assert whole["bytes_read_back"] == 4 * 160 * 120
    rt.SetPixelBounds(0, 70, 0, 120)
    render(renderer, (160, 120))
    left = statistics(rt)
    # Neither geometry nor shadow maps nor the ray structure depend on the bounds.
    assert ran(rt) == {"visibility", "read_back", "primary_shading", "secondary_rays", "blit"}
    assert left["stages"]["visibility"]["reason"] == "the pixel bounds changed"
    assert left["triangles_drawn"] == whole["triangles"] // 2
    assert left["bytes_read_back"] == 4 * 70 * 120
    assert left["bytes_uploaded"] < whole["bytes_uploaded"]
    render(renderer, (160, 120))
    assert ran(rt) == {"blit"}
    rt.SetPixelBounds(90, 999, -5, 120)  # no mirror there: nothing is traced
    render(renderer, (160, 120))
    assert ran(rt) == {"visibility", "primary_shading", "blit"}
    assert statistics(rt)["triangles_drawn"] == whole["triangles"] // 2
    rt.SetPixelBounds(90, 160, 0, 500)  # the same after clamping
    render(renderer, (160, 120))
    assert ran(rt) == {"blit"}


@pytest.mark.parametrize(
    "bounds",
    [(160, 300, 0, 120), (0, 160, -9, 0), (50, 50, 0, 9), (50, 40, 0, 9), (0, -1, 0, -1), (0, 160, 0, 4)],
)
def test_bounds_without_anything_trace_nothing(render, bounds):
    renderer = two_balls()
    rt = traced(renderer)
    whole = render(renderer, (160, 120))
    ids = buffer(rt, "triangle").copy()
    rt.SetPixelBounds(*bounds)
    picture = render(renderer, (160, 120))
    assert (picture == BACKGROUND).all()
    assert (buffer(rt, "triangle") == -1).all()
    assert ran(rt) == set()
    rt.ResetPixelBounds()
    assert same(render(renderer, (160, 120)), whole)
    assert same(buffer(rt, "triangle"), ids)


def test_a_change_while_another_tile_was_drawn_is_not_lost(render):
    renderer = two_balls()
    rt = traced(renderer)
    render(renderer, (160, 120))
    rt.SetPixelBounds(0, 160, 0, 4)  # shows nothing
    render(renderer, (160, 120))
    renderer.GetActiveCamera().Azimuth(15)
    renderer.GetLights().GetItemAsObject(0).SetPosition(-2, 3, 2)
    render(renderer, (160, 120))
    rt.ResetPixelBounds()
    picture = render(renderer, (160, 120))
    traced(renderer)
    assert same(render(renderer, (160, 120)), picture)


def test_pipelined_tiles(render):
    """An animation shown one frame late, in tiles; new bounds are never shown the old ones' pixels."""
    whole, tile = two_balls(), two_balls()
    late = traced(whole, buffers=())
    part = traced(tile, buffers=())
    bounds = (10, 75, 20, 100)
    part.SetPixelBounds(bounds)
    pictures = {}
    for k in range(4):
        for renderer, rt in ((whole, late), (tile, part)):
            rt.PipelinedOn()
            renderer.GetActiveCamera().Azimuth(4)
            pictures[rt] = render(renderer, (160, 120))
            renderer.GetRenderWindow().SetDesiredUpdateRate(30)
            assert statistics(rt)["pipelined"]["ran"] == (k > 0)
        assert same(cut(pictures[part], bounds), cut(pictures[late], bounds))
    bounds = (40, 160, 0, 70)
    part.SetPixelBounds(bounds)
    picture = render(tile, (160, 120))
    assert statistics(part)["pipelined"]["reason"] == "the frame before shows other pixels"
    finished = render(whole, (160, 120))  # the same view again
    assert same(cut(picture, bounds), cut(finished, bounds))
    cut(picture, bounds)[:] = BACKGROUND
    assert (picture == BACKGROUND).all()


def test_bounds_are_a_setting():
    rt = vtkHybridRayTracingPass()
    everything_ = rt.GetPixelBounds()
    assert everything_ == (0, 2**31 - 1, 0, 2**31 - 1)
    before = rt.GetMTime()
    rt.SetPixelBounds(everything_)
    assert rt.GetMTime() == before
    rt.SetPixelBounds(1, 2, 3, 4)
    assert rt.GetPixelBounds() == (1, 2, 3, 4) and rt.GetMTime() > before
    assert "PixelBounds: 1 2 3 4" in str(rt)
    rt.ResetPixelBounds()
    assert rt.GetPixelBounds() == everything_


# -- the tiles that vtkRenderWindow knows of ----------------------------------------------------------


def grabbed(renderer, size, scale):
    """The picture of a window `scale` times that size, drawn by VTK in scale x scale tiles."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetScale(scale, scale)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1).copy()
    window.RemoveRenderer(renderer)
    window.Finalize()
    return pixels


def test_vtks_own_tiles_make_the_frame():
    """vtkWindowToImageFilter narrows the view angle for each tile, so that rays and vertices round in
    another way: the pictures agree but for pixels on an edge, here a thousandth at most."""
    pictures = []
    for size, scale in (((320, 240), 1), ((160, 120), 2)):
        renderer = everything()
        traced(renderer, buffers=())
        pictures.append(grabbed(renderer, size, scale).astype(int))
    assert pictures[0].std() > 10
    different = np.abs(pictures[0] - pictures[1]).max(axis=2) > 1
    print(f"vtkWindowToImageFilter's tiles: {different.sum()} of {different.size} pixels differ")
    assert different.mean() <= 1e-3


def test_bounds_count_from_the_tile_viewport(render):
    """SetTileScale and SetTileViewport say which part of a wall of windows this one is."""

    def pixels(bounds=None):
        renderer = everything()
        renderer.SetViewport(0.2, 0.3, 0.9, 0.8)
        rt = traced(renderer)
        if bounds:
            rt.SetPixelBounds(*bounds)
        window = vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(160, 120)
        window.SetTileScale(2, 2)
        window.SetTileViewport(0.0, 0.5, 0.5, 1.0)
        window.AddRenderer(renderer)
        window.Render()
        colors = vtkUnsignedCharArray()
        window.GetPixelData(0, 0, 159, 119, 0, colors, 0)
        result = vtk_to_numpy(colors).reshape(120, 160, 3).copy(), buffer(rt, "triangle").copy()
        window.Finalize()
        return result

    whole, ids = pixels()
    # Of 320 x 240 pixels the renderer has columns 64 to 288 and rows 72 to 192, of those this window
    # shows 64 to 160 and 120 to 192.
    assert ids.shape == (72, 96)
    picture, tile_ids = pixels((10, 70, 5, 60))
    bounds = (64 + 10, 64 + 70, 5, 60)
    assert (cut(picture, bounds) == cut(whole, bounds)).all()
    assert same(cut(tile_ids, (10, 70, 5, 60)), cut(ids, (10, 70, 5, 60)))
    assert (tile_ids >= 0).sum() == (cut(ids, (10, 70, 5, 60)) >= 0).sum() > 1000
