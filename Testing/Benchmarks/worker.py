"""One of the two processes of a round of compare.py: draws what it is told with the build that its PYTHONPATH
names, and times it. Orders and answers are lines of JSON:

    {"open": ROW}          makes the row's scene, draws the warm-up   -> what it draws, and how fast
    {"turn": N}            draws the next N frames                    -> milliseconds of a frame, a measure
    {"memory": KIND}       measures in a process of its own           -> bytes

Whatever fails is the answer, {"error": TEXT}; the worker goes on.
"""

import json
import os
import statistics as st
import sys
import time

import memory
import rows
from cases import traced_triangles
from measure import WARM_UP, device_of
from vtkhybrid import statistics
from vtkmodules.vtkCommonCore import vtkObject


def draw(stage):
    stage.window.Render()
    stage.window.WaitForCompletion()


class Worker:
    def __init__(self, draw_frame):
        self.draw = draw_frame
        self.rows = rows.all_rows()
        self.row = self.stage = None
        self.frame = 0

    def one_frame(self):
        """Milliseconds by the row's measures."""
        self.stage.advance(self.frame)
        self.frame += 1
        cpu, wall = time.process_time(), time.perf_counter()
        self.draw(self.stage)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        if not self.row.stages:
            return {"wall": 1000 * wall, "cpu": 1000 * cpu}
        stages = statistics(self.stage.rt)["stages"]
        return {"stages": sum(stages[name]["ms"] for name in self.row.stages)}

    def turn(self, frames):
        """Of frames their mean. Of stages the least: they are so short that, of a few, one is undisturbed."""
        times = [self.one_frame() for _ in range(frames)]
        value = min if self.row.stages else st.fmean
        return {measure: value([t[measure] for t in times]) for measure in times[0]}

    def open(self, name):
        if self.stage:
            self.stage.close()
        self.row, self.frame = self.rows[name], 0
        self.stage = self.row.open()
        self.stage.renderer.SetPass(self.stage.rt)
        for _ in range(WARM_UP):
            last = self.turn(1)
        return {"triangles": traced_triangles(self.stage), "device": device_of(self.stage.window),
                "ms": last}

    def memory(self, kind):
        figures = memory.in_own_process(kind)
        return {"triangles": figures["traced"], "bytes": figures["bytes_in_use_a_triangle"]}

    def answer(self, order):
        (what, argument), = order.items()
        try:
            return {"open": self.open, "turn": self.turn, "memory": self.memory}[what](argument)
        except Exception as error:  # noqa: BLE001  (whatever a build cannot do is a result)
            return {"error": f"{type(error).__name__}: {error}"}


def main(draw_frame=draw):
    # What libraries print must not mix with the answers.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    vtkObject.GlobalWarningDisplayOff()  # what a scene is told in one build it is told in the other
    worker = Worker(draw_frame)
    print(json.dumps({"ready": True}), file=answers, flush=True)
    for line in sys.stdin:
        print(json.dumps(worker.answer(json.loads(line))), file=answers, flush=True)


if __name__ == "__main__":
    main()
