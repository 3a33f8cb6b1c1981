"""The scenes that several tests share, each a function that returns a vtkRenderer. Together they cover
the kinds of colours, normals, lights, cameras and matrices that VTK's polydata mapper knows."""

import math

import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text in one scene)
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkLookupTable, vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray,
    vtkImageData,
    vtkMultiBlockDataSet,
    vtkPlane,
    vtkPolyData,
)
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersCore import (
    vtkAppendFilter,
    vtkElevationFilter,
    vtkPolyDataNormals,
    vtkStripper,
    vtkTriangleFilter,
)
from vtkmodules.vtkFiltersSources import (
    vtkConeSource,
    vtkCubeSource,
    vtkCylinderSource,
    vtkPlaneSource,
    vtkSphereSource,
    vtkSuperquadricSource,
)
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkAssembly,
    vtkCompositeDataDisplayAttributes,
    vtkDataSetMapper,
    vtkGlyph3DMapper,
    vtkLight,
    vtkPolyDataMapper,
    vtkProperty,
    vtkRenderer,
)

if (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) >= (9, 3):
    from vtkmodules.vtkRenderingCore import vtkCompositePolyDataMapper
else:  # the class of that name draws its blocks by one mapper each
    from vtkmodules.vtkRenderingOpenGL2 import (
        vtkCompositePolyDataMapper2 as vtkCompositePolyDataMapper,
    )


def actor_of(source, **properties):
    """An actor of an algorithm or a vtkPolyData; keyword arguments are vtkProperty setters."""
    mapper = vtkPolyDataMapper()
    if isinstance(source, vtkPolyData):
        mapper.SetInputData(source)
    else:
        mapper.SetInputConnection(source.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    for name, value in properties.items():
        getattr(actor.GetProperty(), "Set" + name)(*(value if isinstance(value, tuple) else (value,)))
    return actor


def renderer_of(*actors, background=(0.2, 0.3, 0.4)):
    renderer = vtkRenderer()
    renderer.SetBackground(*background)
    for actor in actors:
        renderer.AddViewProp(actor)
    return renderer


def look(renderer, position, focal_point=(0, 0, 0), up=(0, 1, 0), angle=30):
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*position)
    camera.SetFocalPoint(*focal_point)
    camera.SetViewUp(*up)
    camera.SetViewAngle(angle)
    renderer.ResetCameraClippingRange()
    return renderer


def scene_light(position, focal_point=(0, 0, 0), positional=False, **settings):
    light = vtkLight()
    light.SetLightTypeToSceneLight()
    light.SetPosition(*position)
    light.SetFocalPoint(*focal_point)
    light.SetPositional(positional)
    for name, value in settings.items():
        getattr(light, "Set" + name)(*(value if isinstance(value, tuple) else (value,)))
    return light


def superquadric(resolution=64, centre=(0, 0, 0)):
    """A rounded box with point normals, without the source's triangles of no area at the poles."""
    source = vtkSuperquadricSource()
    source.SetThetaResolution(resolution)
    source.SetPhiResolution(resolution)
    source.SetPhiRoundness(0.5)
    source.SetCenter(*centre)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(source.GetOutputPort())
    return without_degenerate(triangles)


def without_degenerate(algorithm):
    """The triangles of an algorithm's output that have an area, with their points as they are."""
    algorithm.Update()
    data = vtkPolyData()
    data.ShallowCopy(algorithm.GetOutput())
    cells = vtkCellArray()
    for i in range(data.GetNumberOfCells()):
        triangle = data.GetCell(i)
        if triangle.ComputeArea() > 0.0:
            cells.InsertNextCell(triangle.GetPointIds())
    data.SetPolys(cells)
    data.SetStrips(None)
    return data


def torus(triangles=1024):
    """The paper's torus: a closed mesh of exactly `triangles` triangles (2 n m of an n x m grid)."""
    around = int(math.sqrt(triangles))
    along = triangles // (2 * around)
    points = vtkPoints()
    normals = vtkFloatArray()
    normals.SetName("Normals")
    normals.SetNumberOfComponents(3)
    for i in range(around):
        a = 2 * math.pi * i / around
        for j in range(along):
            b = 2 * math.pi * j / along
            r = 1.0 + 0.4 * math.cos(b)
            points.InsertNextPoint(r * math.cos(a), r * math.sin(a), 0.4 * math.sin(b))
            normals.InsertNextTuple3(
                math.cos(b) * math.cos(a), math.cos(b) * math.sin(a), math.sin(b)
            )
    cells = vtkCellArray()
    for i in range(around):
        for j in range(along):
            p = [
                (i % around) * along + j % along,
                ((i + 1) % around) * along + j % along,
                ((i + 1) % around) * along + (j + 1) % along,
                (i % around) * along + (j + 1) % along,
            ]
            for triangle in ((p[0], p[1], p[2]), (p[0], p[2], p[3])):
                cells.InsertNextCell(3, triangle)
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    data.GetPointData().SetNormals(normals)
    return data


def bunny(path):
    """The Stanford bunny with point normals, 69,451 triangles, as an algorithm."""
    reader = vtkPLYReader()
    reader.SetFileName(path)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(reader.GetOutputPort())
    normals.SplittingOff()
    normals.ConsistencyOff()
    return normals


# -- parity scenes: each returns a renderer without mirror or glass ------------------------------


def default_headlight():
    """No light given: VTK makes one headlight; specular highlight from point normals."""
    actor = actor_of(superquadric(), Color=(0.9, 0.5, 0.2), Specular=0.4, SpecularPower=20.0)
    return look(renderer_of(actor), (1.5, 1.2, 2.0))


def directional_lights():
    """Two directional scene lights of different colours, a third one switched off."""
    actor = actor_of(torus(), Ambient=0.1, Specular=0.5, SpecularPower=15.0, SpecularColor=(1, 1, 0.5))
    renderer = renderer_of(actor)
    renderer.AddLight(scene_light((1, 2, 3), Color=(1.0, 0.8, 0.6), Intensity=0.7))
    renderer.AddLight(scene_light((0, 5, 0), Color=(1, 0, 0), Switch=0))
    renderer.AddLight(scene_light((-3, 1, 1), Color=(0.3, 0.4, 1.0)))
    return look(renderer, (2, 2, 5))


def camera_lights():
    """Lights that move with the camera, in the way of vtkLightKit."""
    renderer = renderer_of(actor_of(superquadric(), Specular=0.3, SpecularPower=8.0))
    for position in ((0.3, 0.5, 1.0), (-0.8, 0.1, 0.4)):
        light = scene_light(position, Intensity=0.6)
        light.SetLightTypeToCameraLight()
        renderer.AddLight(light)
    return look(renderer, (-1.5, 1.0, 2.0))


def point_light():
    """A positional light with distance attenuation beside a headlight."""
    renderer = renderer_of(
        actor_of(torus(), Color=(0.5, 0.8, 0.5), Specular=0.6, SpecularPower=40.0),
        actor_of(plane(3.0, -1.0), Color=(0.8, 0.8, 0.9)),
    )
    renderer.AddLight(
        scene_light((1.0, 1.5, 1.5), positional=True, ConeAngle=180.0, AttenuationValues=(0.5, 0.2, 0.1))
    )
    headlight = vtkLight()
    headlight.SetLightTypeToHeadlight()
    headlight.SetIntensity(0.3)
    renderer.AddLight(headlight)
    return look(renderer, (2, 2, 5))


def spot_light():
    """A spot light with cone and exponent whose edge crosses the picture."""
    renderer = renderer_of(actor_of(plane(2.0, -0.6, 40)), actor_of(superquadric()))
    renderer.AddLight(
        scene_light((1, 3, 2), positional=True, ConeAngle=18.0, Exponent=4.0, Color=(1, 1, 0.8))
    )
    return look(renderer, (0, 2, 4))


def plane(size=2.0, height=0.0, resolution=1):
    """A horizontal square around the y axis, facing up."""
    source = vtkPlaneSource()
    source.SetOrigin(-size, height, -size)
    source.SetPoint1(-size, height, size)
    source.SetPoint2(size, height, -size)
    source.SetResolution(resolution, resolution)
    return source


def flat_shading():
    """Flat interpolation: facets, in spite of point normals; a cylinder with polygons of many sides."""
    cylinder = vtkCylinderSource()
    cylinder.SetResolution(17)
    renderer = renderer_of(actor_of(cylinder, Interpolation=0, Color=(0.3, 0.6, 0.9), Specular=0.3))
    renderer.AddLight(scene_light((1, 2, 3)))
    return look(renderer, (1, 2, 2))


def cell_normals():
    """Normals given per cell and none per point."""
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(20)
    sphere.SetPhiResolution(20)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(sphere.GetOutputPort())
    normals.ComputeCellNormalsOn()
    normals.ComputePointNormalsOff()
    normals.Update()
    data = normals.GetOutput()
    data.GetPointData().SetNormals(None)
    return look(renderer_of(actor_of(data, Color=(1, 0.8, 0.8), Specular=0.2)), (0.8, 0.9, 1.8))


def no_normals():
    """Neither point nor cell normals; an open surface seen from both sides with a backface property."""
    source = vtkCylinderSource()
    source.CappingOff()
    source.SetResolution(24)
    source.Update()
    data = vtkPolyData()
    data.DeepCopy(source.GetOutput())
    data.GetPointData().SetNormals(None)
    actor = actor_of(data, Color=(0.2, 0.7, 0.3))
    back = vtkProperty()
    back.SetColor(0.9, 0.2, 0.2)
    back.SetAmbient(0.2)
    actor.SetBackfaceProperty(back)
    renderer = renderer_of(actor)
    renderer.AddLight(scene_light((0.5, 3, 2)))
    return look(renderer, (0.5, 1.8, 1.8))


def elevated(before_mapping):
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(24)
    sphere.SetPhiResolution(24)
    elevation = vtkElevationFilter()
    elevation.SetInputConnection(sphere.GetOutputPort())
    elevation.SetLowPoint(0, -0.5, 0)
    elevation.SetHighPoint(0, 0.5, 0)
    table = vtkLookupTable()
    table.SetNumberOfColors(16)
    table.SetHueRange(0.0, 0.7)
    table.Build()
    actor = actor_of(elevation, Specular=0.3, Ambient=0.1)
    actor.GetMapper().SetLookupTable(table)
    actor.GetMapper().SetScalarRange(0.1, 0.9)
    actor.GetMapper().SetInterpolateScalarsBeforeMapping(before_mapping)
    return actor


def point_scalars():
    """Point scalars mapped to colours, which are interpolated."""
    return look(renderer_of(elevated(False)), (0.3, 0.6, 1.8))


def scalars_before_mapping():
    """Point scalars interpolated, then mapped through the lookup table."""
    return look(renderer_of(elevated(True)), (0.3, 0.6, 1.8))


def cell_scalars():
    """Cell scalars of a triangulated and a quadrilateral mesh."""
    source = plane(1.0, 0.0, 8)
    source.Update()
    data = vtkPolyData()
    data.DeepCopy(source.GetOutput())
    values = vtkFloatArray()
    values.SetName("cell")
    for i in range(data.GetNumberOfCells()):
        values.InsertNextValue((i * 37) % 64)
    data.GetCellData().SetScalars(values)
    actor = actor_of(data)
    actor.GetMapper().SetScalarRange(0, 63)
    return look(renderer_of(actor), (0.5, 1.5, 2.0))


def matrices():
    """A mirrored and unevenly scaled actor, and one deep in an assembly."""
    mirrored = actor_of(superquadric(32), Color=(0.9, 0.6, 0.9), Specular=0.3)
    matrix = vtkMatrix4x4()
    for i, value in enumerate((-1.0, 0.6, 1.3)):
        matrix.SetElement(i, i, value)
    matrix.SetElement(0, 3, 0.8)
    matrix.SetElement(0, 1, 0.3)
    mirrored.SetUserMatrix(matrix)
    cone = vtkConeSource()
    cone.SetResolution(30)
    inner = vtkAssembly()
    inner.AddPart(actor_of(cone, Color=(0.4, 0.9, 0.9)))
    inner.RotateZ(50)
    inner.SetScale(1.2, 0.8, 1.0)
    outer = vtkAssembly()
    outer.AddPart(inner)
    outer.SetPosition(-0.9, 0.1, 0.0)
    renderer = renderer_of(mirrored, outer)
    renderer.AddLight(scene_light((1, 2, 3)))
    return look(renderer, (0, 1, 4.5))


def parallel_off_centre():
    """Parallel projection with a shifted window centre, gradient background, several light kinds."""
    renderer = renderer_of(actor_of(torus(), Specular=0.5, SpecularPower=12.0))
    renderer.GradientBackgroundOn()
    renderer.SetBackground2(0.9, 0.9, 1.0)
    renderer.AddLight(scene_light((1, 2, 3), positional=True, ConeAngle=90.0))
    camera = look(renderer, (2, 1, 4)).GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(1.8)
    camera.SetWindowCenter(0.2, -0.1)
    renderer.ResetCameraClippingRange()
    return renderer


def strips_and_lighting_off():
    """Triangle strips; an actor that takes no part in lighting; culled sides."""
    source = vtkSphereSource()
    source.SetThetaResolution(30)
    source.SetPhiResolution(30)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(source.GetOutputPort())
    strips = vtkStripper()
    strips.SetInputConnection(triangles.GetOutputPort())
    unlit = actor_of(vtkCubeSource(), Color=(0.2, 0.5, 0.7), Lighting=False, Ambient=0.3)
    unlit.SetPosition(1.2, 0, 0)
    culled = actor_of(vtkCylinderSource(), Color=(0.9, 0.9, 0.3), FrontfaceCulling=True)
    culled.SetPosition(-1.2, 0, 0)
    return look(renderer_of(actor_of(strips, Specular=0.4), unlit, culled), (0.4, 1.5, 4))


def far_from_origin():
    """Coordinates a hundred thousand times the objects' size away from the origin."""
    source = superquadric(40, (148376.0, 1234.0, -223423.0))
    renderer = renderer_of(actor_of(source, Specular=0.3))
    renderer.AddLight(scene_light((148377.0, 1237.0, -223420.0), (148376.0, 1234.0, -223423.0)))
    return look(renderer, (148377.5, 1235.2, -223421.0), (148376.0, 1234.0, -223423.0))


def mapped(mapper, data, **properties):
    """An actor whose mapper, of any kind, has the data as its input."""
    mapper.SetInputDataObject(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    for name, value in properties.items():
        getattr(actor.GetProperty(), "Set" + name)(*(value if isinstance(value, tuple) else (value,)))
    return actor


def glyph_actor(count=60):
    """Cones at random places with sizes, directions and colours, under a mirroring, uneven matrix."""
    rng = np.random.default_rng(1)
    points = vtkPoints()
    for place in rng.uniform(-2, 2, (count, 3)):
        points.InsertNextPoint(*place)
    data = vtkPolyData()
    data.SetPoints(points)
    for name, values in (("size", rng.uniform(0.3, 1, count)), ("way", rng.normal(size=(count, 3)))):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("size")
    cone = vtkConeSource()
    cone.SetResolution(12)
    mapper = vtkGlyph3DMapper()
    mapper.SetSourceConnection(cone.GetOutputPort())
    mapper.SetScaleArray("size")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.SetScaleFactor(0.9)
    mapper.SetOrientationArray("way")
    actor = mapped(mapper, data, Specular=0.3, SpecularPower=20.0)
    actor.SetScale(-1, 1, 1.2)
    return actor


def glyphs():
    """A mesh at each of many points: sizes, directions and colours by arrays."""
    renderer = renderer_of(glyph_actor(), actor_of(plane(3.0, -2.6)))
    renderer.AddLight(scene_light((3, 8, 2)))
    return look(renderer, (4, 5, 9), (0, -0.5, 0))


def block_actor():
    """Four balls as blocks at two levels, two of them with a colour and one hidden."""
    blocks = vtkMultiBlockDataSet()
    nested = vtkMultiBlockDataSet()
    for i in range(4):
        sphere = vtkSphereSource()
        sphere.SetCenter(1.1 * i, 0, 0.2 * i)
        sphere.SetThetaResolution(24)
        sphere.SetPhiResolution(16)
        sphere.Update()
        (nested if i % 2 else blocks).SetBlock(i // 2, sphere.GetOutput())
    blocks.SetBlock(2, nested)
    mapper = vtkCompositePolyDataMapper()
    attributes = vtkCompositeDataDisplayAttributes()
    mapper.SetCompositeDataDisplayAttributes(attributes)
    actor = mapped(mapper, blocks, Specular=0.2)
    mapper.SetBlockColor(1, (0.9, 0.4, 0.2))
    mapper.SetBlockVisibility(2, False)
    mapper.SetBlockColor(5, (0.2, 0.7, 0.4))
    return actor


def composite():
    """Composite data: blocks with colours, one of them hidden."""
    renderer = renderer_of(block_actor(), actor_of(plane(3.0, -0.6)))
    renderer.AddLight(scene_light((1, 3, 2)))
    return look(renderer, (1.5, 3, 7), (1.5, 0, 0))


def data_set():
    """An image and an unstructured grid, whose surfaces the mapper takes."""
    image = vtkImageData()
    image.SetDimensions(6, 5, 4)
    values = numpy_to_vtk(np.arange(120) % 17 / 17.0, deep=True)
    image.GetPointData().SetScalars(values)
    block = mapped(vtkDataSetMapper(), image, Specular=0.2)
    block.SetScale(0.4)
    grid = vtkAppendFilter()
    ball = vtkSphereSource()
    ball.SetCenter(-1.0, 1.0, 0.5)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(16)
    grid.AddInputConnection(ball.GetOutputPort())
    grid.Update()
    renderer = renderer_of(
        block, mapped(vtkDataSetMapper(), grid.GetOutput(), Color=(0.4, 0.7, 0.9))
    )
    renderer.AddLight(scene_light((1, 3, 2)))
    return look(renderer, (1, 3, 6), (0.4, 0.8, 0.5))


def clipped():
    """Two clipping planes, which open a ball, and the backs of its triangles seen through the hole."""
    ball = vtkSphereSource()
    ball.SetThetaResolution(40)
    ball.SetPhiResolution(30)
    actor = actor_of(ball, Color=(0.9, 0.7, 0.4), Specular=0.2)
    for origin, normal in (((0, 0.2, 0), (0, -1, 0)), ((0.1, 0, 0.2), (-0.4, 0, -1))):
        cut = vtkPlane()
        cut.SetOrigin(origin)
        cut.SetNormal(normal)
        actor.GetMapper().AddClippingPlane(cut)
    renderer = renderer_of(actor, actor_of(plane(1.0, -0.6)))
    renderer.AddLight(scene_light((1, 3, 2)))
    return look(renderer, (0.7, 1.6, 2.4))


PARITY = [
    default_headlight,
    directional_lights,
    camera_lights,
    point_light,
    spot_light,
    flat_shading,
    cell_normals,
    no_normals,
    point_scalars,
    scalars_before_mapping,
    cell_scalars,
    matrices,
    parallel_off_centre,
    strips_and_lighting_off,
    far_from_origin,
    glyphs,
    composite,
    data_set,
    clipped,
]
