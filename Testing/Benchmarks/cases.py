"""The scenes that are measured, each ready to be drawn frame by frame. bench.py draws them beside VTK's own
renderer, compare.py beside another build; what both need of a scene stands here."""

from measure import model_on_floor, scenes, window_of
from vtkhybrid import statistics, vtkHybridBARTImporter, vtkHybridRayTracingPass
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkRenderingCore import vtkRenderer


class Stage:
    """A window, the pass, and `advance(i)`, which changes the scene before its frame i."""

    def __init__(self, renderer, settings, advance):
        self.renderer = renderer
        self.window = window_of(renderer)
        self.rt = pass_of(settings)
        self.advance = advance

    def close(self):
        self.window.Finalize()


def pass_of(settings):
    """A pass with these settings, by the names of its setters; what is not named has its default."""
    rt = vtkHybridRayTracingPass()
    for name, value in settings.items():
        getattr(rt, "Set" + name)(value)
    return rt


# --- What changes from frame to frame ---------------------------------------------------------------


def move_camera(renderer, _light, i):
    renderer.GetActiveCamera().Azimuth(1.0 if i % 20 < 10 else -1.0)


def move_light(_renderer, light, i):
    light.SetPosition(1 + 0.02 * (i % 10), 3, 2)


def move_nothing(_renderer, _light, _i):
    pass


# --- A model on a floor -----------------------------------------------------------------------------

# name, what it shows, scene keywords, pass settings, what changes from frame to frame
CASES = [
    ("no effects", "camera moves", {}, {"ShadowMode": 0}, move_camera),
    ("one shadow map", "camera moves", {}, {}, move_camera),
    ("one shadow map, direct", "camera moves", {}, {"Visibility": 1}, move_camera),
    ("one shadow map", "light moves", {}, {}, move_light),
    ("one shadow map", "still", {}, {}, move_nothing),
    ("mirror floor", "camera moves", {"mirror": True}, {}, move_camera),
    ("mirror floor", "still", {"mirror": True}, {}, move_nothing),
    ("glass model, mirror floor", "camera moves", {"mirror": True, "glass": True}, {}, move_camera),
]


def on_floor(model, keywords, settings, move):
    renderer, light = model_on_floor(model, **keywords)
    return Stage(renderer, settings, lambda i: move(renderer, light, i))


# --- Many actors ------------------------------------------------------------------------------------


def crowd(side, wireframe, moves):
    """side x side cubes over a floor, each an actor with a mapper and a mesh of its own. As wireframes
    VTK draws them, on top of the traced floor. The one in the middle moves, or none."""
    spacing = 2.0 / side
    cube = vtkCubeSource()
    cube.Update()
    renderer = scenes.renderer_of(scenes.actor_of(scenes.plane(1.6, -0.1), Color=(0.6, 0.6, 0.65)))
    actors = []
    for i in range(side * side):
        mesh = vtkPolyData()
        mesh.ShallowCopy(cube.GetOutput())
        actor = scenes.actor_of(mesh, Color=(0.9, 0.7, 0.5))
        if wireframe:
            actor.GetProperty().SetRepresentationToWireframe()
        actor.SetScale(0.5 * spacing)
        actor.SetPosition(spacing * (i % side + 0.5) - 1, 0, spacing * (i // side + 0.5) - 1)
        renderer.AddActor(actor)
        actors.append(actor)
    renderer.AddLight(scenes.scene_light((1, 3, 2), positional=True, ConeAngle=40.0))
    scenes.look(renderer, (0.3, 1.6, 3.2), (0, 0, 0))
    middle = actors[(side // 2) * side + side // 2]

    def advance(i):
        if moves:
            middle.SetPosition(middle.GetPosition()[0], 0.02 * (i % 5), middle.GetPosition()[2])

    return Stage(renderer, {}, advance)


# --- The robots -------------------------------------------------------------------------------------

def parade(path):
    """The robots' importer and its renderer: without its textures and with one of its lights."""
    importer = vtkHybridBARTImporter()
    importer.SetFileName(path)
    importer.SetTextures(False)
    if not importer.Read():
        raise SystemExit(1)  # the importer has said why
    renderer = vtkRenderer()
    importer.AddTo(renderer)
    for light in list(renderer.GetLights())[1:]:
        renderer.RemoveLight(light)
    return importer, renderer


def robots(path, settings):
    """The parade, every frame a later moment."""
    importer, renderer = parade(path)
    moments = 40
    step = importer.GetNumberOfFrames() // moments
    return Stage(renderer, settings,
                 lambda i: importer.SetTime(importer.GetFrameTime(step * (i % moments))))


def traced_triangles(stage):
    """How many triangles the pass itself drew or traced in the last frame's scene."""
    return statistics(stage.rt)["triangles"]
