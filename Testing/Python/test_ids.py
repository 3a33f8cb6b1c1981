"""The ids in the buffers are those that VTK's own selection by the hardware gives."""

import numpy as np
import pytest
import scenes
from vtkhybrid import buffer, vtkHybridRayTracingPass
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkSelectionNode
from vtkmodules.vtkRenderingCore import vtkHardwareSelector

SIZE = (320, 240)
NOTHING = -1


def selected(renderer):
    """Of each pixel VTK's number of the prop, flat index of the block, and number of the cell or glyph."""
    selector = vtkHardwareSelector()
    selector.SetRenderer(renderer)
    selector.SetArea(0, 0, SIZE[0] - 1, SIZE[1] - 1)
    selector.SetFieldAssociation(vtkDataObject.FIELD_ASSOCIATION_CELLS)
    assert selector.CaptureBuffers()
    ids = np.full((SIZE[1], SIZE[0], 3), NOTHING, np.int64)
    for y in range(SIZE[1]):
        for x in range(SIZE[0]):
            selection = selector.GenerateSelection(x, y, x, y)
            if selection.GetNumberOfNodes() == 0:
                continue
            node = selection.GetNode(0)
            properties = node.GetProperties()
            ids[y, x, 0] = properties.Get(vtkSelectionNode.PROP_ID())
            if properties.Has(vtkSelectionNode.COMPOSITE_INDEX()):
                ids[y, x, 1] = properties.Get(vtkSelectionNode.COMPOSITE_INDEX())
            ids[y, x, 2] = node.GetSelectionList().GetTuple1(0)
    return ids


def surrounded(owner):
    """The pixels whose 3 x 3 neighbourhood has one owner."""
    height, width = owner.shape
    same = np.zeros(owner.shape, bool)
    same[1:-1, 1:-1] = True
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            same[1:-1, 1:-1] &= (
                owner[1 + dy : height - 1 + dy, 1 + dx : width - 1 + dx] == owner[1:-1, 1:-1]
            )
    return same


@pytest.mark.parametrize("visibility", ["ItemBuffer", "DirectRendering", "RayCasting"])
@pytest.mark.parametrize("scene", [scenes.glyphs, scenes.composite, scenes.data_set, scenes.clipped])
def test_ids_are_those_of_the_hardware_selector(scene, visibility, render):
    renderer = scene()
    render(renderer, SIZE)
    selection = selected(renderer)
    rt = vtkHybridRayTracingPass()
    getattr(rt, "SetVisibilityTo" + visibility)()
    rt.SetBuffers(["prop", "block", "glyph", "cell"])
    renderer.SetPass(rt)
    render(renderer, SIZE)
    prop, block, glyph, cell = (buffer(rt, name) for name in ("prop", "block", "glyph", "cell"))
    # VTK numbers the props in the order of drawing, which is that of the scenes' actors.
    compared = surrounded(prop) & surrounded(selection[..., 0]) & (prop >= 0)
    assert np.count_nonzero(compared) > 0.1 * prop.size
    assert np.array_equal(prop[compared], selection[..., 0][compared])
    if scene is scenes.composite:
        in_blocks = compared & (prop == 0)
        assert len(np.unique(block[in_blocks])) == 3
        assert np.array_equal(block[in_blocks], selection[..., 1][in_blocks])
    # Of a glyph VTK gives the point that it stands at, of other surfaces the cell.
    numbers = np.where(glyph >= 0, glyph, cell)
    if visibility == "RayCasting":  # a ray through the pixel's centre knows no snapping of corners
        compared &= surrounded(numbers)
    if scene is scenes.data_set:  # of an image VTK gives no cell, see the test below
        compared &= prop == 1
    differ = compared & (numbers != selection[..., 2])
    print(f"ids, {scene.__name__} {visibility}: {np.count_nonzero(compared)} pixels")
    assert not differ.any()
    assert len(np.unique(numbers[compared])) > 20


def test_cells_of_an_image(render):
    """VTK's selection numbers the triangles of an image's surface; the buffer has the image's cells."""
    renderer = scenes.data_set()
    actor = renderer.GetViewProps().GetItemAsObject(0)
    image = actor.GetMapper().GetInput()
    rt = vtkHybridRayTracingPass()
    rt.SetBuffers(["prop", "cell", "position", "normal"])
    renderer.SetPass(rt)
    render(renderer, SIZE)
    on_image = buffer(rt, "prop") == 0
    # A hundredth of a cell below the surface, where the cell is not in question.
    below = buffer(rt, "position") / actor.GetScale()[0] - 0.01 * buffer(rt, "normal")
    extent = np.array(image.GetDimensions()) - 1
    at = np.clip(np.floor(below[on_image]).astype(int), 0, extent - 1)
    expected = at[:, 0] + extent[0] * (at[:, 1] + extent[1] * at[:, 2])
    inside = surrounded(buffer(rt, "cell"))[on_image]  # edges of cells are decided by rounding
    assert np.count_nonzero(inside) > 1000
    assert np.array_equal(buffer(rt, "cell")[on_image][inside], expected[inside])
