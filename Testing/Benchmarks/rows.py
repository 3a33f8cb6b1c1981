"""What compare.py compares two builds by: a row is a scene in motion, or the memory that one takes."""

from typing import Callable, NamedTuple

import cases
import memory
from measure import models, robots_file


class Row(NamedTuple):
    """`open` makes the stage that is drawn. Of a row with `stages` not the whole frame is compared but
    these stages of the pass, by their milliseconds in its statistics. A row of `memory` draws in a
    process of its own. A `quick` one is in the small set."""

    name: str
    open: Callable = None
    stages: tuple = ()
    memory: str = None
    quick: bool = False

    @property
    def measures(self):
        return ("bytes",) if self.memory else ("stages",) if self.stages else ("wall", "cpu")


# Modes beside those of cases.py: every engine that makes first hits, shades or casts shadows, alone.
ALL_BY_RAYS = {"Visibility": 2, "PrimaryShading": 1, "ShadowMode": 2}
MODES = [
    ("all by rays", {}, ALL_BY_RAYS),
    ("CPU shading, shadow rays", {}, {"PrimaryShading": 1, "ShadowMode": 2}),
    ("kd-tree, mirror floor", {"mirror": True}, {"Accelerator": 1}),
    ("lazy 3x3, CPU shading", {}, {"PrimaryShading": 1, "Multisampling": 2}),
]
QUICK = {("no effects", "camera moves"), ("one shadow map", "camera moves"),
         ("mirror floor", "camera moves"), ("all by rays", "camera moves")}
# The CPU shades, so that the ids are read back and their milliseconds are not only those of a command
# that is waited for elsewhere.
ITEM_BUFFER = {"ShadowMode": 0, "MaximumDepth": 0, "PrimaryShading": 1}
CROWD = 32


def _of_models():
    for name, model in models():
        for case, changes, keywords, settings, move in cases.CASES + [
            (mode, "camera moves", keywords, settings, cases.move_camera)
            for mode, keywords, settings in MODES
        ]:
            yield Row(
                f"{name}, {case}, {changes}",
                lambda m=model, k=keywords, s=settings, v=move: cases.on_floor(m, k, s, v),
                quick=name == "bunny" and (case, changes) in QUICK)
        if name == "bunny":
            for what, stages in (("drawn", ("visibility",)),
                                 ("drawn and read back", ("visibility", "read_back"))):
                yield Row(
                    f"{name}, item buffer, {what}",
                    lambda m=model: cases.on_floor(m, {}, ITEM_BUFFER, cases.move_camera),
                    stages=stages)


def _of_crowds():
    for what, wireframe in (("that VTK draws", True), ("traced", False)):
        for changes, moves in (("still", False), ("one moves", True)):
            yield Row(f"{CROWD * CROWD:,} actors {what}, {changes}",
                      lambda w=wireframe, m=moves: cases.crowd(CROWD, w, m))


def all_rows():
    """Every row that this machine has the data for, by name."""
    rows = [*_of_models(), *_of_crowds()]
    path = robots_file()
    if path:
        rows.append(Row("robots, one shadow map, they move", lambda: cases.robots(path, {})))
        rows.append(Row("robots, all by rays, they move", lambda: cases.robots(path, ALL_BY_RAYS)))
    rows += [Row(f"memory, a million triangles, {kind}", memory=kind)
             for kind in memory.KINDS if kind != "VTK alone"]
    return {row.name: row for row in rows}
