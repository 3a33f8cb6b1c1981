"""Meshes that a rasteriser in software gets in pieces: their triangles have the same numbers, and nothing is
lost between the pieces."""

import numpy as np
import scenes
from vtkhybrid import buffer, statistics, vtkHybridRayTracingPass

ABOUT = 300_000  # triangles; pieces are 2^15, in scenes of 2^18 and more
PIECE = 2**15
SIZE = (320, 240)


def buffers_of(render, data, visibility):
    floor = scenes.actor_of(scenes.plane(2.0, -0.6))
    renderer = scenes.renderer_of(scenes.actor_of(data), floor)
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=30.0))
    scenes.look(renderer, (0.5, 2, 5))
    rt = vtkHybridRayTracingPass()
    getattr(rt, "SetVisibilityTo" + visibility)()
    rt.SetBuffers(["triangle", "shadow"])
    renderer.SetPass(rt)
    render(renderer, SIZE)
    assert statistics(rt)["triangles"] >= 2**18
    return buffer(rt, "triangle").copy(), buffer(rt, "shadow").copy()


def test_numbers_and_shadows_of_a_mesh_in_pieces(render):
    data = scenes.torus(ABOUT)
    drawn, shadow = buffers_of(render, data, "ItemBuffer")
    corners, _ = buffers_of(render, data, "DirectRendering")
    assert np.array_equal(drawn, corners)
    cast, _ = buffers_of(render, data, "RayCasting")
    # The rasteriser snaps corners to a grid of 2^-8 of a pixel and more; triangles here are less than half a
    # pixel wide, so at most so many pixels' centres lie within the snap of an edge, of which a third turn.
    assert np.count_nonzero(drawn != cast) < 0.04 * np.count_nonzero(cast >= 0)
    assert ((drawn < 0) != (cast < 0)).mean() < 0.002  # at outlines
    # Every piece is seen, and the whole torus casts its shadow: none of the floor's light comes through it.
    torus = drawn[(drawn >= 0) & (drawn < drawn.max() - 1)]  # the floor is the last two
    assert (np.bincount(torus // PIECE) > 0).all()
    assert torus.max() // PIECE == ABOUT // PIECE
    assert 0.02 < (shadow[drawn >= 0] < 0.5).mean() < 0.9
