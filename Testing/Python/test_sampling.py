"""Multisampling and interleaved rendering through the pass: what they do to real pictures, what they
count, and which stages a change of them runs again."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass

SIZE = (400, 300)
MODES = {
    "traditional": ("RayCasting", "CPU"),
    "item buffer, CPU": ("ItemBuffer", "CPU"),
    "hybrid": ("ItemBuffer", "GPU"),
}


def over_mirror(model):
    """The model over a mirror floor under one spot light."""
    floor = scenes.actor_of(scenes.plane(1.6, -0.45), Color=(0.6, 0.6, 0.65))
    vtkHybridMaterial.SetReflectance(floor, 0.4)
    thing = scenes.actor_of(model, Color=(0.9, 0.7, 0.5), Specular=0.3, SpecularPower=20.0)
    thing.SetOrigin(*thing.GetCenter())
    bounds = thing.GetBounds()
    thing.SetScale(1.0 / max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]))
    thing.AddPosition(*(-c for c in thing.GetCenter()))
    renderer = scenes.renderer_of(floor, thing)
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=30.0))
    return scenes.look(renderer, (0.3, 0.7, 2.2), (0, -0.05, 0))


@pytest.fixture(params=["torus", "bunny"])
def renderer(request, data_file):
    model = scenes.torus() if request.param == "torus" else scenes.bunny(data_file("bunny/bunny.ply"))
    return over_mirror(model)


def pass_of(renderer, visibility, shading):
    rt = vtkHybridRayTracingPass()
    getattr(rt, "SetVisibilityTo" + visibility)()
    getattr(rt, "SetPrimaryShadingTo" + shading)()
    renderer.SetPass(rt)
    return rt


def difference(a, b):
    return float(np.sqrt(np.mean((a.astype(float) - b.astype(float)) ** 2)))


@pytest.mark.parametrize("mode", MODES)
def test_error_control_leaves_a_fifth_of_the_error(mode, renderer, render):
    rt = pass_of(renderer, *MODES[mode])
    every = render(renderer, SIZE)
    counts = statistics(rt)["interleave"]
    assert counts["interpolated"] == 0
    shown = counts["traced"]
    for n in (2, 3, 4):
        rt.SetInterleave(n)
        rt.InterleaveErrorControlOff()
        plain = difference(render(renderer, SIZE), every)
        counts = statistics(rt)["interleave"]
        # About one pixel in n^2 is a sample; those that no sample reaches are few.
        assert counts["traced"] < 1.2 * shown / n**2
        rt.InterleaveErrorControlOn()
        controlled = difference(render(renderer, SIZE), every)
        counts = statistics(rt)["interleave"]
        print(f"{mode}, n = {n}: plain {plain:.3f}, controlled {controlled:.3f} of 255,"
              f" {counts['traced']} of {shown} pixels traced")
        assert counts["interpolated"] > 0.1 * shown
        assert 0 < controlled < plain / 5


def test_primary_rays_are_thinned(renderer, render):
    rt = pass_of(renderer, "RayCasting", "GPU")
    rt.SetBuffers(["triangle", "depth"])
    render(renderer, SIZE)
    triangles, depths = buffer(rt, "triangle"), buffer(rt, "depth")
    rt.SetInterleave(2)
    render(renderer, SIZE)
    primary = statistics(rt)["rays"]["primary"]
    assert primary["traced"] < 0.75 * SIZE[0] * SIZE[1]
    assert primary["asked"] == primary["answered"] + primary["traced"] == SIZE[0] * SIZE[1]
    same = buffer(rt, "triangle") == triangles
    print(f"{np.count_nonzero(~same)} of {same.size} pixels show another triangle")
    # What is narrower than two pixels and lies between samples that all show one triangle is missed.
    assert np.mean(~same) <= 0.002
    np.testing.assert_array_equal(buffer(rt, "depth")[same], depths[same])


def test_multisampling_closes_the_holes(data_file, render):
    """The bunny's triangles are a few pixels large: along their edges the rasteriser's choice and the
    ray's differ here and there (the paper's figure 3)."""
    renderer = over_mirror(scenes.bunny(data_file("bunny/bunny.ply")))
    rt = pass_of(renderer, "ItemBuffer", "CPU")
    clamped = render(renderer, (800, 600))
    assert statistics(rt)["multisampling"] == dict(
        failed=0, repaired=0, interpolated=0, unresolved=0)
    rt.SetMultisamplingToOff()
    holes = render(renderer, (800, 600))
    off = statistics(rt)["multisampling"]
    print("off:", off)
    assert off["failed"] == off["unresolved"] > 20
    changed = (holes.astype(int) != clamped).any(axis=2)
    assert changed.sum() <= off["unresolved"]
    assert changed.sum() > 0.9 * off["unresolved"]
    background = np.round(255 * np.array([0.2, 0.3, 0.4]))
    assert np.abs(holes[changed] - background).max() <= 1
    for name in ("Lazy3x3", "Lazy5x5", "Full3x3", "Full5x5"):
        getattr(rt, "SetMultisamplingTo" + name)()
        repaired = render(renderer, (800, 600))
        counts = statistics(rt)["multisampling"]
        print(name + ":", counts)
        assert counts["failed"] == off["failed"]
        assert counts["unresolved"] == 0
        assert counts["repaired"] > 0.5 * counts["failed"]
        # The neighbours' triangles belong to the same smooth surface; Full may also find a nearer one.
        assert difference(repaired, clamped) < difference(holes, clamped) / 5


def ran(rt):
    return {name for name, stage in statistics(rt)["stages"].items() if stage["ran"]}


def test_a_change_runs_what_it_outdates(render):
    renderer = over_mirror(scenes.torus())
    rt = pass_of(renderer, "ItemBuffer", "GPU")
    render(renderer)
    rt.SetInterleave(2)
    render(renderer)
    assert ran(rt) == {"secondary_rays", "blit"}
    rt.SetPrimaryShadingToCPU()
    render(renderer)
    for change in (rt.SetMultisamplingToLazy3x3, rt.InterleaveErrorControlOff):
        change()
        render(renderer)
        assert ran(rt) == {"primary_shading", "blit"}
    rt.SetVisibilityToRayCasting()
    render(renderer)
    rt.SetMultisamplingToFull3x3()  # needs none
    render(renderer)
    assert ran(rt) == {"blit"}
    rt.SetInterleave(3)
    render(renderer)
    assert {"visibility", "primary_shading"} <= ran(rt)


@pytest.mark.expects_vtk_messages("SetMultisampling: 6 is none of", "SetMultisampling: -1 is none of")
def test_ranges():
    rt = vtkHybridRayTracingPass()
    assert rt.GetMultisampling() == rt.Clamp == 1
    assert rt.GetInterleave() == 1
    assert rt.GetInterleaveErrorControl()
    rt.SetMultisampling(6)
    rt.SetMultisampling(-1)
    assert rt.GetMultisampling() == rt.Clamp
    rt.SetMultisamplingToFull5x5()
    assert rt.GetMultisampling() == rt.Full5x5 == 5
    before = rt.GetMTime()
    rt.SetInterleave(0)
    assert rt.GetMTime() == before
    rt.SetInterleave(99)
    assert rt.GetInterleave() == 16
    assert rt.GetMTime() > before
    assert "Multisampling: Full5x5" in str(rt)
    assert "Interleave: 16" in str(rt)


@pytest.mark.expects_vtk_messages("Multisampling has no effect on what the GPU shades")
def test_the_gpu_clamps_and_says_so_once(render, vtk_messages):
    renderer = over_mirror(scenes.torus())
    rt = pass_of(renderer, "ItemBuffer", "GPU")
    rt.SetMultisamplingToLazy3x3()
    render(renderer)
    render(renderer)
    assert len(vtk_messages) == 1
    rt.SetMultisamplingToFull3x3()
    render(renderer)
    assert len(vtk_messages) == 2
    rt.SetVisibilityToDirectRendering()  # where none is needed
    rt.SetMultisamplingToLazy3x3()
    render(renderer)
    assert len(vtk_messages) == 2
