"""Pipelined frames: one frame late while a scene is animated, never anything that is gone, and the
finished picture as soon as nothing changes. Every picture is compared, byte by byte, with one that was
rendered at once."""

import gc

import numpy as np
import pytest
import scenes
from vtkhybrid import statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkFiltersSources import vtkLineSource
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkTextActor,
    vtkWindowToImageFilter,
)

SHADINGS = {
    "hybrid": lambda rt: None,
    "CPU ray caster": lambda rt: rt.SetPrimaryShadingToCPU(),
    "shadow rays": lambda rt: rt.SetShadowModeToExact(),
    "kd-tree": lambda rt: rt.SetAcceleratorToKdTree(),
    "direct rendering": lambda rt: rt.SetVisibilityToDirectRendering(),
}
INTERACTIVE, STILL = 15.0, 0.0001


class Show:
    """A small moving scene with a mirror in a window of its own."""

    def __init__(self, choose=lambda rt: None, pipelined=True):
        floor = scenes.actor_of(scenes.plane(3.0, -0.6), Color=(0.7, 0.7, 0.8), Ambient=0.1)
        vtkHybridMaterial.SetReflectance(floor, 0.5)
        self.floor = floor
        self.mover = scenes.actor_of(scenes.torus(), Color=(0.9, 0.6, 0.3), Specular=0.3)
        self.renderer = scenes.renderer_of(floor, self.mover)
        self.light = scenes.scene_light((1, 3, 2), positional=True, ConeAngle=40.0)
        self.renderer.AddLight(self.light)
        scenes.look(self.renderer, (0, 2, 5))
        self.rt = vtkHybridRayTracingPass()
        choose(self.rt)
        self.rt.SetPipelined(1 if pipelined else 0)
        self.renderer.SetPass(self.rt)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(160, 120)
        self.window.AddRenderer(self.renderer)

    def animate(self, on=True):
        self.window.SetDesiredUpdateRate(INTERACTIVE if on else STILL)

    def step(self, k):
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(np.sin(0.2 * k) * 5, 2, np.cos(0.2 * k) * 5)
        self.mover.SetOrientation(0, 9.0 * k, 4.0 * k)
        self.light.SetIntensity(1.0 - 0.05 * k)
        self.renderer.ResetCameraClippingRange(-4, 4, -1, 4, -4, 4)

    def picture(self):
        self.window.Render()
        return self.pixels()

    def pixels(self):
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.ShouldRerenderOff()
        grab.Update()
        from vtkmodules.util.numpy_support import vtk_to_numpy

        return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).copy()

    def pipelined(self):
        return statistics(self.rt)["pipelined"]

    def close(self):
        self.window.Finalize()


@pytest.fixture
def show():
    shows = []

    def make(*arguments, **keywords):
        shows.append(Show(*arguments, **keywords))
        return shows[-1]

    yield make
    for each in shows:
        each.close()


@pytest.mark.parametrize("shading", SHADINGS)
def test_an_animation_is_one_frame_late(shading, show):
    truth = show(SHADINGS[shading], pipelined=False)
    late = show(SHADINGS[shading])
    expected, shown = [], []
    for k in range(6):
        for each in (truth, late):
            each.step(k)
            each.animate(k > 0)
        expected.append(truth.picture())
        shown.append(late.picture())
        assert late.pipelined()["ran"] == (k > 0), late.pipelined()
        assert not truth.pipelined()["ran"]
    assert all((a != b).any() for a, b in zip(expected, expected[1:]))
    assert (shown[0] == expected[0]).all()
    for k in range(1, 6):
        assert (shown[k] == expected[k - 1]).all(), f"frame {k}"
    # Rendered once more, nothing changed: the last frame is finished. Then it only is blitted.
    assert (late.picture() == expected[5]).all()
    assert late.pipelined()["reason"] == "nothing changed: the frame is finished"
    assert not statistics(late.rt)["stages"]["visibility"]["ran"]
    assert (late.picture() == expected[5]).all()
    ran = {name for name, stage in statistics(late.rt)["stages"].items() if stage["ran"]}
    assert ran == {"blit"}


def test_every_ray_of_an_animation_is_counted_once(show):
    truth, late = show(pipelined=False), show()
    totals = [0, 0]
    for k in range(5):
        for i, each in enumerate((truth, late)):
            each.step(k)
            each.animate(k > 0)
            each.picture()
            totals[i] += statistics(each.rt)["rays"]["reflection"]["traced"]
    late.picture()
    totals[1] += statistics(late.rt)["rays"]["reflection"]["traced"]
    assert totals[0] == totals[1] > 0


def test_the_still_frame_after_an_interaction_is_the_current_one(show):
    truth, late = show(pipelined=False), show()
    for k in range(4):
        truth.step(k)
        late.step(k)
        late.animate(0 < k < 3)
        shown = late.picture()
    assert (shown == truth.picture()).all()


def test_a_screenshot_shows_the_current_frame(show):
    truth, late = show(pipelined=False), show()
    late.animate()
    for k in range(4):
        truth.step(k)
        late.step(k)
        late.window.Render()
    assert late.pipelined()["ran"]
    grab = vtkWindowToImageFilter()
    grab.SetInput(late.window)
    grab.ReadFrontBufferOff()
    grab.Update()
    assert (late.pixels() == truth.picture()).all()


def line_actor():
    source = vtkLineSource()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    line = vtkActor()
    line.SetMapper(mapper)
    return line


def other_renderer(show):
    other = vtkRenderer()
    other.SetActiveCamera(show.renderer.GetActiveCamera())
    other.SetLayer(1)
    show.window.SetNumberOfLayers(2)
    show.window.AddRenderer(other)


FORBID = {
    "no interactive update rate is asked for": lambda s: s.animate(False),
    "VTK draws props into this frame": lambda s: s.renderer.AddActor(line_actor()),
    "another renderer shows the same view": other_renderer,
    "buffers of this frame are wanted": lambda s: s.rt.SetBuffers(["depth"]),
    "pipelining is off": lambda s: s.rt.PipelinedOff(),
    "primary rays are traced at once": lambda s: s.rt.SetVisibilityToRayCasting(),
    "no rays are traced": lambda s: s.rt.ReflectionsOff(),
}


@pytest.mark.parametrize("reason", FORBID)
def test_what_forbids_pipelining(reason, show):
    truth, late = show(pipelined=False), show()
    for k in range(5):
        for each in (truth, late):
            each.step(k)
            if k == 2:
                FORBID[reason](each)
            elif k == 0:
                each.animate()
        expected, shown = truth.picture(), late.picture()
        if k >= 3:
            assert late.pipelined() == {"ran": False, "reason": reason}
        if k >= 2:
            assert (shown == expected).all()


def test_a_title_does_not_forbid_it(show):
    late = show()
    title = vtkTextActor()
    title.SetInput("title")
    late.renderer.AddActor(title)
    late.animate()
    for k in range(3):
        late.step(k)
        late.picture()
    assert late.pipelined()["ran"]


@pytest.mark.parametrize("change", ["removed", "hidden", "added", "changed"])
def test_nothing_stale_is_shown(change, show):
    truth, late = show(pipelined=False), show()
    extra = {}
    for each in (truth, late):
        extra[each] = scenes.actor_of(scenes.superquadric(), Color=(0.1, 0.9, 0.2))
        extra[each].SetPosition(0.5, 0.2, 1.0)
        if change != "added":
            each.renderer.AddActor(extra[each])
    late.animate()
    for k in range(5):
        for each in (truth, late):
            each.step(k)
            if k == 3:
                {
                    "removed": lambda: each.renderer.RemoveActor(extra[each]),
                    "hidden": lambda: extra[each].VisibilityOff(),
                    "added": lambda: each.renderer.AddActor(extra[each]),
                    "changed": lambda: extra[each].SetMapper(
                        scenes.actor_of(scenes.plane(1.0)).GetMapper()
                    ),
                }[change]()
        expected, shown = truth.picture(), late.picture()
        if k == 3:
            assert late.pipelined() == {"ran": False, "reason": "what is gone must not be shown"}
            assert (shown == expected).all()
    assert late.pipelined()["ran"]


def test_a_resized_window_shows_the_current_frame(show):
    truth, late = show(pipelined=False), show()
    late.animate()
    for k, size in enumerate([(160, 120), (160, 120), (200, 90), (200, 90), (60, 60)]):
        for each in (truth, late):
            each.step(k)
            each.window.SetSize(*size)
        expected, shown = truth.picture(), late.picture()
        assert late.pipelined()["ran"] == (k in (1, 3))
        if k in (2, 4):
            assert (shown == expected).all()


@pytest.mark.parametrize("end", ["window closed", "pass replaced", "resources released", "deleted"])
def test_ending_in_the_middle_of_a_frame(end, show):
    late = show(SHADINGS["shadow rays"])
    late.window.SetSize(400, 300)
    late.animate()
    for k in range(3):
        late.step(k)
        late.window.Render()
    assert late.pipelined()["ran"]
    if end == "window closed":
        late.window.Finalize()
        assert late.rt.GetNumberOfOpenGLObjects() == 0
    elif end == "pass replaced":
        late.renderer.SetPass(None)
        late.window.Render()
        late.renderer.SetPass(late.rt)
        late.window.Render()
    elif end == "resources released":
        late.rt.ReleaseGraphicsResources(late.window)
        assert late.rt.GetNumberOfOpenGLObjects() == 0
        late.step(4)
        late.window.Render()
    else:
        late.renderer.SetPass(None)
        late.rt = None
        gc.collect()
        late.window.Render()


def test_off_by_default_on_software_opengl(show):
    late = show()
    late.rt.SetPipelinedToAutomatic()
    assert late.rt.GetPipelined() == 2
    late.animate()
    for k in range(3):
        late.step(k)
        late.picture()
    software = any(
        word in late.window.ReportCapabilities() for word in ("llvmpipe", "softpipe", "SWR")
    )
    assert late.pipelined()["ran"] != software


@pytest.mark.expects_vtk_messages("SetPipelined: 3 is none of")
def test_a_wrong_value_is_refused(show):
    rt = vtkHybridRayTracingPass()
    rt.PipelinedOn()
    rt.SetPipelined(3)
    assert rt.GetPipelined() == 1
    assert "Pipelined: InAnimations" in str(rt)
