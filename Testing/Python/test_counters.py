"""The frame plan as scripts see it: by the counters, nothing runs that a frame does not need."""

import scenes
from vtkhybrid import statistics, vtkHybridMaterial, vtkHybridRayTracingPass

SECONDARY = ("read_back", "structure", "secondary_rays")


def small_scene(mirror=False):
    floor = scenes.actor_of(scenes.plane(2.0, -0.6))
    if mirror:
        vtkHybridMaterial.SetReflectance(floor, 0.5)
    ball = scenes.actor_of(scenes.torus())
    renderer = scenes.renderer_of(floor, ball)
    lights = [
        scenes.scene_light((1, 3, 2), positional=True, ConeAngle=30.0),
        scenes.scene_light((-1, 3, 1)),
    ]
    for light in lights:
        renderer.AddLight(light)
    scenes.look(renderer, (0, 2, 5))
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    return renderer, rt, floor, ball, lights


def ran(rt):
    return {name for name, stage in statistics(rt)["stages"].items() if stage["ran"]}


def test_still_scene_runs_only_the_blit(render):
    renderer, rt, *_ = small_scene(mirror=True)
    render(renderer)
    assert {"visibility", "primary_shading", "secondary_rays", "blit"} <= ran(rt)
    for _ in range(3):
        render(renderer)
        assert ran(rt) == {"blit"}
        counters = statistics(rt)
        assert counters["triangles_drawn"] == 0
        assert counters["bytes_read_back"] == 0
        assert counters["bytes_uploaded"] == 0
        assert all(rays["asked"] == 0 for rays in counters["rays"].values())


def test_still_frame_is_the_same_picture(render):
    renderer, *_ = small_scene(mirror=True)
    first = render(renderer)
    assert (render(renderer) == first).all()


def test_scene_without_mirror_or_glass_traces_nothing(render):
    renderer, rt, *_ = small_scene()
    for _ in range(2):
        render(renderer)
        counters = statistics(rt)
        for stage in SECONDARY:
            assert not counters["stages"][stage]["ran"]
            assert counters["stages"][stage]["reason"] == "no mirror or glass is in view"
        assert counters["bytes_read_back"] == 0
        assert counters["structure"]["built"] == 0
        assert all(rays["asked"] == 0 for rays in counters["rays"].values())
        renderer.GetActiveCamera().Azimuth(5)


def test_mirror_out_of_view_traces_nothing(render):
    renderer, rt, _, ball, _ = small_scene(mirror=True)
    scenes.look(renderer, (0, 30, 40), (0, 60, 40.0))
    render(renderer)
    assert not statistics(rt)["stages"]["secondary_rays"]["ran"]
    assert statistics(rt)["structure"]["built"] == 0


def test_moved_light_redraws_its_map_only(render):
    renderer, rt, _, _, lights = small_scene()
    render(renderer)
    assert [m["ran"] for m in statistics(rt)["shadow_maps"]] == [True, True]
    lights[1].SetPosition(-2, 3, 1)
    render(renderer)
    counters = statistics(rt)
    assert [m["ran"] for m in counters["shadow_maps"]] == [False, True]
    assert ran(rt) == {"shadow_maps", "primary_shading", "blit"}
    triangles = counters["triangles"]
    assert counters["triangles_drawn"] == triangles  # once, for the one map


def test_light_colour_redraws_no_map(render):
    renderer, rt, _, _, lights = small_scene()
    render(renderer)
    lights[0].SetIntensity(0.3)
    render(renderer)
    assert ran(rt) == {"primary_shading", "blit"}


def test_moved_camera_keeps_geometry_and_maps(render):
    renderer, rt, *_ = small_scene()
    render(renderer)
    renderer.GetActiveCamera().Azimuth(10)
    render(renderer)
    assert ran(rt) == {"visibility", "primary_shading", "blit"}


def test_moved_actor_builds_nothing_anew(render):
    renderer, rt, _, ball, _ = small_scene(mirror=True)
    render(renderer)
    assert statistics(rt)["structure"]["built"] == 1  # what rests is one
    built = 0
    for step in range(1, 5):
        ball.SetPosition(0.1 * step, 0, 0)
        render(renderer)
        counters = statistics(rt)
        built += counters["structure"]["built"]
    # The ball leaves the rest, once; the floor, then alone, gets a hierarchy of its own, once.
    assert built <= 3
    assert not counters["stages"]["geometry_upload"]["ran"]
    assert counters["structure"]["built"] == 0
    assert counters["structure"]["reused"] == 2


def test_colour_of_a_property_draws_no_triangle(render):
    renderer, rt, _, ball, _ = small_scene()
    render(renderer)
    ball.GetProperty().SetColor(0.1, 0.9, 0.2)
    picture = render(renderer)
    assert statistics(rt)["triangles_drawn"] == 0
    fresh = vtkHybridRayTracingPass()
    renderer.SetPass(fresh)
    assert (render(renderer) == picture).all()


def test_changes_while_a_stage_was_off_are_not_lost(render):
    """A light that moves while shadows are off must not find its old map when they come back."""
    renderer, rt, _, ball, lights = small_scene(mirror=True)
    render(renderer)
    rt.SetShadowModeToOff()
    rt.ReflectionsOff()
    lights[0].SetPosition(2, 2, 2)
    ball.SetPosition(0, 0.3, 0)
    render(renderer)
    rt.SetShadowModeToShadowMaps()
    rt.ReflectionsOn()
    picture = render(renderer)
    renderer.SetPass(vtkHybridRayTracingPass())
    assert (render(renderer) == picture).all()


def test_nothing_in_view_shows_the_background(render):
    renderer, rt, *_ = small_scene()
    render(renderer)
    scenes.look(renderer, (0, 30, 40), (0, 60, 40.0))
    picture = render(renderer)
    assert (picture == picture[0, 0]).all()
    assert ran(rt) == set()
