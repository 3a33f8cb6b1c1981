"""The two lines: an ordinary VTK script, and what it takes to give it shadows.

    ./run python Examples/Python/two_lines.py [picture.png]
"""

from common import output_path, save, window_of
from vtkhybrid import vtkHybridRayTracingPass  # 1
from vtkmodules.vtkFiltersSources import vtkConeSource, vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer


def actor(source, color):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetColor(*color)
    result.GetProperty().SetAmbient(0.2)
    return result


floor = vtkPlaneSource()
floor.SetOrigin(-3, 0, -3)
floor.SetPoint1(-3, 0, 3)
floor.SetPoint2(3, 0, -3)
ball = vtkSphereSource()
ball.SetCenter(0.9, 0.6, 0.2)
ball.SetRadius(0.6)
ball.SetThetaResolution(64)
ball.SetPhiResolution(64)
cone = vtkConeSource()
cone.SetCenter(-0.7, 0.75, 0)
cone.SetDirection(0, 1, 0)
cone.SetHeight(1.5)
cone.SetResolution(64)

renderer = vtkRenderer()
renderer.SetBackground(0.75, 0.82, 0.9)
renderer.AddActor(actor(floor, (0.8, 0.8, 0.78)))
renderer.AddActor(actor(ball, (0.85, 0.35, 0.25)))
renderer.AddActor(actor(cone, (0.25, 0.5, 0.8)))

light = vtkLight()
light.SetLightTypeToSceneLight()
light.SetPosition(3, 5, 2)
renderer.AddLight(light)
camera = renderer.GetActiveCamera()
camera.SetPosition(1.5, 3, 6)
camera.SetFocalPoint(0, 0.5, 0)
renderer.ResetCameraClippingRange()

renderer.SetPass(vtkHybridRayTracingPass())  # 2

print("wrote", save(window_of(renderer), output_path("two_lines.png")))
