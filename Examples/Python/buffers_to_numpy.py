"""What every pixel shows, as numpy arrays: which prop and cell, where, how deep, how lit. Ids refer to
the input data; positions are intersected in double precision.

    ./run python Examples/Python/buffers_to_numpy.py [picture.png]
"""

import numpy as np
from common import output_path, window_of
from vtkhybrid import buffer, vtkHybridRayTracingPass
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer


def actor(source, position=(0, 0, 0)):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    result = vtkActor()
    result.SetMapper(mapper)
    result.SetPosition(*position)
    return result


floor = vtkPlaneSource()
floor.SetOrigin(-3, 0, -3)
floor.SetPoint1(-3, 0, 3)
floor.SetPoint2(3, 0, -3)
ball = vtkSphereSource()
ball.SetRadius(0.7)
ball.SetThetaResolution(48)
ball.SetPhiResolution(48)

renderer = vtkRenderer()
renderer.AddActor(actor(floor))
renderer.AddActor(actor(ball, (0.8, 0.7, 0.3)))
renderer.AddActor(actor(vtkCubeSource(), (-0.9, 0.5, 0)))
lamp = vtkLight()
lamp.SetLightTypeToSceneLight()
lamp.SetPosition(3, 5, 2)
renderer.AddLight(lamp)
renderer.GetActiveCamera().SetPosition(1.5, 3, 6)
renderer.GetActiveCamera().SetFocalPoint(0, 0.4, 0)
renderer.ResetCameraClippingRange()

rt = vtkHybridRayTracingPass()
rt.SetBuffers(["prop", "cell", "position", "normal", "depth", "shadow"])
renderer.SetPass(rt)
window = window_of(renderer, (400, 300))
window.SetMultiSamples(0)
window.Render()

prop, cell, depth = buffer(rt, "prop"), buffer(rt, "cell"), buffer(rt, "depth")
shadow = buffer(rt, "shadow")[..., None] if buffer(rt, "shadow").ndim == 2 else buffer(rt, "shadow")
hit = prop >= 0
print(f"{hit.mean():.1%} of the pixels show a surface, between depth {np.nanmin(depth):.3f}"
      f" and {np.nanmax(depth):.3f}")
for k in range(3):
    seen = prop == k
    print(f"  prop {k}: {rt.GetPropFromId(k).GetClassName()}, {seen.sum():6d} pixels,"
          f" {len(np.unique(cell[seen])):5d} cells, {np.mean(shadow[seen] == 0):.0%} in shadow")

# Four of them side by side as a picture: depth, normal, cell, shadow.
grey = (np.nan_to_num(np.nanmax(depth) - depth) / np.nanmax(depth - np.nanmin(depth)))[..., None]
colors = np.stack([(cell * k % 211 + 40) / 255 for k in (37, 101, 149)], axis=-1) * hit[..., None]
panels = [
    grey.repeat(3, axis=2).clip(0, 1),
    np.nan_to_num(buffer(rt, "normal") * 0.5 + 0.5),
    colors,
    np.nan_to_num(shadow[..., :1]).repeat(3, axis=2),
]
top, bottom = np.hstack(panels[:2]), np.hstack(panels[2:])
sheet = (np.vstack([bottom, top]) * 255).astype(np.uint8)
image = vtkImageData()
image.SetDimensions(sheet.shape[1], sheet.shape[0], 1)
image.GetPointData().SetScalars(numpy_to_vtk(sheet.reshape(-1, 3), deep=True))
path = output_path("buffers_to_numpy.png")
writer = vtkPNGWriter()
writer.SetFileName(str(path))
writer.SetInputData(image)
writer.Write()
print("wrote", path)
