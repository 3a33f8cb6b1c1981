"""The pass as a guest in other people's windows: switched on and off, resized, in several renderers and
windows, under multisampling; always the right picture, no OpenGL error (the pass reports it as a VTK
error, which fails the test), no object left behind."""

import numpy as np
import pytest
import scenes
from vtkhybrid import statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkRenderingCore import vtkHardwareSelector, vtkRenderWindow


def shaded_scene():
    floor = scenes.actor_of(scenes.plane(2.0, -0.6))
    vtkHybridMaterial.SetReflectance(floor, 0.4)
    renderer = scenes.renderer_of(floor, scenes.actor_of(scenes.torus(), Color=(0.9, 0.6, 0.3)))
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=40.0))
    return scenes.look(renderer, (0, 2, 5))


def test_on_off_on(render):
    renderer = shaded_scene()
    plain = render(renderer)
    rt = vtkHybridRayTracingPass()
    pictures = []
    for _ in range(3):
        renderer.SetPass(rt)
        pictures.append(render(renderer))
        renderer.SetPass(None)
        assert (render(renderer) == plain).all()
    assert (pictures[0] != plain).any()
    assert (pictures[1] == pictures[0]).all() and (pictures[2] == pictures[0]).all()


def test_resize(render):
    renderer = shaded_scene()
    renderer.SetPass(vtkHybridRayTracingPass())
    first = render(renderer, (300, 200))
    for size in ((150, 400), (1, 1), (500, 30), (640, 480)):
        assert render(renderer, size).shape == (size[1], size[0], 3)
    assert (render(renderer, (300, 200)) == first).all()


def test_two_renderers_in_one_window(render):
    window = vtkRenderWindow()
    window.SetMultiSamples(0)
    window.SetSize(401, 203)
    left, right = shaded_scene(), shaded_scene()
    right.GetActiveCamera().Azimuth(40)
    left.SetViewport(0.0, 0.0, 0.37, 1.0)
    right.SetViewport(0.37, 0.2, 1.0, 0.9)
    right.SetBackground(0.5, 0.1, 0.1)
    window.AddRenderer(left)
    window.AddRenderer(right)
    left.SetPass(vtkHybridRayTracingPass())
    right.SetPass(vtkHybridRayTracingPass())
    both = render(window)
    # Each alone gives its part of the same picture.
    for shown, hidden, where in (
        (left, right, np.s_[:, :148]),
        (right, left, np.s_[41:182, 149:]),
    ):
        hidden.DrawOff()
        assert (render(window)[where] == both[where]).all()
        hidden.DrawOn()
    window.Finalize()


def test_one_pass_in_two_renderers(render):
    """Unusual, but it must show both scenes rightly."""
    window = vtkRenderWindow()
    window.SetMultiSamples(0)
    window.SetSize(400, 200)
    left, right = shaded_scene(), shaded_scene()
    right.GetActiveCamera().Azimuth(40)
    left.SetViewport(0.0, 0.0, 0.5, 1.0)
    right.SetViewport(0.5, 0.0, 1.0, 1.0)
    window.AddRenderer(left)
    window.AddRenderer(right)
    left.SetPass(vtkHybridRayTracingPass())
    right.SetPass(vtkHybridRayTracingPass())
    expected = render(window)
    shared = vtkHybridRayTracingPass()
    left.SetPass(shared)
    right.SetPass(shared)
    for _ in range(2):
        assert (render(window) == expected).all()
    window.Finalize()


def test_two_windows_and_a_pass_that_moves_between_them(render):
    one, two = shaded_scene(), shaded_scene()
    expected = []
    for renderer in (one, two):
        renderer.SetPass(vtkHybridRayTracingPass())
        expected.append(render(renderer))
    assert (expected[0] == expected[1]).all()
    rt = vtkHybridRayTracingPass()
    for renderer in (one, two, one):
        renderer.SetPass(rt)
        assert (render(renderer) == expected[0]).all()


@pytest.mark.parametrize("samples", [0, 4])
def test_multisampled_window(samples):
    """Away from edges, a multisampled window shows the very same colours."""
    from conftest import render_to_numpy

    pictures = []
    for n in (0, samples):
        renderer = shaded_scene()
        renderer.SetPass(vtkHybridRayTracingPass())
        window = vtkRenderWindow()
        window.SetMultiSamples(n)
        window.SetSize(300, 300)
        window.AddRenderer(renderer)
        pictures.append(render_to_numpy(window).astype(int))
        window.Finalize()
    difference = np.abs(pictures[0] - pictures[1]).max(axis=2)
    assert np.count_nonzero(difference > 1) == 0


def test_every_object_is_freed():
    from conftest import render_to_numpy

    renderer = shaded_scene()
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    window = vtkRenderWindow()
    window.SetSize(100, 100)
    window.AddRenderer(renderer)
    assert rt.GetNumberOfOpenGLObjects() == 0
    picture = render_to_numpy(window)
    held = rt.GetNumberOfOpenGLObjects()
    assert held > 0
    for azimuth in range(5):
        renderer.GetActiveCamera().Azimuth(azimuth)
        render_to_numpy(window)
    window.SetSize(130, 90)
    render_to_numpy(window)
    assert rt.GetNumberOfOpenGLObjects() == held, "objects pile up from frame to frame"
    rt.ReleaseGraphicsResources(window)
    assert rt.GetNumberOfOpenGLObjects() == 0
    renderer.GetActiveCamera().Azimuth(-10)
    window.SetSize(100, 100)
    assert (render_to_numpy(window) == picture).all(), "works again after a release"
    window.Finalize()
    assert rt.GetNumberOfOpenGLObjects() == 0, "the window's end frees everything"


def test_pass_outlives_its_window_and_window_its_pass():
    from conftest import render_to_numpy

    renderer = shaded_scene()
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    window = vtkRenderWindow()
    window.SetSize(60, 60)
    window.AddRenderer(renderer)
    first = render_to_numpy(window)
    renderer.SetPass(None)  # the window no longer knows the pass when it goes
    window.RemoveRenderer(renderer)
    window.Finalize()
    del window
    window = vtkRenderWindow()
    window.SetSize(60, 60)
    window.AddRenderer(renderer)
    renderer.SetPass(rt)
    assert (render_to_numpy(window) == first).all()
    renderer.SetPass(None)
    del rt  # deletes its objects in the living window
    render_to_numpy(window)
    window.Finalize()


def test_picking_with_the_hardware_selector(render):
    renderer = shaded_scene()
    size = (200, 150)

    def pick():
        selector = vtkHardwareSelector()
        selector.SetRenderer(renderer)
        selector.SetArea(0, 0, size[0] - 1, size[1] - 1)
        selector.SetFieldAssociation(1)
        picked = set()
        selection = selector.Select()
        for i in range(selection.GetNumberOfNodes()):
            node = selection.GetNode(i)
            prop = node.GetProperties().Get(node.PROP())
            ids = node.GetSelectionList()
            for k in range(ids.GetNumberOfTuples()):
                picked.add((prop, ids.GetValue(k)))
        return picked

    render(renderer, size)
    expected = pick()
    assert len(expected) > 100
    renderer.SetPass(vtkHybridRayTracingPass())
    picture = render(renderer, size)
    assert pick() == expected
    assert (render(renderer, size) == picture).all(), "picking must not disturb the next frame"


def test_actors_come_and_go(render):
    renderer = shaded_scene()
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    first = render(renderer)
    extra = scenes.actor_of(scenes.vtkSphereSource(), Color=(0.2, 0.8, 0.2))
    extra.SetPosition(0.8, 0.5, 0.5)
    renderer.AddActor(extra)
    assert (render(renderer) != first).any()
    extra.VisibilityOff()
    assert (render(renderer) == first).all()
    extra.VisibilityOn()
    renderer.RemoveActor(extra)
    assert (render(renderer) == first).all()
    for actor in list(renderer.GetActors()):
        renderer.RemoveActor(actor)
    empty = render(renderer)
    assert (empty == empty[0, 0]).all()
    assert statistics(rt)["triangles"] == 0


def test_changed_data_is_seen(render):
    source = scenes.vtkSphereSource()
    renderer = scenes.renderer_of(scenes.actor_of(source))
    scenes.look(renderer, (0, 0, 4))
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    rt.SetBuffers(["triangle"])
    small = (render(renderer) != render(renderer)[0, 0]).any(axis=2).sum()
    source.SetRadius(0.8)
    large = (render(renderer) != render(renderer)[0, 0]).any(axis=2).sum()
    assert large > 2 * small


@pytest.mark.expects_vtk_messages(
    "Visibility", "PrimaryShading", "Accelerator", "ShadowMode", "no buffer"
)
def test_wrong_settings_are_refused():
    rt = vtkHybridRayTracingPass()
    rt.SetVisibility(17)
    assert rt.GetVisibility() == rt.ItemBuffer
    rt.SetPrimaryShading(2)
    assert rt.GetPrimaryShading() == rt.GPU
    rt.SetAccelerator(-1)
    assert rt.GetAccelerator() == rt.Embree
    rt.SetShadowMode(-1)
    assert rt.GetShadowMode() == rt.ShadowMaps
    rt.SetBuffers(["depth", "nonsense"])
    assert list(rt.GetBuffers()) == []
    rt.SetMaximumDepth(-3)
    assert rt.GetMaximumDepth() == 0
    rt.SetMaximumDepth(1000)
    assert rt.GetMaximumDepth() == 32
    rt.SetShadowMapResolution(1)
    assert rt.GetShadowMapResolution() == 16
