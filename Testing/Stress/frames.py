"""Ten thousand frames of one pass while everything about them changes at random: camera, window size, actors
that come, go, hide and move, lights, materials, settings, and the rate that decides on pipelining. No
error may be reported, neither GL objects nor host memory may grow, and every hundredth picture must be,
byte for byte, that of a new pass in a new window.

    ./run python Testing/Stress/frames.py [--frames N] [--seed S]

`./run stress` runs it at full length, ctest a shorter one.
"""

import argparse
import ctypes
import gc
import os
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "Python"))

import numpy as np  # noqa: E402
import scenes  # noqa: E402
from vtkhybrid import statistics, vtkHybridMaterial, vtkHybridRayTracingPass  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow  # noqa: E402
from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkWindowToImageFilter  # noqa: E402

COMPARE_EVERY = 100
EVERYTHING = (0, 2**31 - 1, 0, 2**31 - 1)
# Settings and the values that are drawn from; small maps, so that a frame is short.
SETTINGS = {
    "Visibility": (0, 0, 0, 1, 2),
    "PrimaryShading": (0, 0, 1),
    "Accelerator": (0, 1),
    "ShadowMode": (0, 1, 1, 2),
    "ShadowMapResolution": (64, 256),
    "Reflections": (False, True, True),
    "Refractions": (False, True),
    "MaximumDepth": (0, 1, 3),
    "Multisampling": (0, 1, 1, 2, 3, 4, 5),
    "Interleave": (1, 1, 2, 3),
    "InterleaveErrorControl": (False, True),
    "Pipelined": (0, 1, 1, 1),
    "PixelBounds": (EVERYTHING, EVERYTHING, (20, 120, 10, 90), (0, 60, 0, 999), (70, 90, -5, 300),
                    (230, 300, 0, 9)),
}


class World:
    """A pass, its window and its scene, and what can happen to them."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.meshes = [scenes.torus(256), scenes.superquadric(12), scenes.plane(0.8)]
        floor = scenes.actor_of(scenes.plane(3.0, -0.6), Color=(0.7, 0.7, 0.8), Ambient=0.1)
        vtkHybridMaterial.SetReflectance(floor, 0.5)
        self.renderer = scenes.renderer_of(floor)
        self.actors = []
        self.lights = [scenes.scene_light((1, 3, 2), positional=True, ConeAngle=40.0),
                       scenes.scene_light((-2, 3, 1), Intensity=0.4)]
        for light in self.lights:
            self.renderer.AddLight(light)
        self.settings = {name: None for name in SETTINGS}
        self.rt = vtkHybridRayTracingPass()
        self.window = self.window_for(self.renderer, (160, 120))
        for name in SETTINGS:
            self.set(name, getattr(self.rt, "Get" + name)())
        self.set("ShadowMapResolution", 256)
        self.renderer.SetPass(self.rt)
        self.look()

    @staticmethod
    def window_for(renderer, size):
        window = vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(*size)
        window.AddRenderer(renderer)
        return window

    def set(self, name, value):
        self.settings[name] = value
        getattr(self.rt, "Set" + name)(value)

    def look(self):
        angle, height = self.random.uniform(0, 6.3), self.random.uniform(0.3, 3.0)
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(4.5 * np.sin(angle), height, 4.5 * np.cos(angle))
        camera.SetFocalPoint(0, 0, 0)
        camera.SetViewAngle(self.random.choice((20, 30, 50)))
        self.renderer.ResetCameraClippingRange(-4, 4, -1, 4, -4, 4)

    def turn(self):
        self.renderer.GetActiveCamera().Azimuth(self.random.uniform(-4, 4))

    def resize(self):
        self.window.SetSize(self.random.randint(1, 220), self.random.randint(1, 160))

    def add(self):
        color = tuple(self.random.random() for _ in range(3))
        actor = scenes.actor_of(self.random.choice(self.meshes), Color=color, Specular=0.3)
        kind = self.random.random()
        if kind < 0.2:
            vtkHybridMaterial.SetReflectance(actor, 0.6)
        elif kind < 0.4:
            vtkHybridMaterial.SetGlass(actor, 1.5)
        elif kind < 0.43:
            actor.GetProperty().SetOpacity(0.5)
        actor.SetScale(self.random.uniform(0.3, 0.8))
        actor.SetPosition(*(self.random.uniform(-1.2, 1.2) for _ in range(3)))
        self.actors.append(actor)
        self.renderer.AddActor(actor)

    def remove(self):
        if self.actors:
            self.renderer.RemoveActor(self.actors.pop(self.random.randrange(len(self.actors))))

    def hide(self):
        if self.actors:
            actor = self.random.choice(self.actors)
            actor.SetVisibility(not actor.GetVisibility())

    def move(self):
        for actor in self.actors:
            actor.RotateWXYZ(self.random.uniform(-9, 9), 0.3, 1, 0.2)

    def light(self):
        light = self.random.choice(self.lights)
        light.SetPosition(*(self.random.uniform(-2, 2) + offset for offset in (0, 3, 1)))

    def dim(self):
        self.random.choice(self.lights).SetIntensity(self.random.uniform(0.2, 1.0))

    def switch(self):
        name = self.random.choice(list(SETTINGS))
        self.set(name, self.random.choice(SETTINGS[name]))

    def rate(self):
        self.window.SetDesiredUpdateRate(self.random.choice((15.0, 15.0, 0.0001)))

    def release(self):
        self.rt.ReleaseGraphicsResources(self.window)

    def disturb(self):
        for _ in range(self.random.randint(0, 3)):
            crowd = len(self.actors)
            deed = self.random.choices(
                (self.turn, self.move, self.look, self.resize, self.add, self.remove, self.hide,
                 self.light, self.dim, self.switch, self.rate, self.release),
                (30, 15, 3, 3, 4 if crowd < 6 else 0, 4 if crowd else 0, 3, 4, 4, 8, 4, 0.3))[0]
            deed()

    def pixels(self, window):
        grab = vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        grab.ShouldRerenderOff()
        grab.Update()
        return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).copy()

    def stale_pixels(self):
        """How many pixels of the finished frame differ from those of a new pass in a new window."""
        self.window.Render()  # nothing changed: what was pipelined is finished
        shown = self.pixels(self.window)
        size = self.window.GetSize()
        self.renderer.SetPass(None)
        self.window.RemoveRenderer(self.renderer)
        fresh = vtkHybridRayTracingPass()
        for name, value in self.settings.items():
            getattr(fresh, "Set" + name)(value)
        window = self.window_for(self.renderer, size)
        self.renderer.SetPass(fresh)
        window.Render()
        expected = self.pixels(window)
        self.renderer.SetPass(None)
        window.RemoveRenderer(self.renderer)
        window.Finalize()
        self.window.AddRenderer(self.renderer)
        self.renderer.SetPass(self.rt)
        return int((shown != expected).any(axis=1).sum()), len(shown)


def resident():
    """Bytes of this process in memory, what the allocator could give back left out."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(pathlib.Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def run(frames, seed):
    """Returns a list of what went wrong, and prints the figures."""
    wrong = []
    output = vtkOutputWindow.GetInstance()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # what is said is collected

    def note(_window, event, text):
        if "Multisampling has no effect" not in text:  # said once a change of the settings
            wrong.append(f"{event}: {text.strip()}")

    note.CallDataType = "string0"
    tags = [output.AddObserver(event, note) for event in ("ErrorEvent", "WarningEvent")]
    world = World(seed)
    pipelined = compared = 0
    most_objects = 0
    memory = []
    for i in range(frames):
        world.disturb()
        world.window.Render()
        report = statistics(world.rt)
        pipelined += bool(report) and report["pipelined"]["ran"]
        most_objects = max(most_objects, world.rt.GetNumberOfOpenGLObjects())
        if (i + 1) % COMPARE_EVERY == 0:
            differ, pixels = world.stale_pixels()
            compared += 1
            if differ:
                wrong.append(f"frame {i}: {differ} of {pixels} pixels are not those of a new pass;"
                             f" {world.settings}")
        if (i + 1) % max(frames // 4, 1) == 0:
            memory.append(resident())
    growth = (memory[-1] - memory[-2]) / max(frames // 4, 1)
    print(f"{frames} frames, seed {seed}: {pipelined} pipelined, {compared} compared with a new pass,"
          f" at most {most_objects} GL objects, MiB after each quarter"
          f" {', '.join(f'{m / 2**20:.1f}' for m in memory)}: {growth:.0f} bytes a frame at last")
    world.rt.ReleaseGraphicsResources(world.window)
    if world.rt.GetNumberOfOpenGLObjects():
        wrong.append("GL objects are left after ReleaseGraphicsResources")
    world.window.Finalize()
    for tag in tags:
        output.RemoveObserver(tag)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    intensity = float(os.environ.get("HRT_STRESS_INTENSITY", "1"))
    parser.add_argument("--frames", type=int, default=max(int(10000 * intensity), 1))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    wrong = run(options.frames, options.seed)
    for message in wrong[:20]:
        print(message)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
