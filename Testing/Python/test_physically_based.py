"""Physically based actors under direct light are traced: VTK's own equations, shadows received."""

import numpy as np
import pytest
import scenes
from test_parity import check, compare
from test_textures import MODES, tiles, texture_of
from vtkhybrid import statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkFiltersSources import vtkTexturedSphereSource

PBR = 3  # the interpolation


def ball(x, **properties):
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(40)
    source.SetPhiResolution(30)
    source.SetRadius(0.5)
    properties = {"Color": (0.9, 0.5, 0.3), "Interpolation": PBR, **properties}
    actor = scenes.actor_of(source, **properties)
    actor.SetPosition(x, 0, 0)
    return actor


def row(*lights):
    """Rough and smooth, metal and not, coated; one by Phong's equations among them."""
    renderer = scenes.renderer_of(
        ball(-2.2, Roughness=0.9),
        ball(-1.1, Roughness=0.25, Metallic=0.2),
        ball(0.0, Roughness=0.4, Metallic=1.0, EdgeTint=(0.8, 1.0, 0.6)),
        ball(1.1, Roughness=0.6, CoatStrength=0.8, CoatRoughness=0.2, CoatColor=(1.0, 0.8, 0.9), CoatIOR=1.8),
        ball(2.2, Interpolation=1, Specular=0.4),
    )
    for light in lights:
        renderer.AddLight(light)
    return scenes.look(renderer, (0.4, 1.0, 6))


def headlight():
    return row()


def suns():
    lights = [scenes.scene_light(position) for position in ((3, 2, 3), (-2, 1, 2))]
    lights[0].SetIntensity(0.7)
    lights[1].SetColor(0.4, 0.6, 1.0)
    return row(*lights)


def lamps():
    lights = [scenes.scene_light(position) for position in ((3, 2, 3), (-2, 1, 2))]
    for light in lights:
        light.SetPositional(True)
        light.SetConeAngle(90.0)
    lights[0].SetIntensity(3.0)
    lights[0].SetAttenuationValues(0.5, 0.1, 0.05)
    lights[1].SetConeAngle(35.0)
    lights[1].SetExponent(2.0)
    return row(*lights)


def edged():
    """VTK takes an edge's colour for ambient light, which its physically based shading has none of."""
    renderer = suns()
    for actor in renderer.GetActors():
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.1, 0.2, 0.6)
    return scenes.look(renderer, (0.3, 0.5, 2.2))


def ignoring_a_texture():
    """VTK's physically based shading shows no textures but those of its own names."""
    source = vtkTexturedSphereSource()
    source.SetThetaResolution(40)
    source.SetPhiResolution(30)
    actor = scenes.actor_of(source, Color=(0.4, 0.8, 0.5), Interpolation=PBR, Roughness=0.4)
    actor.SetTexture(texture_of(tiles()))
    renderer = scenes.renderer_of(actor)
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    return scenes.look(renderer, (0.4, 0.5, 2))


def not_lit():
    renderer = suns()
    for actor in renderer.GetActors():
        actor.GetProperty().LightingOff()
    return renderer


def without_lights():
    renderer = suns()
    for light in list(renderer.GetLights()):
        light.SwitchOff()
    renderer.AutomaticLightCreationOff()
    return renderer


SCENES = [headlight, suns, lamps, edged, ignoring_a_texture, not_lit, without_lights]


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
def test_same_picture_as_vtk(scene, render):
    pictures = []
    for visibility, shading in MODES:
        renderer = scene()
        figures = compare(renderer, render, visibility, shading=shading)
        check(f"physically based {scene.__name__} {visibility} {shading}", figures)
        pictures.append(render(renderer, (400, 300)).astype(int))
    for other in pictures[1:]:
        different = (np.abs(other - pictures[0]).max(axis=2) > 1).mean()
        assert different <= (1e-4 if scene is edged else 0.0), "as in test_edges.py"


def over_floor(**properties):
    """A block above a floor whose material is physically based, under a sun and a dim one."""
    floor = scenes.actor_of(
        scenes.plane(2.0, -0.6), Color=(0.7, 0.7, 0.7), Interpolation=PBR, Roughness=0.8, **properties
    )
    block = scenes.actor_of(scenes.vtkCubeSource(), Color=(0.9, 0.4, 0.2))
    block.SetScale(0.7)
    renderer = scenes.renderer_of(floor, block)
    renderer.AddLight(scenes.scene_light((2, 3, 0.5)))
    dim = scenes.scene_light((-2, 3, 1))
    dim.SetIntensity(0.2)
    renderer.AddLight(dim)
    scenes.look(renderer, (0.5, 2.5, 4))
    return renderer, floor, block


def shown(renderer, render, **settings):
    rt = vtkHybridRayTracingPass()
    for name, value in settings.items():
        getattr(rt, "Set" + name)(value)
    renderer.SetPass(rt)
    return render(renderer).astype(int), rt


def test_shadows_are_received(render):
    """The shadow of the one light leaves what the other gives, as if the first were switched off."""
    renderer, _, _ = over_floor()
    dark, rt = shown(renderer, render)
    assert not statistics(rt)["left_to_vtk"]
    assert statistics(rt)["surfaces"]["physically_based"] == 1
    rt.SetPrimaryShadingToCPU()
    other = render(renderer).astype(int)
    assert np.count_nonzero(np.abs(other - dark).max(axis=2) > 1) < 1e-3 * dark[..., 0].size
    rt.SetShadowModeToOff()
    bright = render(renderer).astype(int)
    shadowed = (bright - dark).max(axis=2) > 20
    assert shadowed.mean() > 0.02
    lights = list(renderer.GetLights())
    alone = []
    for off in lights:
        for light in lights:
            light.SetSwitch(light is not off)
        alone.append(render(renderer).astype(int))
    nothing = np.zeros_like(dark)
    nearest = np.min([np.abs(dark - one).max(axis=2) for one in (*alone, nothing)], axis=0)
    assert (nearest[shadowed] <= 1).mean() > 0.98, "the rest is the outline of the shadow"


def test_in_a_mirror_it_looks_as_the_mirrored_scene(render):
    """A ball and its shadow's caster above a mirror, against those below it, the lights mirrored."""
    pictures = []
    for side in (1, -1):
        target = ball(0.0, Roughness=0.4, Metallic=0.3, CoatStrength=0.3)
        target.SetPosition(0, side, 0)
        caster = scenes.actor_of(scenes.vtkCubeSource(), Color=(0.2, 0.6, 0.3))
        caster.SetScale(0.3)
        caster.SetPosition(0.6, side * 1.4, 0.5)
        renderer = scenes.renderer_of(target, caster, background=(0, 0, 0))
        if side == 1:
            mirror = scenes.actor_of(scenes.plane(6.0), Diffuse=0.0, Ambient=0.0)
            vtkHybridMaterial.SetReflectance(mirror, 1.0)
            renderer.AddViewProp(mirror)
        for x, z, color in ((2, 2, (1, 1, 1)), (-2, 3, (0.3, 0.5, 0.9))):
            renderer.AddLight(scenes.scene_light((x, side * 2.0, z), Color=color))
        scenes.look(renderer, (0, 0.9, 5), (0, -0.8, 0))
        picture, rt = shown(renderer, render)
        assert statistics(rt)["surfaces"]["physically_based"] == 1
        pictures.append(picture)
    half = pictures[0].shape[0] // 2
    image, direct = (picture[:half] if picture[:half].any() else picture for picture in pictures)
    seen = direct.any(axis=2) & image.any(axis=2)
    assert seen.mean() > 0.05
    different = np.abs(image - direct).max(axis=2)[seen] > 1
    print(f"{100 * different.mean():.3f} % of {seen.sum()} pixels differ")
    assert different.mean() < 0.01, "the outlines of caster, ball and shadow"


def test_terms_are_the_materials(render):
    """Another roughness is a change of the material alone."""
    renderer, floor, _ = over_floor()
    first, rt = shown(renderer, render)
    floor.GetProperty().SetRoughness(0.3)
    second = render(renderer).astype(int)
    assert (second != first).any()
    assert not statistics(rt)["stages"]["geometry_upload"]["ran"]
    assert statistics(rt)["stages"]["primary_shading"]["reason"] == "a material changed"


@pytest.mark.parametrize("what", ["anisotropy", "texture"])
def test_what_is_not_done_is_left_to_vtk(what, render):
    renderer, floor, _ = over_floor()
    if what == "anisotropy":
        floor.GetProperty().SetAnisotropy(0.5)
    else:
        texture = texture_of(tiles())
        texture.UseSRGBColorSpaceOn()
        floor.GetProperty().SetBaseColorTexture(texture)
    _, rt = shown(renderer, render)
    assert "physically based with textures or anisotropy" in str(statistics(rt)["left_to_vtk"])
