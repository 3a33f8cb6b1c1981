"""The reference renderer (Testing/Cxx/Reference) as numpy arrays, for any vtkRenderer that has been
drawn. Test-only: a small library reached by ctypes, given the renderer's own address."""

import ctypes
import os
import pathlib

import numpy as np
import vtkhybrid

SHADOWS, TINTED, REFLECTIONS, REFRACTIONS = 1, 2, 4, 8


def _library():
    name = "libhrtReferenceAccess.so"
    given = os.environ.get("HRT_REFERENCE_LIBRARY")
    # Without ctest: the package lies in the build tree, the library in its folder of libraries.
    folders = pathlib.Path(vtkhybrid.__file__).resolve().parents
    path = given or next((str(f / name) for f in folders if (f / name).is_file()), name)
    library = ctypes.CDLL(path)
    library.hrtReferenceRender.restype = ctypes.c_void_p
    library.hrtReferenceRender.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int]
    for function, kind in (
        ("Colors", ctypes.POINTER(ctypes.c_double)),
        ("Omitted", ctypes.POINTER(ctypes.c_double)),
        ("Fragile", ctypes.POINTER(ctypes.c_uint8)),
        ("Admissible", ctypes.POINTER(ctypes.c_int64)),
        ("Starts", ctypes.POINTER(ctypes.c_int64)),
        ("Width", ctypes.c_int),
        ("Height", ctypes.c_int),
        ("Delete", None),
    ):
        getattr(library, "hrtReference" + function).restype = kind
        getattr(library, "hrtReference" + function).argtypes = [ctypes.c_void_p]
    return library


def address_of(vtk_object):
    """The C++ object behind a wrapped one: __this__ is "_" + hexadecimal address + "_p_" + class."""
    return int(vtk_object.__this__.split("_")[1], 16)


class Picture:
    """height x width arrays, row 0 at the bottom: `colors` (float64 RGBA; alpha 0: nothing hit),
    `omitted` (the colour that came by rays below the tracer's weight limit), `fragile` (a later ray's
    answer was a matter of rounding), `tie` (several triangles are as right)."""

    def __init__(self, renderer, maximum_depth=3, shadows=True, tinted=False, reflections=True,
                 refractions=True):
        library = _library()
        flags = (SHADOWS * shadows + TINTED * tinted + REFLECTIONS * reflections
                 + REFRACTIONS * refractions)
        result = library.hrtReferenceRender(address_of(renderer), maximum_depth, flags)
        try:
            self.width = library.hrtReferenceWidth(result)
            self.height = library.hrtReferenceHeight(result)
            shape = (self.height, self.width)
            pixels = self.height * self.width

            def copy(name, *form):
                pointer = getattr(library, "hrtReference" + name)(result)
                return np.ctypeslib.as_array(pointer, form).copy()

            self.colors = copy("Colors", *shape, 4)
            self.omitted = copy("Omitted", *shape, 3)
            self.fragile = copy("Fragile", *shape).astype(bool)
            self.starts = copy("Starts", pixels + 1)
            self.admissible = copy("Admissible", int(self.starts[-1]))
        finally:
            library.hrtReferenceDelete(result)
        self.tie = (np.diff(self.starts) > 1).reshape(shape)

    def allows(self, ids):
        """Where `ids` (-1: nothing) is among the pixel's admissible triangles."""
        pixel = np.repeat(np.arange(ids.size), np.diff(self.starts))
        good = np.zeros(ids.size, bool)
        np.logical_or.at(good, pixel, ids.ravel()[pixel] == self.admissible)
        return good.reshape(ids.shape)
