"""Where shadows fall: the pass' "shadow" buffer against the analytic shadow of a square, for every
light kind, in square and non-square windows; and no false shadow on surfaces that shade themselves."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, statistics, vtkHybridRayTracingPass
from vtkmodules.vtkFiltersSources import vtkSphereSource

HALF = 0.5  # the caster: a square of half this side at this height, parallel to the floor
HEIGHT = 1.0
FLOOR = 3.0
RESOLUTION = 1024

LIGHTS = {
    "directional": dict(position=(1.0, 3.0, 0.5), positional=False),
    "spot": dict(position=(1.0, 3.0, 0.5), positional=True, ConeAngle=35.0),
    "wide spot": dict(position=(1.0, 3.0, 0.5), positional=True, ConeAngle=75.0),
    "point": dict(position=(1.0, 3.0, 0.5), positional=True, ConeAngle=180.0),
}


def scene(kind):
    caster = scenes.actor_of(scenes.plane(HALF, HEIGHT))
    floor = scenes.actor_of(scenes.plane(FLOOR, 0.0))
    renderer = scenes.renderer_of(floor, caster)
    renderer.AddLight(scenes.scene_light(focal_point=(0, 0, 0), **LIGHTS[kind]))
    scenes.look(renderer, (1.0, 5.0, 4.0))
    rt = vtkHybridRayTracingPass()
    rt.SetShadowMapResolution(RESOLUTION)
    rt.SetBuffers(["shadow", "position", "prop"])
    renderer.SetPass(rt)
    return renderer, rt


def analytic(kind, position):
    """How far inside (negative) or outside of the square's shadow each floor point lies, measured in
    the square's plane, and the part of the way to the light at which that plane is crossed."""
    light = np.array(LIGHTS[kind]["position"])
    if LIGHTS[kind]["positional"]:
        toward = light - position
    else:
        toward = np.broadcast_to(light, position.shape)
    share = HEIGHT / toward[..., 1]
    crossing = position + share[..., None] * toward
    return np.maximum(np.abs(crossing[..., 0]), np.abs(crossing[..., 2])) - HALF


def texel_in_caster_plane(kind):
    """Upper bound of a map's texel, seen in the square's plane.

    Directional: the map spans at most the scene's box diagonal, and a texel appears on the plane
    stretched by 1 / cos(light, plane's normal). Spot: the frustum's width at the plane. Cube face:
    2 d / resolution at distance d along the face's axis, stretched likewise."""
    light = np.array(LIGHTS[kind]["position"])
    cosine = light[1] / np.linalg.norm(light)
    if kind == "directional":
        extent = np.linalg.norm([2 * FLOOR, HEIGHT, 2 * FLOOR])
        return extent / RESOLUTION / cosine
    reach = np.linalg.norm(light) + HALF * 2
    tangent = np.tan(np.radians(35.0)) if kind == "spot" else 1.0
    return 2 * tangent * reach / RESOLUTION / cosine


# A cosine from a dot product of two normalised vectors in single precision is off by less than 16
# roundings of 2^-24.
COSINE_ROUNDING = 16 * 2.0**-24


def beyond_cone(kind, position):
    """By how much the cosine of each point to the light's axis is below that of its cone."""
    if "spot" not in kind:
        return np.full(position.shape[:-1], -np.inf)
    light = np.array(LIGHTS[kind]["position"])
    way = position - light
    cosine = (way @ -light) / np.linalg.norm(way, axis=-1) / np.linalg.norm(light)
    return np.cos(np.radians(LIGHTS[kind]["ConeAngle"])) - cosine


@pytest.mark.parametrize("mode", ["ShadowMaps", "Exact"])
@pytest.mark.parametrize("size", [(300, 300), (600, 300), (200, 500)], ids=lambda s: f"{s[0]}x{s[1]}")
@pytest.mark.parametrize("kind", LIGHTS)
def test_shadow_of_a_square(kind, size, mode, render):
    renderer, rt = scene(kind)
    getattr(rt, f"SetShadowModeTo{mode}")()
    render(renderer, size)
    check_shadow(kind, rt, f"{size[0]}x{size[1]}")


@pytest.mark.parametrize("distance", [1e3, 1e6, 1e9])
@pytest.mark.parametrize("parallel", [True, False], ids=["parallel", "long lens"])
@pytest.mark.parametrize("kind", LIGHTS)
def test_shadows_do_not_depend_on_how_far_the_camera_stands(kind, parallel, distance, render):
    renderer, rt = scene(kind)
    camera = renderer.GetActiveCamera()
    toward = np.array([1.0, 5.0, 4.0]) / np.linalg.norm([1.0, 5.0, 4.0])
    camera.SetPosition(*(distance * toward))
    camera.SetParallelProjection(parallel)
    camera.SetParallelScale(2.0)
    camera.SetViewAngle(np.degrees(2.0 * np.arctan(2.0 / distance)))
    renderer.ResetCameraClippingRange()
    render(renderer, (300, 300))
    check_shadow(kind, rt, f"from {distance:g}")


def picture_in_units(kind, unit, render):
    floor = scenes.actor_of(scenes.plane(FLOOR, 0.0))
    ball = scenes.actor_of(scenes.superquadric())
    ball.SetPosition(0.0, HEIGHT * unit, 0.0)
    for actor in floor, ball:
        actor.SetScale(unit)
    renderer = scenes.renderer_of(floor, ball)
    settings = dict(LIGHTS[kind])
    position = [unit * x for x in settings.pop("position")]
    light = scenes.scene_light(position, (0, 0, 0), **settings)
    light.SetAttenuationValues(0.5, 0.1 / unit, 0.02 / unit**2)
    renderer.AddLight(light)
    scenes.look(renderer, [unit * x for x in (1.0, 5.0, 4.0)])
    renderer.GetActiveCamera().SetClippingRange(1.0 * unit, 16.0 * unit)
    renderer.SetPass(vtkHybridRayTracingPass())
    return render(renderer, (300, 300))


@pytest.mark.parametrize("exponent", [-53, -30, 30, 53])
@pytest.mark.parametrize("kind", LIGHTS)
def test_shadow_maps_do_not_depend_on_the_unit(kind, exponent, render):
    """A power of two changes no digit, as long as nothing leaves the range of float."""
    picture = picture_in_units(kind, 1.0, render)
    assert np.unique(picture.reshape(-1, picture.shape[-1]), axis=0).shape[0] > 100
    assert np.array_equal(picture_in_units(kind, 2.0**exponent, render), picture)


def check_shadow(kind, rt, title):
    on_floor = buffer(rt, "prop") == 0
    visible = buffer(rt, "shadow")[on_floor]
    position = buffer(rt, "position")[on_floor]
    outside = analytic(kind, position)
    # Bilinear comparison spreads the border over the texels on its two sides.
    border = 2.0 * texel_in_caster_plane(kind)
    beyond = beyond_cone(kind, position)
    lit = (outside > border) & (beyond < -COSINE_ROUNDING)
    # Beyond the cone no light arrives either.
    dark = (outside < -border) | (beyond > COSINE_ROUNDING)
    assert kind != "spot" or (beyond > COSINE_ROUNDING).sum() > 2000
    wrong = np.count_nonzero(visible[lit] != 1.0) + np.count_nonzero(visible[dark] != 0.0)
    print(
        f"shadow {kind} {title}: {wrong} wrong of {visible.size} floor pixels,"
        f" {visible.size - lit.sum() - dark.sum()} on the border of {border:.4f}"
    )
    assert dark.sum() > 200 and lit.sum() > 2000
    assert wrong == 0


def eroded(mask, pixels):
    """What of the mask is at least so many pixels away from its border."""
    for axis in 0, 1:
        whole = mask.copy()
        for by in range(-pixels, pixels + 1):
            mask = mask & np.roll(whole, by, axis=axis)
    return mask


@pytest.mark.parametrize("elevation", [15, 5, 2])
@pytest.mark.parametrize("positional", [False, True], ids=["directional", "point"])
def test_a_flat_table_under_grazing_light_does_not_shadow_itself(positional, elevation, render):
    table = scenes.actor_of(scenes.plane(0.5, 0.0, resolution=20))
    balls = []
    for height in 0.09, -0.3:
        ball = vtkSphereSource()
        ball.SetRadius(0.08)
        ball.SetCenter(0.0, height, 0.0)
        ball.SetThetaResolution(32)
        ball.SetPhiResolution(32)
        balls.append(scenes.actor_of(ball))
    renderer = scenes.renderer_of(table, *balls)
    e, a = np.radians(elevation), np.radians(35.0)
    position = 2.0 * np.array([np.cos(e) * np.cos(a), np.sin(e), np.cos(e) * np.sin(a)])
    cone = dict(ConeAngle=90.0) if positional else {}
    renderer.AddLight(scenes.scene_light(position, (0, 0, 0), positional, **cone))
    scenes.look(renderer, (0.3, 1.0, 1.2))
    rt = vtkHybridRayTracingPass()
    rt.SetBuffers(["shadow", "prop"])
    renderer.SetPass(rt)
    shares = {}
    for mode in "Exact", "ShadowMaps":
        getattr(rt, f"SetShadowModeTo{mode}")()
        render(renderer, (400, 300))
        on_table = buffer(rt, "prop") == 0
        shares[mode] = buffer(rt, "shadow")
    lit, dark = on_table & (shares["Exact"] == 1), on_table & (shares["Exact"] == 0)
    # Comparison spreads borders over two texels. Those of the point light, 2 in distance, are stretched by
    # 1 / sin(elevation) on the table, of which 250 pixels show a length of 1.
    border = int(2 * (2 * 2.0 / rt.GetShadowMapResolution()) / np.sin(e) * 250) + 2
    false = (eroded(lit, border) & (shares["ShadowMaps"] < 1.0)).sum()
    lost = (dark & (shares["ShadowMaps"] > 0.5)).sum()
    print(f"{elevation} degrees: {false} of {lit.sum()} lit pixels dark, {lost} of {dark.sum()} dark lit")
    assert lit.sum() > 50000 and dark.sum() > 500
    assert false == 0
    assert lost <= 0.1 * dark.sum()


def test_headlight_shadow_falls_away_from_the_viewer(render):
    """A directional headlight casts along the view axis: a point is in shadow when the square covers
    it in that direction, whatever the perspective shows."""
    renderer, rt = scene("directional")
    renderer.RemoveAllLights()
    headlight = scenes.vtkLight()
    headlight.SetLightTypeToHeadlight()
    renderer.AddLight(headlight)
    rt.HeadlightShadowsOn()
    render(renderer, (400, 300))
    camera = renderer.GetActiveCamera()
    toward = -np.array(camera.GetDirectionOfProjection())
    on_floor = buffer(rt, "prop") == 0
    position = buffer(rt, "position")[on_floor]
    crossing = position + (HEIGHT / toward[1]) * toward
    outside = np.maximum(np.abs(crossing[:, 0]), np.abs(crossing[:, 2])) - HALF
    border = 2.0 * np.linalg.norm([2 * FLOOR, HEIGHT, 2 * FLOOR]) / RESOLUTION / toward[1]
    visible = buffer(rt, "shadow")[on_floor]
    assert np.count_nonzero(outside < -border) > 100
    assert (visible[outside > border] == 1.0).all()
    assert (visible[outside < -border] == 0.0).all()


def test_light_at_the_eye_casts_no_visible_shadow(render):
    renderer, rt = scene("spot")
    renderer.RemoveAllLights()
    headlight = scenes.vtkLight()
    headlight.SetLightTypeToHeadlight()
    headlight.PositionalOn()
    headlight.SetConeAngle(80)
    renderer.AddLight(headlight)
    rt.HeadlightShadowsOn()
    render(renderer)
    hit = buffer(rt, "prop") >= 0
    assert (buffer(rt, "shadow")[hit] == 1.0).all()


@pytest.mark.parametrize("kind", LIGHTS)
def test_sphere_does_not_shadow_its_lit_side(kind, render):
    """No acne: where both the facet and the sphere itself face the light by more than the fold that
    the bias forgives near the terminator, the share is exactly 1."""
    source = scenes.vtkSphereSource()
    source.SetThetaResolution(60)
    source.SetPhiResolution(60)
    renderer = scenes.renderer_of(scenes.actor_of(source))
    renderer.AddLight(scenes.scene_light(**LIGHTS[kind]))
    scenes.look(renderer, (1.5, 1.0, 1.5))
    rt = vtkHybridRayTracingPass()
    rt.SetBuffers(["shadow", "normal", "position", "prop"])
    renderer.SetPass(rt)
    render(renderer, (400, 400))
    hit = buffer(rt, "prop") >= 0
    light = np.array(LIGHTS[kind]["position"])
    position = buffer(rt, "position")[hit]
    toward = light - position if LIGHTS[kind]["positional"] else np.broadcast_to(light, position.shape)
    toward = toward / np.linalg.norm(toward, axis=1, keepdims=True)
    facing = np.sum(toward * position / np.linalg.norm(position, axis=1, keepdims=True), axis=1)
    # Facets of 6 degrees: beyond 90 - 6 the facet itself may turn its back to the light.
    lit = facing > np.sin(np.radians(6.0))
    assert lit.sum() > 5000
    assert (buffer(rt, "shadow")[hit][lit] == 1.0).all()


def test_shadow_darkens_the_picture_by_the_light_it_lost(render):
    """In shadow only the ambient part of one light's picture is left."""
    renderer, rt = scene("directional")
    for i in range(2):
        renderer.GetViewProps().GetItemAsObject(i).GetProperty().SetAmbient(0.25)
    shown = render(renderer)
    shadow = buffer(rt, "shadow")
    on_floor = buffer(rt, "prop") == 0
    dark = on_floor & (shadow == 0.0)
    assert dark.sum() > 200
    assert (np.abs(shown[dark].astype(int) - round(0.25 * 255)) <= 1).all()


@pytest.mark.parametrize("kind", LIGHTS)
@pytest.mark.parametrize("size", [1e2, 1e4])
def test_large_floor_costs_no_resolution(kind, size, render):
    """A floor shadows nothing that stands on it, however far it reaches: the map is the object's."""
    pictures = []
    for half in (FLOOR, size):
        ball = scenes.vtkSphereSource()
        ball.SetThetaResolution(40)
        ball.SetPhiResolution(40)
        ball.SetCenter(0, 0.5, 0)
        floor = scenes.actor_of(scenes.plane(half, 0.0))
        renderer = scenes.renderer_of(floor, scenes.actor_of(ball))
        renderer.AddLight(scenes.scene_light(**LIGHTS[kind]))
        scenes.look(renderer, (1.0, 3.0, 2.0), (0, 0.3, 0))
        # The same clipping range, so that both floors are seen alike.
        renderer.GetActiveCamera().SetClippingRange(0.5, 6.0)
        rt = vtkHybridRayTracingPass()
        rt.SetShadowMapResolution(RESOLUTION)
        rt.SetBuffers(["shadow", "prop", "position"])
        renderer.SetPass(rt)
        render(renderer)
        inside = np.abs(buffer(rt, "position")).max(axis=2) < FLOOR - 0.1
        pictures.append(np.where(inside & (buffer(rt, "prop") == 0), buffer(rt, "shadow"), 1.0))
    small, large = pictures
    assert (small == 0).sum() > 500
    # Positions on a floor of 1e4 are floats in steps of 1e-3: only the border may move.
    assert np.abs(small - large).sum() < 0.02 * (small == 0).sum()


@pytest.mark.parametrize("parallel", [False, True])
def test_positional_headlight(parallel, render):
    """At the eye of a perspective its shadows are hidden; a parallel projection sees past them."""
    ball = scenes.vtkSphereSource()
    ball.SetRadius(0.3)
    ball.SetCenter(0.5, 0.9, 0.3)
    renderer = scenes.renderer_of(scenes.actor_of(scenes.plane(FLOOR)), scenes.actor_of(ball))
    headlight = scenes.vtkLight()
    headlight.SetLightTypeToHeadlight()
    headlight.PositionalOn()
    headlight.SetConeAngle(80)
    renderer.AddLight(headlight)
    camera = scenes.look(renderer, (1.0, 5.0, 4.0)).GetActiveCamera()
    camera.SetParallelProjection(parallel)
    camera.SetParallelScale(2.5)
    renderer.ResetCameraClippingRange()
    rt = vtkHybridRayTracingPass()
    rt.HeadlightShadowsOn()
    rt.SetBuffers(["shadow", "prop"])
    renderer.SetPass(rt)
    render(renderer)
    dark = (buffer(rt, "prop") == 0) & (buffer(rt, "shadow") == 0)
    assert (dark.sum() > 100) == parallel


@pytest.mark.parametrize("mode", ["ShadowMaps", "Exact"])
@pytest.mark.parametrize("lights", ["VTK's own", "a headlight and a lamp"])
def test_headlights_cast_nothing_and_cost_nothing(mode, lights, render):
    """As in VTK's own shadow pass; other lights of the scene cast as before."""
    ball = scenes.vtkSphereSource()
    ball.SetRadius(0.5)
    ball.SetCenter(0, 1, 0)
    renderer = scenes.renderer_of(scenes.actor_of(scenes.plane(FLOOR)), scenes.actor_of(ball))
    if lights != "VTK's own":
        headlight = scenes.vtkLight()
        headlight.SetLightTypeToHeadlight()
        renderer.AddLight(headlight)
        renderer.AddLight(scenes.scene_light((0, 4, 0)))
    scenes.look(renderer, (1.0, 5.0, 4.0))
    rt = vtkHybridRayTracingPass()
    getattr(rt, f"SetShadowModeTo{mode}")()
    rt.SetBuffers(["shadow"])
    renderer.SetPass(rt)
    render(renderer)
    share = buffer(rt, "shadow")
    report = statistics(rt)
    if lights == "VTK's own":
        assert not (share < 1).any()
        assert not report["stages"]["shadow_maps"]["ran"]
        assert report["rays"]["shadow"]["traced"] == 0
    else:
        assert not (share[..., 0] < 1).any()
        assert (share[..., 1] == 0).sum() > 100
