"""A scalar-coloured data set with shadows: isosurfaces of a wave field, coloured by height through a
lookup table, with scalar bar and outline, which VTK draws as always.

    ./run python Examples/Python/scalar_shadows.py [picture.png]
"""

from common import output_path, save, window_of
from vtkhybrid import vtkHybridRayTracingPass
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkElevationFilter
from vtkmodules.vtkFiltersModeling import vtkOutlineFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer

wavelet = vtkRTAnalyticSource()
wavelet.SetWholeExtent(-20, 20, -20, 20, -20, 20)
contour = vtkContourFilter()
contour.SetInputConnection(wavelet.GetOutputPort())
contour.GenerateValues(2, 140, 190)
height = vtkElevationFilter()
height.SetInputConnection(contour.GetOutputPort())
height.SetLowPoint(0, -18, 0)
height.SetHighPoint(0, 18, 0)

table = vtkLookupTable()
table.SetHueRange(0.66, 0.0)
table.SetSaturationRange(0.8, 0.8)
table.Build()
mapper = vtkPolyDataMapper()
mapper.SetInputConnection(height.GetOutputPort())
mapper.SetLookupTable(table)
mapper.SetScalarRange(0, 1)
surface = vtkActor()
surface.SetMapper(mapper)
surface.GetProperty().SetAmbient(0.3)

ground = vtkPlaneSource()
ground.SetOrigin(-40, -20, -40)
ground.SetPoint1(-40, -20, 40)
ground.SetPoint2(40, -20, -40)
ground_mapper = vtkPolyDataMapper()
ground_mapper.SetInputConnection(ground.GetOutputPort())
floor = vtkActor()
floor.SetMapper(ground_mapper)
floor.GetProperty().SetColor(0.85, 0.85, 0.85)
floor.GetProperty().SetAmbient(0.3)

outline = vtkOutlineFilter()
outline.SetInputConnection(wavelet.GetOutputPort())
outline_mapper = vtkPolyDataMapper()
outline_mapper.SetInputConnection(outline.GetOutputPort())
frame = vtkActor()
frame.SetMapper(outline_mapper)
frame.GetProperty().SetColor(0.1, 0.1, 0.1)

bar = vtkScalarBarActor()
bar.SetLookupTable(table)
bar.SetTitle("height")
bar.SetNumberOfLabels(3)
bar.SetUnconstrainedFontSize(True)
for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
    text.SetFontSize(16)
    text.SetColor(0.1, 0.1, 0.1)
    text.ShadowOff()
    text.ItalicOff()

renderer = vtkRenderer()
renderer.SetBackground(0.72, 0.76, 0.82)
for prop in (surface, floor, frame, bar):
    renderer.AddViewProp(prop)
sun = vtkLight()
sun.SetLightTypeToSceneLight()
sun.SetPosition(30, 60, 25)
renderer.AddLight(sun)
camera = renderer.GetActiveCamera()
camera.SetPosition(58, 62, 104)
camera.SetFocalPoint(3, -4, 0)
renderer.ResetCameraClippingRange()

renderer.SetPass(vtkHybridRayTracingPass())

print("wrote", save(window_of(renderer), output_path("scalar_shadows.png")))
