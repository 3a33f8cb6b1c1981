"""The package itself: that it imports, that it checks the names of buffers, that the test fixtures do
what the other tests trust them to do."""

import numpy as np
import pytest

import vtkhybrid
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOLegacy import vtkPolyDataReader
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer


def sphere_renderer():
    sphere = vtkSphereSource()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(sphere.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    return renderer


def test_reexports_the_wrapped_classes():
    for name in vtkhybrid.__all__:
        assert hasattr(vtkhybrid, name), name
    assert vtkhybrid.vtkHybridRayTracingPass().IsA("vtkRenderPass")
    assert vtkhybrid.__version__.count(".") == 2


def test_unknown_buffer_names_are_refused_and_the_known_listed():
    rt = vtkhybrid.vtkHybridRayTracingPass()
    with pytest.raises(ValueError, match="'triangle'.*'cell'"):
        vtkhybrid.buffer(rt, "triangles")
    with pytest.raises(ValueError):
        vtkhybrid.set_buffers(rt, ["depth", "triangles"])
    with pytest.raises(TypeError):
        vtkhybrid.set_buffers(rt, [7])


def test_set_buffers_round_trip():
    rt = vtkhybrid.vtkHybridRayTracingPass()
    vtkhybrid.set_buffers(rt, ["cell", "normal"])
    assert tuple(rt.GetBuffers()) == ("cell", "normal")
    vtkhybrid.set_buffers(rt, "depth")
    assert tuple(rt.GetBuffers()) == ("depth",)


def test_buffer_says_what_to_do_when_there_is_none():
    rt = vtkhybrid.vtkHybridRayTracingPass()
    with pytest.raises(RuntimeError, match="SetBuffers"):
        vtkhybrid.buffer(rt, "cell")
    rt.SetBuffers(["cell"])
    with pytest.raises(RuntimeError, match="render"):
        vtkhybrid.buffer(rt, "cell")


def test_buffer_is_a_view_of_the_frame(render):
    rt = vtkhybrid.vtkHybridRayTracingPass()
    vtkhybrid.set_buffers(rt, rt.GetKnownBuffers()[:1] + ("position",))
    renderer = sphere_renderer()
    renderer.SetPass(rt)
    picture = render(renderer, size=(60, 40))
    triangle = vtkhybrid.buffer(rt, "triangle")
    assert triangle.shape == (40, 60) and triangle.dtype == np.int64
    assert triangle[0, 0] == -1 and triangle[20, 30] >= 0
    assert picture[20, 30].any()
    position = vtkhybrid.buffer(rt, "position")
    assert position.shape == (40, 60, 3)
    assert np.isnan(position[0, 0]).all() and np.isfinite(position[20, 30]).all()
    assert position.base is not None
    assert isinstance(vtkhybrid.statistics(rt), dict)


def test_render_helper_has_row_0_at_the_bottom(render):
    renderer = sphere_renderer()
    renderer.SetViewport(0, 0, 1, 0.5)
    picture = render(renderer, size=(60, 40))
    assert picture.shape == (40, 60, 3) and picture.dtype == np.uint8
    assert picture[:20].any() and not picture[20:].any()


@pytest.mark.expects_vtk_messages("Unable to open file")
def test_vtk_errors_are_caught(vtk_messages):
    reader = vtkPolyDataReader()
    reader.SetFileName("no such file")
    reader.Update()
    assert len(vtk_messages) == 1


def test_data_root_is_a_folder(data_root):
    assert data_root.is_dir()


def test_a_setting_spelt_as_an_attribute_is_refused():
    rt = vtkhybrid.vtkHybridRayTracingPass()
    with pytest.raises(AttributeError, match=r"maximum_depth.*SetMaximumDepth"):
        rt.maximum_depth = 5
    with pytest.raises(AttributeError, match="nonsense"):
        rt.nonsense = 1
    assert rt.GetMaximumDepth() == 3


def test_the_renderer_gives_back_the_very_pass():
    renderer = vtkRenderer()
    rt = vtkhybrid.vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    assert renderer.GetPass() is rt
    assert rt.IsA("vtkHybridRayTracingPass") and rt.GetClassName() == "vtkHybridRayTracingPass"


@pytest.mark.expects_vtk_messages('got the string "depth"')
def test_a_string_is_no_list_of_buffers():
    rt = vtkhybrid.vtkHybridRayTracingPass()
    rt.SetBuffers("depth")
    assert len(rt.GetBuffers()) == 0
