"""The traditional ray tracer (every ray on the CPU) and its mixtures with the rasteriser: the same
pictures as VTK with effects off, exact shadows, and the hybrid's picture but for the rasteriser's
own errors."""

import numpy as np
import pytest
import scenes
import test_mirror_and_glass as optics
import test_parity as parity
import test_shadows as shadows
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass

MIXTURES = {
    "traditional": ("RayCasting", "CPU", "ShadowMaps"),
    "rays, shaded on the GPU": ("RayCasting", "GPU", "ShadowMaps"),
    "CPU ray caster": ("ItemBuffer", "CPU", "ShadowMaps"),
    "rasterised, shadow rays": ("ItemBuffer", "CPU", "Exact"),
}


def choose(rt, mixture):
    visibility, shading, shadow_mode = MIXTURES[mixture]
    getattr(rt, "SetVisibilityTo" + visibility)()
    getattr(rt, "SetPrimaryShadingTo" + shading)()
    getattr(rt, "SetShadowModeTo" + shadow_mode)()


@pytest.mark.parametrize("scene", scenes.PARITY, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("mixture", MIXTURES)
def test_same_picture_as_vtk(scene, mixture, render):
    visibility, shading, _ = MIXTURES[mixture]
    figures = parity.compare(scene(), render, visibility, shading=shading)
    parity.check(f"{scene.__name__} {mixture}", figures)


@pytest.mark.parametrize("kind", shadows.LIGHTS)
def test_shadow_rays_are_exact(kind, render):
    """Shadow rays have no texels: only double rounding separates them from the analytic border."""
    renderer, rt = shadows.scene(kind)
    choose(rt, "traditional")
    render(renderer, (600, 300))
    on_floor = buffer(rt, "prop") == 0
    visible = buffer(rt, "shadow")[on_floor]
    position = buffer(rt, "position")[on_floor]
    outside, beyond = shadows.analytic(kind, position), shadows.beyond_cone(kind, position)
    # Corners are floats of size up to 3; the light's path and the analytic one round in double.
    certain = (np.abs(outside) > 1e-6) & (np.abs(beyond) > shadows.COSINE_ROUNDING)
    assert certain.mean() > 0.999
    assert ((visible == 1.0) == ((outside > 0) & (beyond < 0)))[certain].all()
    assert set(np.unique(visible)) == {0.0, 1.0}
    assert not statistics(rt)["stages"]["shadow_maps"]["ran"]


def lively():
    floor = scenes.actor_of(scenes.plane(2.0, -0.6), Color=(0.7, 0.7, 0.8), Ambient=0.1)
    vtkHybridMaterial.SetReflectance(floor, 0.4)
    glass = scenes.actor_of(scenes.superquadric(), Specular=0.4, SpecularPower=30.0)
    glass.SetPosition(0.9, 0, 0.9)
    glass.SetScale(0.6)
    vtkHybridMaterial.SetGlass(glass, 1.5)
    torus = scenes.actor_of(scenes.torus(), Color=(0.9, 0.6, 0.3), Specular=0.3)
    renderer = scenes.renderer_of(floor, torus, glass)
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=40.0))
    renderer.AddLight(scenes.scene_light((-2, 3, 1), Intensity=0.4))
    return scenes.look(renderer, (0, 2, 5))


def test_hybrid_shows_the_traditional_picture(render):
    """With the same exact shadows the two differ only where the rasteriser gives a pixel to another
    triangle: at most 0.2 % of the pixels."""
    renderer = lively()
    pictures = {}
    for mixture in ("traditional", "rasterised, shadow rays"):
        rt = vtkHybridRayTracingPass()
        choose(rt, mixture)
        renderer.SetPass(rt)
        pictures[mixture] = render(renderer, (400, 300)).astype(int)
    one, other = pictures.values()
    wrong = np.count_nonzero(np.abs(one - other).max(axis=2) > 1) / one[..., 0].size
    print(f"hybrid against traditional: {100 * wrong:.4f} % of the pixels differ")
    assert wrong <= 0.002


@pytest.mark.parametrize("kind", shadows.LIGHTS)
def test_both_ray_casters_look_up_the_same_maps(kind, render):
    """The CPU's look-up is the GPU's, in the same precision. The points looked up are not: on the CPU
    they are rounded from double, so that a comparison with a texel's depth may turn out otherwise
    where the two are within rounding - or, on the CPU, the texel next door is looked up."""
    renderer, rt = shadows.scene(kind)
    on_gpu = render(renderer, (600, 300)).astype(int)
    rt.SetPrimaryShadingToCPU()
    on_cpu = render(renderer, (600, 300)).astype(int)
    counters = statistics(rt)
    assert counters["rays"]["shadow"]["asked"] == 0
    assert counters["stages"]["shadow_read_back"]["ran"]
    assert not counters["stages"]["shadow_maps"]["ran"], "the maps that the GPU holds are read back"
    wrong = np.abs(on_gpu - on_cpu).max(axis=2) > 1
    print(f"CPU against GPU ray caster, {kind}: {wrong.sum()} of {wrong.size} pixels differ")
    # Rounding: 2^-24 of a coordinate against a texel's size of 2^-11 of the map, along outlines that
    # take at most some percent of the pixels.
    assert wrong.mean() <= 1e-4
    visible = buffer(rt, "shadow")
    rt.SetPrimaryShadingToGPU()
    render(renderer, (600, 300))
    hit = ~np.isnan(visible[..., 0])
    differs = np.abs(visible - buffer(rt, "shadow"))[hit] > 1e-3
    assert hit.mean() > 0.1 and differs.mean() <= 1e-3


def test_moved_light_alone_is_read_back(render):
    renderer, rt = shadows.scene("spot")
    rt.SetPrimaryShadingToCPU()
    rt.SetShadowMapResolution(256)
    render(renderer)
    assert statistics(rt)["bytes_read_back"] == 4 * (256 * 256 + 300 * 300)
    renderer.GetActiveCamera().Azimuth(3.0)
    render(renderer)
    assert statistics(rt)["bytes_read_back"] == 4 * 300 * 300
    list(renderer.GetLights())[0].SetPosition(0.4, 3.0, 1.0)
    render(renderer)
    assert statistics(rt)["bytes_read_back"] == 4 * 256 * 256


def test_every_ray_is_counted(render):
    renderer = lively()
    rt = vtkHybridRayTracingPass()
    choose(rt, "traditional")
    renderer.SetPass(rt)
    render(renderer, (200, 150))
    counters = statistics(rt)
    assert counters["rays"]["primary"]["asked"] == 200 * 150
    for rays in counters["rays"].values():
        assert rays["asked"] == rays["answered"] + rays["traced"]
        assert rays["traced"] > 100
    assert counters["bytes_read_back"] == 0 and counters["triangles_drawn"] == 0
    ran = {name for name, stage in counters["stages"].items() if stage["ran"]}
    assert ran == {"structure", "visibility", "primary_shading", "blit"}
    render(renderer, (200, 150))
    ran = {name for name, stage in statistics(rt)["stages"].items() if stage["ran"]}
    assert ran == {"blit"}


def test_glass_sphere_by_the_traditional_tracer(render, monkeypatch):
    """The optics of test_mirror_and_glass hold without any rasteriser."""

    class Traditional(vtkHybridRayTracingPass):
        def __init__(self):
            choose(self, "traditional")

    monkeypatch.setattr(optics, "vtkHybridRayTracingPass", Traditional)
    optics.test_glass_sphere(render)


def test_translucent_casters_tint(render):
    """Through a veil of opacity a and colour C passes (1 - a) (1 - a + a C) of the light."""
    veil = scenes.actor_of(scenes.plane(0.5, 1.0), Opacity=0.5, Color=(1.0, 0.5, 0.0))
    floor = scenes.actor_of(scenes.plane(3.0), Color=(1, 1, 1))
    renderer = scenes.renderer_of(floor, veil)
    renderer.AddLight(scenes.scene_light((0, 3, 0)))
    scenes.look(renderer, (0.0, 1.5, 6.0), (0, 0.2, 0))
    rt = vtkHybridRayTracingPass()
    choose(rt, "traditional")
    rt.SetBuffers(["position", "prop"])
    renderer.SetPass(rt)
    shown = render(renderer).astype(int)
    position = buffer(rt, "position")
    below = (buffer(rt, "prop") == 0) & (np.abs(position[..., 0]) < 0.45) & (
        np.abs(position[..., 2]) < 0.45)
    # Seen past the veil, not through it: the veil's outline lies above these pixels.
    assert below.sum() > 100
    expected = 255 * 0.5 * (0.5 + 0.5 * np.array([1.0, 0.5, 0.0]))
    share = np.mean(np.abs(shown[below] - expected).max(axis=1) <= 1)
    assert share > 0.9


def test_near_plane_cuts_as_the_rasteriser_does(render):
    renderer = lively()
    for prop in renderer.GetActors():
        vtkHybridMaterial.Clear(prop)
    renderer.GetActiveCamera().SetClippingRange(4.6, 7.0)
    pictures = []
    for mixture in ("traditional", "rasterised, shadow rays"):
        rt = vtkHybridRayTracingPass()
        choose(rt, mixture)
        renderer.SetPass(rt)
        rt.SetBuffers(["triangle"])
        render(renderer)
        pictures.append(buffer(rt, "triangle").copy())
    assert (pictures[0] >= 0).sum() > 1000
    # The cut through the meshes is one more outline.
    assert np.count_nonzero(pictures[0] != pictures[1]) / pictures[0].size < 0.004


def test_accelerators_show_the_same_picture_to_the_last_bit(render):
    renderer = lively()
    pictures = []
    for accelerator in ("Embree", "KdTree"):
        rt = vtkHybridRayTracingPass()
        choose(rt, "traditional")
        getattr(rt, "SetAcceleratorTo" + accelerator)()
        renderer.SetPass(rt)
        pictures.append(render(renderer, (300, 200)))
        assert statistics(rt)["stages"]["structure"]["ran"]
    assert (pictures[0] == pictures[1]).all()
