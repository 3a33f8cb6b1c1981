"""Interleaved rendering, time against error: each interleaving of a mode beside the same mode with every pixel
traced, frame by frame in turn, while the camera moves. The error is the root of the mean square over
pixels, colours and frames, in steps of 255, against the picture with every pixel traced."""

import statistics as st

import numpy as np
from measure import WARM_UP, model_on_floor, models, timed, window_of
from vtkhybrid import statistics, vtkHybridRayTracingPass
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

# What the interleaving thins, by the names of the pass' setters.
MODES = [
    ("traditional ray tracer", {"Visibility": 2, "PrimaryShading": 1}),
    ("item buffer, CPU shading", {"PrimaryShading": 1}),
    ("hybrid", {}),
]
# n, whether error control is on
STEPS = [(1, True)] + [(n, control) for n in (2, 3, 4) for control in (False, True)]


def picture(window):
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).astype(float)


def measure(model, settings, frames):
    """A dictionary a step."""
    renderer, _ = model_on_floor(model, mirror=True)
    window = window_of(renderer)
    passes = []
    for n, control in STEPS:
        rt = vtkHybridRayTracingPass()
        for name, value in {**settings, "Interleave": n, "InterleaveErrorControl": control}.items():
            getattr(rt, "Set" + name)(value)
        passes.append(rt)
    times = [[] for _ in passes]
    squares = [[] for _ in passes]
    for i in range(WARM_UP + frames):
        renderer.GetActiveCamera().Azimuth(1.0 if i % 20 < 10 else -1.0)
        every = None
        for k, rt in enumerate(passes):
            renderer.SetPass(rt)
            milliseconds = timed(window)
            shown = picture(window)
            every = shown if every is None else every
            if i >= WARM_UP:
                times[k].append(milliseconds)
                squares[k].append(np.mean((shown - every) ** 2))
    window.Finalize()
    return [
        {
            "interleave": n,
            "error_control": control,
            "ms": st.quantiles(times[k], n=4),
            "speed": st.quantiles([a / b for a, b in zip(times[0], times[k])], n=4),
            "rmse": float(np.sqrt(np.mean(squares[k]))),
            "pixels": statistics(passes[k])["interleave"],
        }
        for k, (n, control) in enumerate(STEPS)
    ]


def run(frames):
    """Prints the table over a mirror floor; returns its rows."""
    print("\ninterleaving, camera moves over a mirror floor:")
    print(f"{'scene':7s} {'mode':26s} {'n':>2s} {'control':8s} {'ms':>8s} {'times as fast':>22s}"
          f" {'RMS error':>10s} {'traced':>8s}")
    results = []
    for name, model in models():
        for mode, settings in MODES:
            for row in measure(model, settings, frames):
                results.append({"scene": name, "mode": mode, **row})
                low, middle, high = row["speed"]
                pixels = row["pixels"]
                traced = pixels["traced"] / (pixels["traced"] + pixels["interpolated"])
                control = "" if row["interleave"] == 1 else "on" if row["error_control"] else "off"
                print(f"{name:7s} {mode:26s} {row['interleave']:2d} {control:8s} {row['ms'][1]:8.1f}"
                      f" {middle:8.2f} [{low:5.2f}, {high:5.2f}] {row['rmse']:10.3f}"
                      f" {100 * traced:6.1f} %", flush=True)
    return results
