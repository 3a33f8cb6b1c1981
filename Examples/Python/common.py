"""What the examples share: actors, writing a window's picture to a file, and finding the scene data."""

import os
import pathlib
import sys

from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonComputationalGeometry import vtkParametricTorus
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkFiltersSources import vtkParametricFunctionSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)


def actor(source, color, specular=0.0, power=25.0, ambient=0.15):
    """A plainly coloured actor of an algorithm's output."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.ScalarVisibilityOff()
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetColor(*color)
    result.GetProperty().SetAmbient(ambient)
    result.GetProperty().SetSpecular(specular)
    result.GetProperty().SetSpecularPower(power)
    return result


def torus(ring_radius, cross_section_radius, resolution):
    """An algorithm that makes a smooth torus; resolution: cells along the ring and across it."""
    shape = vtkParametricTorus()
    shape.SetRingRadius(ring_radius)
    shape.SetCrossSectionRadius(cross_section_radius)
    source = vtkParametricFunctionSource()
    source.SetParametricFunction(shape)
    source.SetUResolution(resolution[0])
    source.SetVResolution(resolution[1])
    # The parametric source closes its mesh with triangles of no area: leave them out.
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(source.GetOutputPort())
    return normals


def window_of(renderer, size=(800, 600)):
    """An off-screen window that shows one renderer."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    return window


def save(window, path):
    """Renders the window and writes its picture as PNG."""
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()
    return path


def save_pixels(pixels, path):
    """Writes an array of colours, uint8 (height, width, 3) with row 0 at the bottom, as PNG."""
    height, width, _ = pixels.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()


def output_path(default):
    """The first argument of the script, else `default` in the current folder."""
    return pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else default)


def scene_data(name):
    """The path of a scene data file as str, or None when the data folder is not there."""
    root = os.environ.get("HRT_DATA_ROOT")
    path = pathlib.Path(root, name) if root else None
    return str(path) if path and path.is_file() else None
