"""With shadows, mirrors and glass off, the pass must show what VTK's own renderer shows: at least
99.9 % of the pixels that do not touch a silhouette differ by at most one 8-bit step."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, statistics, vtkHybridRayTracingPass

REQUIRED_SHARE = 0.999
STEP = 1

# A neighbour this many pixel footprints off the tangent plane lies on another sheet of the surface:
# within a smooth sheet it is off by about footprint^2 * curvature, far less than one footprint.
SHEET_FOOTPRINTS = 4.0


def near_silhouette(rt):
    """Pixels with, in their 3 x 3 neighbourhood, a hit beside no hit, another prop, block or glyph, or
    another sheet."""
    # One number for the three.
    owner = np.stack([buffer(rt, name) for name in ("prop", "block", "glyph")], axis=2)
    prop = np.unique(owner.reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(owner.shape[:2])
    position = buffer(rt, "position")
    normal = buffer(rt, "normal")
    height, width = prop.shape
    edge = np.zeros(prop.shape, bool)
    # Size of a pixel at each hit: the smaller distance to a neighbour in the picture.
    right = np.linalg.norm(np.roll(position, -1, 1) - position, axis=2)
    up = np.linalg.norm(np.roll(position, -1, 0) - position, axis=2)
    footprint = np.fmin(right, up)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            if dx == 0 and dy == 0:
                continue
            other = np.full(prop.shape, -2, prop.dtype)
            offset = np.full(position.shape, np.nan)
            here = (slice(max(0, -dy), height - max(0, dy)), slice(max(0, -dx), width - max(0, dx)))
            there = (slice(max(0, dy), height - max(0, -dy)), slice(max(0, dx), width - max(0, -dx)))
            other[here] = prop[there]
            offset[here] = position[there] - position[here]
            edge |= (other != prop) & (other != -2)
            off_plane = np.abs(np.sum(offset * normal, axis=2))
            with np.errstate(invalid="ignore"):
                edge |= off_plane > SHEET_FOOTPRINTS * footprint
    return edge


def compare(renderer, render, visibility="ItemBuffer", size=(400, 300), shading="GPU"):
    expected = render(renderer, size).astype(int)
    rt = vtkHybridRayTracingPass()
    rt.SetShadowModeToOff()
    getattr(rt, "SetVisibilityTo" + visibility)()
    getattr(rt, "SetPrimaryShadingTo" + shading)()
    rt.SetBuffers(["prop", "block", "glyph", "position", "normal"])
    renderer.SetPass(rt)
    shown = render(renderer, size).astype(int)
    assert not statistics(rt)["left_to_vtk"], "the scene must be traced, not left to VTK"
    edge = near_silhouette(rt)
    hit = buffer(rt, "prop") >= 0
    difference = np.abs(shown - expected).max(axis=2)
    inside = ~edge
    good = np.count_nonzero(difference[inside] <= STEP) / np.count_nonzero(inside)
    on_hits = difference[inside & hit]
    return {
        "good": good,
        "hits": np.count_nonzero(hit) / hit.size,
        "edges": np.count_nonzero(edge) / edge.size,
        "good_hits": np.count_nonzero(on_hits <= STEP) / max(1, on_hits.size),
        "worst": int(on_hits.max()) if on_hits.size else 0,
    }


def check(name, figures, minimum_hits=0.1):
    print(
        f"parity {name}: {100 * figures['good']:.4f} % within 1/255"
        f" ({100 * figures['good_hits']:.4f} % of hit pixels, worst {figures['worst']}/255;"
        f" hits {100 * figures['hits']:.1f} %, silhouettes left out {100 * figures['edges']:.1f} %)"
    )
    assert figures["hits"] >= minimum_hits, "the scene fills too little of the picture to mean much"
    assert figures["edges"] < 0.2
    # Background is no achievement: the surface pixels alone must hold the bound.
    assert figures["good_hits"] >= REQUIRED_SHARE


@pytest.mark.parametrize("scene", scenes.PARITY, ids=lambda scene: scene.__name__)
@pytest.mark.parametrize("visibility", ["ItemBuffer", "DirectRendering"])
def test_same_picture_as_vtk(scene, visibility, render):
    check(f"{scene.__name__} {visibility}", compare(scene(), render, visibility))


def test_bunny(render, data_file):
    actor = scenes.actor_of(
        scenes.bunny(data_file("bunny/bunny.ply")), Color=(0.9, 0.7, 0.5), Specular=0.3
    )
    renderer = scenes.renderer_of(actor)
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    scenes.look(renderer, (0.0, 0.15, 0.45), (-0.02, 0.11, 0.0))
    check("bunny", compare(renderer, render, size=(800, 600)))
