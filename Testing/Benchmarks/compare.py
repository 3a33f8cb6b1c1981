"""Compares this build with another one, row by row: faster, slower or the same, with the interval behind it.

    ./run bench --compare BUILD [--quick] [--rows REGEX] [--minutes N] [--find PERCENT] [--json FILE]

BUILD is the build folder of another checkout, for instance of the last release; both builds are measured by
the scripts of this checkout. A round starts a process a build. They take turns, never both at once: four
turns a block, in the order ABBA or BAAB by lot. Rounds follow until each row is decided (judgement.py says
when) or the time is up; then what is left is `undecided`. Exit status 1: a row is slower, or this build
cannot draw it.
"""

import argparse
import importlib.util
import json
import math
import os
import pathlib
import random
import re
import statistics as st
import subprocess
import sys
import tempfile
import time

import judgement
import rows
from measure import header

# A turn is as many frames as take this long, so that neither the clocks' steps nor the first frame after
# the other process, with cold caches, weigh much.
TURN_MS = 20.0
MOST_FRAMES_A_TURN = 10
BLOCKS = 4
MINUTES, QUICK_MINUTES = 15.0, 10.0
# What Mesa calls its renderers without a graphics card.
SOFTWARE = ("llvmpipe", "softpipe", "swrast")
# Each build has a copy of the package by this name.
PACKAGE = "vtkhybrid"


class WorkerDied(RuntimeError):
    def __init__(self, build, why):
        super().__init__(f"{build.name}: the worker died, {why}")
        self.build = build


class Build:
    """A build to be compared: its name in the table, the folder that holds its Python package, and the
    worker that draws with it."""

    def __init__(self, name, folder, command=(str(pathlib.Path(__file__).with_name("worker.py")),)):
        self.name = name
        self.folder = folder
        self.command = command
        self.process = None

    def start(self):
        self.log = tempfile.TemporaryFile("w+")
        environment = {**os.environ, "PYTHONPATH": self.folder, "PYTHONDONTWRITEBYTECODE": "1"}
        self.process = subprocess.Popen(
            [sys.executable, *self.command], env=environment, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log)
        self.receive()

    def receive(self):
        line = self.process.stdout.readline()
        if not line:
            self.process.wait()
            self.log.seek(0)
            said = self.log.read().strip().splitlines()
            raise WorkerDied(self, f"exit status {self.process.returncode}"
                             + (f": {said[-1]}" if said else ""))
        return json.loads(line)

    def ask(self, **order):
        """The worker's answer. Only the one that is asked works: the other waits for its next order."""
        try:
            self.process.stdin.write(json.dumps(order) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # it died since its last answer; what it said is read next
        return self.receive()

    def stop(self):
        if self.process:
            try:
                self.process.stdin.close()
            except BrokenPipeError:
                pass
            self.process.wait()
            self.process = None
            self.log.close()


# A row that either build cannot draw, or in which they draw different things, has no ratio.
BROKEN, OTHER = "broken", "not comparable"


class Track:
    """What is known of a row so far."""

    def __init__(self, row):
        self.row = row
        self.rounds = {}  # measure: a log ratio a round
        self.values = ([], [])  # of old and new: a figure a round, by the first measure
        self.verdict = judgement.UNDECIDED
        self.intervals = {}
        self.note = ""

    def settle(self, verdict, note):
        self.verdict, self.note = verdict, note

    def fail(self, build, why, builds):
        """What the old build cannot do is no fault of the new one."""
        self.settle(BROKEN if build is builds[1] else OTHER, why)

    def add(self, ratios, values, error, margin):
        for measure, ratio in ratios.items():
            self.rounds.setdefault(measure, []).append(ratio)
        for known, value in zip(self.values, values):
            known.append(value)
        self.verdict, self.intervals = judgement.judge(self.rounds, error, margin)

    @property
    def done(self):
        return bool(self.note) or self.verdict != judgement.UNDECIDED


def measures_of(row, opened):
    """The row's measures; of CPU time only where OpenGL is drawn by the CPU: what a graphics card does
    is no time of the process."""
    by_cpu = all(any(name in answer.get("device", "") for name in SOFTWARE) for answer in opened)
    return tuple(measure for measure in row.measures if measure != "cpu" or by_cpu)


def frames_a_turn(opened):
    milliseconds = max(max(answer["ms"].values()) for answer in opened)
    return min(max(math.ceil(TURN_MS / max(milliseconds, 1e-3)), 1), MOST_FRAMES_A_TURN)


def measure_frames(measures, builds, frames, lot):
    """One round of a row: log ratios by measure, and the builds' own figures by the first of them."""
    blocks = {measure: [] for measure in measures}
    figures = ([], [])
    for _ in range(BLOCKS):
        turns = ([], [])
        first = lot.randrange(2)
        for k in (first, 1 - first, 1 - first, first):
            turns[k].append(builds[k].ask(turn=frames))
        for measure in measures:
            old, new = ([turn[measure] for turn in side] for side in turns)
            blocks[measure].append(judgement.block_ratio(old, new, one_sided=measure != "wall"))
        for known, side in zip(figures, turns):
            known += [turn[measures[0]] for turn in side]
    ratios = {measure: judgement.round_ratio(values) for measure, values in blocks.items()}
    return ratios, tuple(map(st.median, figures))


def one_round(track, builds, lot, error, margin):
    row = track.row
    opened = [None, None]
    for k in lot.sample((0, 1), 2):
        opened[k] = builds[k].ask(memory=row.memory) if row.memory else builds[k].ask(open=row.name)
    for build, answer in zip(builds, opened):
        if "error" in answer:
            return track.fail(build, f"{build.name}: {answer['error']}", builds)
    old, new = (answer["triangles"] for answer in opened)
    if old != new:
        return track.settle(OTHER, f"the pass draws {old:,} triangles in {builds[0].name}, {new:,} here")
    if row.memory:
        values = tuple(answer["bytes"] for answer in opened)
        ratios = {"bytes": math.log(values[1] / values[0])}
    else:
        ratios, values = measure_frames(measures_of(row, opened), builds, frames_a_turn(opened), lot)
    track.add(ratios, values, error, margin)


def time_limit(minutes):
    """A function that says whether so many minutes are over."""
    end = time.monotonic() + 60 * minutes
    return lambda: time.monotonic() >= end


def compare(chosen, builds, is_over, margin, lot, report=lambda number, left: None):
    """Rounds until all rows are decided or, after the first, `is_over()`. Returns a Track a row."""
    tracks = [Track(row) for row in chosen]
    error = judgement.ERROR / len(tracks)
    number = 0
    while any(not track.done for track in tracks) and not (number and is_over()):
        try:
            for build in lot.sample(builds, 2):
                build.start()
            # By lot, so that the time that is cut off is not always that of the same rows.
            for track in lot.sample(tracks, len(tracks)):
                if track.done or (number and is_over()):
                    continue
                try:
                    one_round(track, builds, lot, error, margin)
                except WorkerDied as death:
                    track.fail(death.build, str(death), builds)
                    break  # the others have new processes in the next round
        finally:
            for build in builds:
                build.stop()
        number += 1
        report(number, sum(not track.done for track in tracks))
    return tracks


# --- What is printed --------------------------------------------------------------------------------


def percent(log_ratio):
    return 100 * math.expm1(log_ratio)


def text_of(interval):
    if interval is None:
        return ""
    if not math.isfinite(interval.low):
        return f"{percent(interval.middle):+.1f} %"
    low, middle, high = map(percent, interval)
    return f"{middle:+.1f} % [{low:+.1f}, {high:+.1f}]"


def shown(verdict, row):
    """Of memory, more is what slower is of time."""
    words = {judgement.SLOWER: "more", judgement.FASTER: "less"} if row.memory else {}
    return words.get(verdict, verdict)


def print_table(tracks):
    width = max(len(track.row.name) for track in tracks)
    print(f"{'':{width}s} {'old':>8s} {'new':>8s}  {'elapsed time':>25s}  {'CPU time':>25s} rounds")
    for track in tracks:
        line = f"{track.row.name:{width}s}"
        if track.intervals:
            old, new = (st.median(values) for values in track.values)
            first = text_of(track.intervals[track.row.measures[0]])
            second = text_of(track.intervals.get("cpu"))
            rounds = len(track.values[0])
            line += f" {old:8.1f} {new:8.1f}  {first:>25s}  {second:>25s} {rounds:6d}"
        else:
            line += f" {'':79s}"
        print(f"{line} {shown(track.verdict, track.row)}" + (f" ({track.note})" if track.note else ""))
    print("old, new: milliseconds a frame, or of the stages; of memory, bytes a triangle (its change stands"
          " under elapsed time)")


def as_json(track):
    return {
        "row": track.row.name,
        "verdict": track.verdict,
        "note": track.note,
        "old": track.values[0],
        "new": track.values[1],
        "rounds": track.rounds,
        "ratio": {measure: [math.exp(x) if math.isfinite(x) else None for x in interval]
                  for measure, interval in track.intervals.items()},
    }


def verdicts(tracks):
    return [track.verdict for track in tracks]


def print_summary(tracks):
    """The last line. Returns the exit status."""
    words = verdicts(tracks)
    bad = [shown(t.verdict, t.row) + ": " + t.row.name for t in tracks
           if t.verdict in (judgement.SLOWER, BROKEN)]
    counts = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words))
    print(f"{len(tracks)} rows: {counts}" + "".join(f"\n  {line}" for line in bad))
    return 1 if bad else 0


# --- The command ------------------------------------------------------------------------------------


def package_folder(build):
    """The folder to put on PYTHONPATH of a build folder, or of one that holds the package itself."""
    cache = build / "CMakeCache.txt"
    candidates = [build]
    if cache.is_file():
        for line in cache.read_text(encoding="utf-8").splitlines():
            if line.startswith("HRT_PYTHON_DESTINATION:"):
                candidates.append(build / line.partition("=")[2])
    for folder in candidates:
        if (folder / PACKAGE / "__init__.py").is_file():
            return str(folder.resolve())
    raise SystemExit(f"bench: {build} is not a build folder: it holds no Python package {PACKAGE}")


def this_package_folder():
    return str(pathlib.Path(importlib.util.find_spec(PACKAGE).origin).resolve().parents[1])


def choose(known, pattern, quick):
    chosen = [row for row in known.values() if row.quick or not quick]
    if pattern:
        chosen = [row for row in chosen if re.search(pattern, row.name)]
    if not chosen:
        raise SystemExit("bench: no row of that name; there are\n  " + "\n  ".join(known))
    return chosen


def main(arguments):
    parser = argparse.ArgumentParser(prog="./run bench", description=__doc__.split("\n\n")[0])
    parser.add_argument("--compare", type=pathlib.Path, required=True, metavar="BUILD",
                        help="the other build's folder")
    parser.add_argument("--quick", action="store_true", help="four rows of the bunny")
    parser.add_argument("--rows", help="only the rows whose name this regular expression is found in")
    parser.add_argument("--minutes", type=float,
                        help=f"at most (default {MINUTES:g}; quick {QUICK_MINUTES:g})")
    parser.add_argument("--find", type=float, default=5.0, metavar="PERCENT",
                        help="the slow-down to be found (default 5)")
    parser.add_argument("--json", type=pathlib.Path, help="also write all figures to this file")
    options = parser.parse_args(arguments)
    builds = (Build("the other build", package_folder(options.compare)),
              Build("this build", this_package_folder()))
    chosen = choose(rows.all_rows(), options.rows, options.quick)
    minutes = options.minutes or (QUICK_MINUTES if options.quick else MINUTES)
    print(f"old: {builds[0].folder}\nnew: {builds[1].folder}\n{len(chosen)} rows, at most {minutes:g} minutes;"
          f" intervals hold for all rows together at {100 * (1 - judgement.ERROR):g} %", flush=True)

    def report(number, left):
        print(f"round {number}: {left} of {len(chosen)} rows are undecided", file=sys.stderr, flush=True)

    try:
        tracks = compare(chosen, builds, time_limit(minutes), judgement.margin_of(options.find),
                         random.Random(), report)
    except WorkerDied as death:
        raise SystemExit(f"bench: {death}") from None
    print_table(tracks)
    if options.json:
        figures = {**header(), "find_percent": options.find, "rows": [as_json(t) for t in tracks]}
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    return print_summary(tracks)
