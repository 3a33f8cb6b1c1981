"""Deterministic shadows, mirrors and glass for VTK, switched on in two lines:

    from vtkhybrid import vtkHybridRayTracingPass
    renderer.SetPass(vtkHybridRayTracingPass())

The package re-exports VTK's wrappers of the classes a script needs, vtkHybridRayTracingPass,
vtkHybridMaterial and the scene reader vtkHybridBARTImporter, and adds what a wrapper cannot give: the counters of a frame as a dict
(`statistics`) and the per-pixel buffers as numpy arrays (`buffer`).
"""

import importlib as _importlib
import importlib.util as _importlib_util
import json as _json

from ._version import __version__, vtk_package as _vtk_package

# VTK registers its OpenGL classes with its object factory when this module is imported; without it
# vtkRenderWindow() would be an abstract window that draws nothing.
_importlib.import_module(f"{_vtk_package}.vtkRenderingOpenGL2")

# The same holds for interactor styles and text, which a script uses without naming their modules. A
# VTK built without them is good enough for us.
for _name in (f"{_vtk_package}.vtkInteractionStyle", f"{_vtk_package}.vtkRenderingFreeType"):
    if _importlib_util.find_spec(_name) is not None:
        _importlib.import_module(_name)
del _name

from . import vtkHybridRenderingOpenGL2 as _opengl2
from .vtkHybridIOBART import vtkHybridBARTImporter
from .vtkHybridRenderingScene import vtkHybridMaterial

__all__ = [
    "__version__",
    "buffer",
    "set_buffers",
    "statistics",
    "vtkHybridBARTImporter",
    "vtkHybridMaterial",
    "vtkHybridRayTracingPass",
]


class vtkHybridRayTracingPass(_opengl2.vtkHybridRayTracingPass):
    __doc__ = _opengl2.vtkHybridRayTracingPass.__doc__

    def __setattr__(self, name, value):
        # VTK's wrappers take any attribute without a word; a setting that is spelt like one would
        # do nothing. What the class has, as newer releases have properties, is set as usual.
        if hasattr(type(self), name) or name.startswith("_"):
            super().__setattr__(name, value)
            return
        setter = "Set" + "".join(part[:1].upper() + part[1:] for part in name.split("_"))
        hint = f"; call {setter}(...)" if hasattr(type(self), setter) else ""
        raise AttributeError(f"vtkHybridRayTracingPass has no attribute {name!r}{hint}")


def statistics(rt):
    """The counters of the last frame of `rt` as a dict: stages with the reason why each ran or did
    not, rays by class, triangles drawn, bytes read back, milliseconds."""
    counters = _json.loads(rt.GetStatistics())
    if not counters:
        raise RuntimeError(
            "no frame has been rendered with this pass; was vtkRenderWindow() made before vtkhybrid "
            f"or {_vtk_package}.vtkRenderingOpenGL2 was imported?"
        )
    return counters


def _check_name(rt, name):
    """The pass knows its buffers; here its list is only made into the exception a script expects."""
    if not isinstance(name, str):
        raise TypeError(f"a buffer's name is a str, not {type(name).__name__}")
    known = rt.GetKnownBuffers()
    # A known name such as "array:NAME" stands for a family.
    families = [other.split(":")[0] + ":" for other in known if ":" in other]
    if name not in known and not any(name.startswith(f) and name != f for f in families):
        names = ", ".join(repr(other) for other in known)
        raise ValueError(f"there is no buffer {name!r}; the buffers are {names}")
    return name


def set_buffers(rt, names):
    """Asks for per-pixel buffers from the next frame on, like rt.SetBuffers(names), but raises
    ValueError for a name that does not exist. An empty list switches all of them off."""
    if isinstance(names, str):
        # A str is a sequence too, of letters; the wrapper would take it for a list of names.
        names = [names]
    rt.SetBuffers([_check_name(rt, name) for name in names])


def _get_buffer(rt, name):
    """rt.GetBuffer(name), with what the pass reports in place of an image raised, not printed."""
    reports = []

    def note(_caller, _event, text):
        reports.append(text.strip())

    note.CallDataType = "string0"
    tag = rt.AddObserver("ErrorEvent", note)
    try:
        image = rt.GetBuffer(name)
    finally:
        rt.RemoveObserver(tag)
    array = None if image is None else image.GetPointData().GetArray(name)
    if array is None or array.GetNumberOfTuples() == 0:
        reason = reports[-1] if reports else "the pass holds no such array"
        raise RuntimeError(f"buffer {name!r} is empty, render a frame first ({reason})")
    return image, array


def buffer(rt, name):
    """The buffer `name` of the last frame as a numpy array of shape (height, width) or (height,
    width, components). Row 0 is the bottom one, as everywhere in VTK. Ids are int64 with -1 where
    nothing was hit; floats are NaN there.

    The array is a view of VTK's memory, nothing is copied: take a copy() to keep it longer than the
    next frame. ValueError: there is no such buffer. RuntimeError: it was not asked for, or not
    rendered yet."""
    # numpy is needed here only
    numpy_support = _importlib.import_module(f"{_vtk_package}.util.numpy_support")

    _check_name(rt, name)
    if name not in rt.GetBuffers():
        raise RuntimeError(
            f"buffer {name!r} was not asked for: call rt.SetBuffers([{name!r}]), then render"
        )
    image, array = _get_buffer(rt, name)
    width, height, _ = image.GetDimensions()
    components = array.GetNumberOfComponents()
    shape = (height, width) if components == 1 else (height, width, components)
    return numpy_support.vtk_to_numpy(array).reshape(shape)
