"""Every mode of the pass against the double-precision reference renderer: the triangles that pixels
show, and the finished pictures with shadows, mirrors and glass."""

import numpy as np
import pytest
import reference
import scenes
import test_traditional
from vtkhybrid import buffer, statistics, vtkHybridMaterial, vtkHybridRayTracingPass

SIZE = (96, 72)

# The picture is stored in 8 bits, on the way the shading is summed in single precision: a value that
# lies at the border of two steps may go to either.
STEP = 1.0 / 255.0

# The rasteriser snaps corners to 1/256 pixel and may give a pixel within that of an edge to the
# neighbour. At this resolution less than 1 % of the pixels lie so near an edge.
RASTER_IDS = 0.01

# A shadow map decides up to its texel's size beside the exact shadow's border, and biased near
# contacts; the scenes' borders cross less than this share of the pixels.
MAP_BORDERS = 0.05


def mirror_and_glass():
    return test_traditional.lively()


def shadows_on_a_plane():
    """A spot, a point and a directional light; a caster with facets over a floor."""
    floor = scenes.actor_of(scenes.plane(2.5, -0.7), Color=(0.8, 0.8, 0.7))
    caster = scenes.actor_of(scenes.torus(), Color=(0.4, 0.6, 0.9), Specular=0.5, SpecularPower=20.0)
    caster.RotateX(60)
    renderer = scenes.renderer_of(floor, caster)
    renderer.AddLight(scenes.scene_light((1, 4, 2), positional=True, ConeAngle=25.0, Exponent=2.0))
    renderer.AddLight(
        scenes.scene_light((-1, 2, 1), positional=True, ConeAngle=180.0, Intensity=0.4)
    )
    renderer.AddLight(scenes.scene_light((0.5, 3, -1), Intensity=0.3))
    return scenes.look(renderer, (0, 2.2, 5))


def facing_mirrors():
    """Mirrors that show each other to the fourth image; their light is cut by the depth."""
    left = scenes.actor_of(scenes.plane(1.0), Color=(0.9, 0.7, 0.7), Ambient=0.2)
    left.RotateZ(-90)
    left.SetPosition(-0.8, 0, 0)
    right = scenes.actor_of(scenes.plane(1.0), Color=(0.7, 0.7, 0.9), Ambient=0.2)
    right.RotateZ(90)
    right.SetPosition(0.8, 0, 0)
    for mirror in (left, right):
        vtkHybridMaterial.SetReflectance(mirror, 0.7)
    ball = scenes.actor_of(scenes.superquadric(16), Color=(0.3, 0.9, 0.4), Specular=0.3)
    ball.SetScale(0.4)
    renderer = scenes.renderer_of(left, right, ball)
    renderer.AddLight(scenes.scene_light((0.2, 2, 4)))
    return scenes.look(renderer, (0.3, 0.6, 3.2))


def mirrored_matrices():
    """The parity scene of mirroring matrices and assemblies, as mirrors of each other."""
    renderer = scenes.matrices()
    for prop in renderer.GetViewProps():
        vtkHybridMaterial.SetReflectance(prop, 0.3)
    return renderer


SCENES = [
    mirror_and_glass,
    shadows_on_a_plane,
    facing_mirrors,
    mirrored_matrices,
    scenes.point_light,
    scenes.scalars_before_mapping,
    scenes.no_normals,
    scenes.parallel_off_centre,
    scenes.far_from_origin,
]
VISIBILITIES = ["ItemBuffer", "DirectRendering", "RayCasting"]


@pytest.fixture(scope="module")
def reference_of():
    """The reference picture of a scene function, drawn once for all modes."""
    pictures = {}

    def find(scene, renderer, **settings):
        key = (scene.__name__, tuple(settings.items()))
        if key not in pictures:
            pictures[key] = reference.Picture(renderer, **settings)
        return pictures[key]

    return find


def draw(renderer, render, visibility, shading, shadows):
    rt = vtkHybridRayTracingPass()
    getattr(rt, "SetVisibilityTo" + visibility)()
    getattr(rt, "SetPrimaryShadingTo" + shading)()
    if not shadows:
        rt.SetShadowModeToOff()
    elif shading == "CPU":
        rt.SetShadowModeToExact()
    rt.SetBuffers(["triangle"])
    renderer.SetPass(rt)
    picture = render(renderer, SIZE) / 255.0
    assert not statistics(rt)["left_to_vtk"], "the scene must be traced, not left to VTK"
    return picture, buffer(rt, "triangle")


def errors(picture, truth):
    """By how much a pixel is off beyond what the tracer omits for lightness."""
    shown = np.clip(truth.colors[..., :3], 0.0, 1.0)
    # Rounded away where the truth is beyond 1 already.
    return (np.abs(picture - shown) - truth.omitted).max(axis=2)


def compare(scene, visibility, shading, shadows, render, reference_of):
    renderer = scene()
    picture, ids = draw(renderer, render, visibility, shading, shadows)
    truth = reference_of(scene, renderer, shadows=shadows)
    assert (truth.height, truth.width) == ids.shape
    covered = truth.colors[..., 3] > 0
    assert covered.mean() > 0.1, "the scene fills too little of the picture to mean much"
    # Rounding decides in few pixels, or the comparison would mean little.
    assert (truth.tie | truth.fragile).mean() < 0.02
    allowed = truth.allows(ids)
    decided = allowed & ~truth.tie & ~truth.fragile & covered
    off = errors(picture, truth)[decided]
    name = f"{scene.__name__} {visibility} {shading} shadows {'on' if shadows else 'off'}"
    print(
        f"reference {name}: ids outside {np.count_nonzero(~allowed)}, ties {truth.tie.sum()},"
        f" fragile {truth.fragile.sum()}, beyond a step {np.count_nonzero(off > STEP)} of {off.size},"
        f" worst {255 * off.max():.2f}/255, mean {255 * np.abs(off).mean():.3f}/255"
    )
    return allowed, off


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("shadows", [True, False], ids=["shadows", "plain"])
def test_rays_show_the_reference(scene, shadows, render, reference_of):
    """The traditional tracer: no id outside of the admissible set, no pixel off by more than a step."""
    allowed, off = compare(scene, "RayCasting", "CPU", shadows, render, reference_of)
    assert allowed.all()
    assert off.max() <= STEP


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("visibility", VISIBILITIES)
def test_cpu_shading_shows_the_reference(scene, visibility, render, reference_of):
    """Where the rasteriser names an admissible triangle, the picture is the reference's. It is asked
    for one and the same set of primary points, so that an edge's pixel may differ and no other."""
    allowed, off = compare(scene, visibility, "CPU", True, render, reference_of)
    assert np.count_nonzero(~allowed) / allowed.size <= (0 if visibility == "RayCasting" else RASTER_IDS)
    assert off.max() <= STEP


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("visibility", VISIBILITIES)
def test_gpu_shading_shows_the_reference(scene, visibility, render, reference_of):
    """Without shadows the GPU's picture is the reference's, mirrors and glass included."""
    allowed, off = compare(scene, visibility, "GPU", False, render, reference_of)
    assert np.count_nonzero(~allowed) / allowed.size <= (0 if visibility == "RayCasting" else RASTER_IDS)
    assert off.max() <= STEP


@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("visibility", VISIBILITIES)
def test_shadow_maps_differ_at_borders_only(scene, visibility, render, reference_of):
    _, off = compare(scene, visibility, "GPU", True, render, reference_of)
    assert np.count_nonzero(off > STEP) / off.size <= MAP_BORDERS


@pytest.mark.parametrize("depth", [0, 1, 6])
def test_depths(depth, render):
    renderer = facing_mirrors()
    rt = vtkHybridRayTracingPass()
    rt.SetVisibilityToRayCasting()
    rt.SetPrimaryShadingToCPU()
    rt.SetMaximumDepth(depth)
    renderer.SetPass(rt)
    picture = render(renderer, SIZE) / 255.0
    truth = reference.Picture(renderer, maximum_depth=depth)
    decided = ~truth.tie & ~truth.fragile & (truth.colors[..., 3] > 0)
    assert decided.mean() > 0.3
    assert errors(picture, truth)[decided].max() <= STEP


def test_the_reference_notices_a_wrong_picture(render):
    """The comparison itself: a light that is a hundredth stronger is seen."""
    renderer = shadows_on_a_plane()
    picture, _ = draw(renderer, render, "RayCasting", "CPU", True)
    for light in renderer.GetLights():
        light.SetIntensity(light.GetIntensity() * 1.02)
    truth = reference.Picture(renderer)
    assert errors(picture, truth)[truth.colors[..., 3] > 0].max() > STEP
