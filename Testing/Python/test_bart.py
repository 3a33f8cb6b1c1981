"""BART's animated robots, from file to picture: the reader's figures, what the pass makes of them, and
that an animation moves parts but never rebuilds them."""

import pathlib

import numpy as np
import pytest

from vtkhybrid import statistics, vtkHybridBARTImporter, vtkHybridMaterial, vtkHybridRayTracingPass
from vtkmodules.vtkRenderingCore import vtkRenderer

SMALL_SCENE = pathlib.Path(__file__).resolve().parent.parent / "Data" / "bart" / "everything.aff"
ROBOTS = "bart/robots/aff/Robot.aff"
TRIANGLES = 71708
# Triangles two of whose corners are one vertex, as the files have them: four in each of 32 meshes'
# instances, of which 10 consist of nothing else. The pass counts them.
WITHOUT_AREA = 128
WITHOUT_SURFACE = 10


def read(path, textures=True):
    importer = vtkHybridBARTImporter()
    importer.SetFileName(str(path))
    importer.SetTextures(textures)
    assert importer.Read()
    return importer


def traced(importer):
    """A renderer with the scene and the pass."""
    renderer = vtkRenderer()
    importer.AddTo(renderer)
    rt = vtkHybridRayTracingPass()
    renderer.SetPass(rt)
    return renderer, rt


def translucent(importer):
    return sum(actor.GetProperty().GetOpacity() < 1.0 for actor in importer.GetActors())


@pytest.mark.expects_vtk_messages("absent.aff: is not an existing file")
def test_an_error_is_a_false_and_a_message():
    importer = vtkHybridBARTImporter()
    importer.SetFileName(str(SMALL_SCENE.with_name("absent.aff")))
    assert not importer.Read()
    assert importer.GetActors().GetNumberOfItems() == 0


def test_a_small_scene_is_drawn_at_any_time(render):
    importer = read(SMALL_SCENE)
    renderer, rt = traced(importer)
    first = render(renderer, (80, 60))
    importer.SetTime(6.0)
    assert (render(renderer, (80, 60)) != first).any()
    assert not any(statistics(rt)["refused"].values())


def test_materials_reach_the_pass():
    importer = read(SMALL_SCENE)
    actors = list(importer.GetActors())
    assert vtkHybridMaterial.GetReflectance(actors[0]) == pytest.approx(0.6)
    assert vtkHybridMaterial.GetIndexOfRefraction(actors[3]) == 1.5


def test_robots_are_traced_and_their_animation_rebuilds_nothing(render, data_file):
    importer = read(data_file(ROBOTS), textures=False)
    assert importer.GetNumberOfTriangles() == TRIANGLES
    renderer, rt = traced(importer)
    pictures = []
    for time in (0.0, 25.0, 25.05):
        importer.SetTime(time)
        pictures.append(render(renderer, (320, 240)).astype(int))
        report = statistics(rt)
        assert report["refused"] == {
            "non_finite_points": 0,
            "invalid_indices": 0,
            "degenerate_triangles": WITHOUT_AREA,
            "empty_parts": WITHOUT_SURFACE,
            "singular_matrices": 0,
            "out_of_range_parts": 0,
        }
        assert report["triangles"] == TRIANGLES - WITHOUT_AREA
        assert report["lights"] == 1
        # The panes, which VTK draws in its translucent pass, are the only ones that may be left to it.
        assert not report["left_to_vtk"]
        assert set(report["hosted"].values()) <= {"translucent"}
        assert len(report["hosted"]) <= translucent(importer)
        assert report["rays"]["reflection"]["traced"] > 0
        assert report["rays"]["shadow"]["traced"] > 0
        if time > 25.0:
            # Parts that start to move get hierarchies of their own once; from then on only matrices
            # change, and the one flat hierarchy that the smallest moving parts share.
            assert report["structure"]["built"] <= 1
            assert report["structure"]["reused"] > 100

    for picture in pictures:
        # Inside a city: nothing shows the black background between the houses, nothing is all white.
        assert (picture.max(axis=2) == 0).mean() < 0.02
        assert 60 < picture.mean() < 230
        # Many colours: flat or noisy pictures have a handful, or all.
        assert 500 < len(np.unique(picture.reshape(-1, 3), axis=0)) < 40000
    # At first two blue robots stand in front of the camera.
    red, blue = pictures[0][..., 0], pictures[0][..., 2]
    assert 0.05 < (blue > red + 40).mean() < 0.3
    assert np.abs(pictures[1] - pictures[0]).mean() > 10
    assert 0 < np.abs(pictures[2] - pictures[1]).mean() < 10


@pytest.mark.expects_vtk_messages()
def test_textures_show_on_the_robots(render, data_file):
    importer = read(data_file(ROBOTS))
    textured = [actor for actor in importer.GetActors() if actor.GetTexture()]
    assert len({actor.GetTexture() for actor in textured}) == 44
    renderer, _rt = traced(importer)
    picture = render(renderer, (320, 240)).astype(int)
    plain = read(data_file(ROBOTS), textures=False)
    other, _rt = traced(plain)
    difference = np.abs(picture - render(other, (320, 240)))
    assert (difference.max(axis=2) > 20).mean() > 0.5
