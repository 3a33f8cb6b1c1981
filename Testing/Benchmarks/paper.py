"""The tables 2, 3 and 4 and the figure 6 of the paper "Hybrid Ray Tracing: Ray Tracing Using GPU-Accelerated
Image-Space Methods", run again: torus, bunny and the robots of BART, 800 x 600, one light, ray depth 3.

    ./run bench --paper [--quick] [--frames N] [--folder FOLDER] [--no-figure]

Frames per second of 2007 mean nothing today; what is compared are ratios of two modes. All modes of a scene
render the same frame in turn, so that a noisy machine disturbs them alike. Each frame is a new one: the
camera circles, the robots move. Writes paper.json, figure_6.csv and figure_6.png.
"""

import argparse
import csv
import json
import os
import pathlib
import statistics as st

from cases import parade, pass_of
from measure import (
    WARM_UP, device_of, header, model_on_floor, models, robots_file, timed, window_of)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkChartsCore import vtkChart, vtkChartLegend, vtkChartXY
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkObject
from vtkmodules.vtkCommonDataModel import vtkTable
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingContext2D import vtkContextActor
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401  (draws the chart)
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (its letters)

SCENES = ("torus", "bunny", "robots")

# Settings, by the names of the pass' setters; what is not named has its default.
CPU = {"PrimaryShading": 1, "ShadowMode": 0, "MaximumDepth": 0, "Multisampling": 0}
GPU = {"ShadowMode": 0, "MaximumDepth": 0}
SHADOWS = {"ShadowMode": 1}
DIRECT = {"Visibility": 1}
RAYS = {"Visibility": 2}
KD_TREE = {"Accelerator": 1}
INTERLEAVED = {"Interleave": 2, "InterleaveErrorControl": 0}
CONTROLLED = {"Interleave": 2, "InterleaveErrorControl": 1}
TRADITIONAL = {**RAYS, **KD_TREE, "PrimaryShading": 1, "MaximumDepth": 3}
HYBRID = {**KD_TREE, "MaximumDepth": 3}
PIPELINED = {"Pipelined": 1}


class Row:
    """A mode of rendering: its name in the paper or, beyond it, ours, the paper's frames per second for
    torus, bunny and robots, and the settings."""

    def __init__(self, name, paper, *settings):
        self.name = name
        self.paper = paper
        self.settings = {k: v for part in settings for k, v in part.items()}


TABLES = {
    2: [
        Row("CPU (kd-tree)", (1.7, 1.3, 0.2), CPU, RAYS, KD_TREE),
        Row("CPU", (8.0, 8.5, 3.0), CPU),
        Row("CPU, shadows", (6.9, 7.5, 1.4), CPU, SHADOWS),
        Row("GPU", (112, 36, 18), GPU),
        Row("GPU, shadows", (105, 35, 2.4), GPU, SHADOWS),
        Row("GPU, direct", (165, 47, 18), GPU, DIRECT),
        Row("GPU, direct, shadows", (129, 46, 2.4), GPU, DIRECT, SHADOWS),
        Row("CPU (Embree)", None, CPU, RAYS),
    ],
    3: [
        Row("CPU", (8.0, 8.5, 3.0), CPU),
        Row("CPU, interleaved", (10.2, 10.0, 4.3), CPU, INTERLEAVED),
        Row("CPU, lazy 3x3", (7.6, 5.5, 2.9), CPU, {"Multisampling": 2}),
        Row("CPU, lazy 5x5", (7.5, 4.3, 2.8), CPU, {"Multisampling": 3}),
        Row("CPU, 3x3", (4.8, 3.7, 2.3), CPU, {"Multisampling": 4}),
        Row("CPU, 5x5", (3.3, 2.2, 1.9), CPU, {"Multisampling": 5}),
        Row("CPU, interleaved, controlled", None, CPU, CONTROLLED),
    ],
    4: [
        Row("traditional", (0.9, 0.6, 0.1), TRADITIONAL),
        Row("traditional, interl.", (1.6, 1.1, 0.1), TRADITIONAL, INTERLEAVED),
        Row("hybrid", (1.6, 1.0, 0.1), HYBRID),
        Row("hybrid, interleaved", (2.7, 1.6, 0.2), HYBRID, INTERLEAVED),
        Row("hybrid, direct", (1.6, 1.0, 0.1), HYBRID, DIRECT),
        Row("hybrid, direct, interl.", (2.8, 1.7, 0.2), HYBRID, DIRECT, INTERLEAVED),
        Row("hybrid, pipelined", None, HYBRID, PIPELINED),
        Row("hybrid, controlled", None, HYBRID, CONTROLLED),
        Row("traditional, Embree", None, TRADITIONAL, {"Accelerator": 0}),
        Row("hybrid, Embree", None, HYBRID, {"Accelerator": 0}),
        Row("primary rays, GPU shading", None, HYBRID, RAYS),
        Row("item buffer, shadow rays", None, HYBRID, {"ShadowMode": 2}),
    ],
}

# Which rows' speeds are set against each other: (what, table, faster, slower).
RATIOS = [
    ("direct / intersection", 2, "GPU, direct", "GPU"),
    ("direct / intersection, shadows", 2, "GPU, direct, shadows", "GPU, shadows"),
    ("GPU / CPU", 2, "GPU", "CPU"),
    ("item buffer / kd-tree", 2, "CPU", "CPU (kd-tree)"),
    ("no shadows / shadows, CPU", 2, "CPU", "CPU, shadows"),
    ("interleaved / normal", 3, "CPU, interleaved", "CPU"),
    ("lazy / full, 3x3", 3, "CPU, lazy 3x3", "CPU, 3x3"),
    ("lazy / full, 5x5", 3, "CPU, lazy 5x5", "CPU, 5x5"),
    ("off / lazy 3x3", 3, "CPU", "CPU, lazy 3x3"),
    ("hybrid / traditional", 4, "hybrid", "traditional"),
    ("interleaved / normal, hybrid", 4, "hybrid, interleaved", "hybrid"),
    ("interleaved / normal, traditional", 4, "traditional, interl.", "traditional"),
    ("direct / intersection, hybrid", 4, "hybrid, direct", "hybrid"),
]

# The hybrid's pictures against the traditional tracer's, at equal settings. Without shadow maps, which
# are another picture, only the engine of visibility can differ.
PLAIN = {"ShadowMode": 0, "MaximumDepth": 3}
ENGINES = [
    ("item buffer, GPU", PLAIN, {}),
    ("direct rendering, GPU", PLAIN, DIRECT),
    ("primary rays, GPU", PLAIN, RAYS),
    ("item buffer, CPU", PLAIN, {"PrimaryShading": 1}),
    ("item buffer, shadow rays", {"ShadowMode": 2, "MaximumDepth": 3}, {"PrimaryShading": 1}),
]


class Model:
    """Torus or bunny on a floor, a mirror for the tracers; the camera circles."""

    def __init__(self, source, mirror):
        self.renderer, _ = model_on_floor(source, mirror=mirror)
        self.window = window_of(self.renderer)

    def advance(self, i):
        self.renderer.GetActiveCamera().Azimuth(1.0 if i % 40 < 20 else -1.0)


class Robots:
    """The parade, without its textures and with one of its lights. `frames` are spread over all of it."""

    def __init__(self, path, frames):
        self.importer, self.renderer = parade(path)
        self.window = window_of(self.renderer)
        self.frames = frames

    def moment(self, i):
        last = self.importer.GetNumberOfFrames() - 1
        return self.importer.GetFrameTime(round(i * last / max(self.frames - 1, 1)))

    def advance(self, i):
        self.importer.SetTime(self.moment(i % self.frames))


def stages(robots, frames):
    """(name, function that makes the stage, with or without mirrors) of the scenes that are at hand."""
    for name, source in models():
        yield name, lambda mirror, source=source: Model(source, mirror)
    if robots:
        yield "robots", lambda _mirror: Robots(robots, frames)


def measure(stage, rows, frames, which=lambda i: i):
    """Milliseconds of every frame of every row, {name: [ms]}. The i-th frame, warm-up included, is the
    stage's number which(i). All rows render each frame in turn, but for pipelined ones, whose work goes
    on between frames: they have the machine for themselves, one frame after the other."""
    times = {}
    for turn in [[row for row in rows if "Pipelined" not in row.settings]] + [
        [row] for row in rows if "Pipelined" in row.settings
    ]:
        passes = {row.name: pass_of(row.settings) for row in turn}
        # Only what is animated is pipelined.
        stage.window.SetDesiredUpdateRate(15.0 if "Pipelined" in turn[0].settings else 0.0001)
        for i in range(WARM_UP + frames):
            stage.advance(which(i))
            for row in turn:
                stage.renderer.SetPass(passes[row.name])
                times.setdefault(row.name, []).append(timed(stage.window))
    stage.window.SetDesiredUpdateRate(0.0001)
    stage.renderer.SetPass(None)
    return {name: values[WARM_UP:] for name, values in times.items()}


def picture(stage, rt):
    stage.renderer.SetPass(rt)
    stage.window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(stage.window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).astype(int)


def compare(stage, frames):
    """Wrong pixels (off by more than 1/255) and the time against the traditional tracer, per engine."""
    results = []
    for name, common, settings in ENGINES:
        truth, engine = pass_of({**TRADITIONAL, **common}), pass_of({**common, **KD_TREE, **settings})
        wrong, ratios = [], []
        for i in range(WARM_UP + frames):
            stage.advance(i)
            stage.renderer.SetPass(truth)
            slow = timed(stage.window)
            expected = picture(stage, truth)
            stage.renderer.SetPass(engine)
            fast = timed(stage.window)
            shown = picture(stage, engine)
            if i >= WARM_UP:
                wrong.append((abs(shown - expected).max(axis=1) > 1).mean())
                ratios.append(slow / fast)
        results.append({"engine": name, "wrong": st.mean(wrong), "worst": max(wrong),
                        "speed_up": st.quantiles(ratios, n=4)})
    stage.renderer.SetPass(None)
    return results


def print_table(number, figures):
    print(f"\nTable {number}: frames per second, ours (median) and the paper's")
    names = [name for name in SCENES if name in figures]
    print(f"{'':30s}" + "".join(f"{name:>11s} {'[quartiles]':>16s} {'paper':>6s}" for name in names))
    for row in TABLES[number]:
        line = f"{row.name:30s}"
        for name in names:
            fast, middle, slow = (1000 / ms for ms in st.quantiles(figures[name][row.name], n=4))
            paper = f"{row.paper[SCENES.index(name)]:6g}" if row.paper else f"{'':6s}"
            line += f"{middle:11.1f} [{slow:6.1f},{fast:7.1f}] {paper}"
        print(line)


def print_ratios(tables):
    print("\nSpeed-ups, ours (median over the frames) and the paper's")
    names = [name for name in SCENES if name in tables[2]]
    print(f"{'':36s}" + "".join(f"{name:>9s} {'paper':>7s}" for name in names))
    results = []
    for what, table, fast, slow in RATIOS:
        line = f"{what:36s}"
        paper = {row.name: row.paper for row in TABLES[table]}
        for name in names:
            times = tables[table][name]
            ours = st.median(s / f for s, f in zip(times[slow], times[fast]))
            at = SCENES.index(name)
            theirs = paper[fast][at] / paper[slow][at]
            line += f"{ours:9.2f} {theirs:7.2f}"
            results.append({"ratio": what, "scene": name, "ours": ours, "paper": theirs})
        print(line)
    return results


def print_comparison(comparison):
    print("\nHybrid against traditional at equal settings, kd-tree: wrong pixels and speed-up")
    for name, engines in comparison.items():
        for e in engines:
            print(f"{name:8s} {e['engine']:26s} {100 * e['wrong']:8.4f} % wrong"
                  f" (worst frame {100 * e['worst']:.4f} %), {e['speed_up'][1]:5.2f} x as fast")


# Figure 6: the frame time over the whole animation. The paper's curve is the first.
CURVES = [
    Row("CPU ray caster", None, CPU),
    Row("GPU ray caster", None, GPU),
    Row("hybrid, Embree", None, HYBRID, {"Accelerator": 0}),
    Row("traditional, Embree", None, TRADITIONAL, {"Accelerator": 0}),
]


def figure(stage, folder):
    frames = stage.frames
    # Warmed up at the frames behind the first, so that all of the animation is timed and none is still.
    times = measure(stage, CURVES, frames, lambda i: abs(i - WARM_UP))
    moments = [stage.moment(i) for i in range(frames)]
    stage.window.Finalize()
    with (folder / "figure_6.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["time_s"] + [f"{row.name} ms" for row in CURVES])
        for i, moment in enumerate(moments):
            writer.writerow([f"{moment:.3f}"] + [f"{times[row.name][i]:.2f}" for row in CURVES])
    draw_chart(moments, times, folder / "figure_6.png")
    print("\nFigure 6: milliseconds a frame over the robots' animation, "
          f"{frames} frames: median [least, most], and most / median")
    results = []
    for row in CURVES:
        values = times[row.name]
        middle = st.median(values)
        print(f"  {row.name:20s} {middle:8.1f} [{min(values):7.1f}, {max(values):7.1f}]"
              f" {max(values) / middle:6.2f}")
        results.append({"curve": row.name, "median_ms": middle, "least_ms": min(values),
                        "most_ms": max(values)})
    return results


def draw_chart(moments, times, path):
    table = vtkTable()
    for name, values in [("s", moments)] + [(row.name, times[row.name]) for row in CURVES]:
        column = vtkFloatArray()
        column.SetName(name)
        for value in values:
            column.InsertNextValue(value)
        table.AddColumn(column)
    chart = vtkChartXY()
    chart.SetTitle("Robots, 800 x 600: time of a frame")
    chart.SetShowLegend(True)
    chart.GetLegend().SetVerticalAlignment(vtkChartLegend.BOTTOM)
    chart.GetAxis(1).SetTitle("seconds of the animation")
    chart.GetAxis(0).SetTitle("milliseconds")
    chart.GetAxis(0).SetLogScale(True)
    for index, color in enumerate([(214, 96, 40), (66, 120, 190), (60, 150, 80), (130, 90, 160)]):
        line = chart.AddPlot(vtkChart.LINE)
        line.SetInputData(table, 0, index + 1)
        line.SetColor(*color, 255)
        line.SetWidth(1.6)
    actor = vtkContextActor()
    actor.GetScene().AddItem(chart)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    actor.GetScene().SetRenderer(renderer)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(900, 480)
    window.SetMultiSamples(4)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(str(path))
    writer.Write()
    window.Finalize()


def main(arguments):
    parser = argparse.ArgumentParser(prog="./run bench --paper", description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="few frames, for a first impression")
    parser.add_argument("--frames", type=int, help="frames a mode after warm-up (default 15)")
    parser.add_argument("--folder", type=pathlib.Path, default="build/paper", help="of the files")
    parser.add_argument("--no-figure", action="store_true", help="leave out figure 6")
    options = parser.parse_args(arguments)
    frames = options.frames or (5 if options.quick else 15)
    curve = 20 if options.quick else 100
    options.folder.mkdir(parents=True, exist_ok=True)
    # Each of the many passes would tell of the robots' triangles without area, and of multisampling
    # that the GPU's shading does without.
    vtkObject.GlobalWarningDisplayOff()

    tables = {number: {} for number in TABLES}
    comparison, device, robots = {}, "unknown", robots_file()
    for name, make in stages(robots, WARM_UP + frames):
        for number, rows in TABLES.items():
            stage = make(number == 4)
            tables[number][name] = measure(stage, rows, frames)
            if number == 4:
                comparison[name] = compare(stage, 3)
            device = device_of(stage.window)
            stage.window.Finalize()
        print(f"{name}: measured", flush=True)
    print(f"OpenGL: {device}, {os.cpu_count()} cores, medians of {frames} frames")
    for number in TABLES:
        print_table(number, tables[number])
    results = {**header(), "frames": frames, "device": device, "tables_ms": tables,
               "ratios": print_ratios(tables), "against_traditional": comparison}
    print_comparison(comparison)
    if robots and not options.no_figure:
        results["figure_6"] = figure(Robots(robots, curve), options.folder)
    (options.folder / "paper.json").write_text(
        json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(f"\nwritten: {options.folder}/paper.json"
          + ("" if options.no_figure or not robots else ", figure_6.csv, figure_6.png"))
    return 0
