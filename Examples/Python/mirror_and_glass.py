"""A mirror floor and glass: both are asked for per actor, all else follows the actors' properties.

    ./run python Examples/Python/mirror_and_glass.py [picture.png]
"""

from common import actor, output_path, save, torus, window_of
from vtkhybrid import statistics, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer

plane = vtkPlaneSource()
plane.SetOrigin(-6, 0, -6)
plane.SetPoint1(-6, 0, 6)
plane.SetPoint2(6, 0, -6)
floor = actor(plane, (0.55, 0.6, 0.65), ambient=0.12)
vtkHybridMaterial.SetReflectance(floor, 0.45)

sphere = vtkSphereSource()
sphere.SetRadius(0.8)
sphere.SetThetaResolution(200)
sphere.SetPhiResolution(200)
glass = actor(sphere, (1, 1, 1), specular=0.6, power=80, ambient=0.12)
glass.SetPosition(1.1, 0.8, 0.9)
vtkHybridMaterial.SetGlass(glass, 1.5)

mesh = torus(0.8, 0.3, resolution=(120, 60))
ring = actor(mesh, (0.9, 0.55, 0.15), specular=0.4, power=30, ambient=0.12)
ring.RotateX(55)
ring.RotateY(20)
ring.SetPosition(-0.8, 1.0, -0.4)

renderer = vtkRenderer()
renderer.SetBackground(0.85, 0.88, 0.92)
renderer.SetBackground2(0.25, 0.4, 0.65)
renderer.GradientBackgroundOn()
for part in (floor, glass, ring):
    renderer.AddActor(part)
lamp = vtkLight()
lamp.SetLightTypeToSceneLight()
lamp.PositionalOn()
lamp.SetPosition(2, 6, 4)
lamp.SetFocalPoint(0, 0.5, 0)
lamp.SetConeAngle(45)
renderer.AddLight(lamp)
camera = renderer.GetActiveCamera()
camera.SetPosition(0.5, 2.4, 6.5)
camera.SetFocalPoint(0.1, 0.8, 0)
renderer.ResetCameraClippingRange()

rt = vtkHybridRayTracingPass()
renderer.SetPass(rt)

print("wrote", save(window_of(renderer), output_path("mirror_and_glass.png")))
for name, rays in statistics(rt)["rays"].items():
    print(f"  {name:10s} rays: {rays['traced']:8,d} traced, {rays['answered']:8,d} answered without")
