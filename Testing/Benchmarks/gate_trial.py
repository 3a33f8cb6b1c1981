"""How often the gate is right: compare.py's small set, again and again, on two equal builds and on two of
which one is slowed by 5 %. Equal builds should be called the same, the slowed one slower, in 9 of 10.

    ./run python Testing/Benchmarks/gate_trial.py [--trials N] [--slow PERCENT] [--rows REGEX] [--minutes N]
                                                  [--json FILE]

Both sides are this build. The slowed one is drawn by this script as its worker: after each frame it computes
on, for the given share of the frame's own CPU time, on as many cores as the frame kept busy, so that CPU time
and elapsed time grow alike, as they do when the frame itself has more work.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import sys
import time

import compare
import judgement
import rows
import worker

SLOWED = "--slowed-worker"
# One step of computing on, a tenth of a millisecond; hashlib lets other threads run meanwhile.
STEPS = 150


def compute(seconds):
    """Keeps a core busy for that much CPU time of this thread."""
    until = time.thread_time() + seconds
    while time.thread_time() < until:
        hashlib.pbkdf2_hmac("sha256", b"planted", b"slow-down", STEPS)


class SlowedDraw:
    """worker.draw, slowed by a share."""

    def __init__(self, share):
        self.share = share
        self.cores = os.cpu_count() or 1
        self.busy = 1.0
        self.threads = concurrent.futures.ThreadPoolExecutor(self.cores)

    def __call__(self, stage):
        wall, cpu = time.perf_counter(), time.process_time()
        worker.draw(stage)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        # Other programs only ever make it look less parallel than it is.
        self.busy = max(self.busy, min(cpu / wall, self.cores))
        self.burn(self.share * cpu)

    def burn(self, seconds):
        """`seconds` of CPU time, but only seconds / busy of elapsed time: the other cores help."""
        elapsed = seconds / self.busy
        helpers = self.cores - 1
        each = (seconds - elapsed) / max(helpers, 1)
        under_way = [self.threads.submit(compute, each) for _ in range(helpers)]
        compute(elapsed)
        concurrent.futures.wait(under_way)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--trials", type=int, default=10, help="of either kind (default 10)")
    parser.add_argument("--slow", type=float, default=5.0, metavar="PERCENT", help="default 5")
    parser.add_argument("--rows", help="as of ./run bench --compare; default its small set")
    parser.add_argument("--minutes", type=float, default=compare.QUICK_MINUTES,
                        help=f"at most, a comparison (default {compare.QUICK_MINUTES:g})")
    parser.add_argument("--json", type=pathlib.Path, help="also write all figures to this file")
    options = parser.parse_args()
    chosen = compare.choose(rows.all_rows(), options.rows, quick=not options.rows)
    folder = compare.this_package_folder()
    slowed = (str(pathlib.Path(__file__).resolve()), SLOWED, str(options.slow / 100))
    kinds = [
        ("equal", judgement.SAME, compare.Build("the same build", folder)),
        (f"{options.slow:g} % slower", judgement.SLOWER,
         compare.Build("the slowed build", folder, slowed)),
    ]
    right = {kind: 0 for kind, _, _ in kinds}
    figures = []
    for number in range(1, options.trials + 1):
        for kind, expected, new in kinds:
            builds = (compare.Build("this build", folder), new)
            start = time.monotonic()
            tracks = compare.compare(chosen, builds, compare.time_limit(options.minutes),
                                     judgement.MARGIN, random.Random())
            seconds = time.monotonic() - start
            words = compare.verdicts(tracks)
            word = judgement.summary(words)
            right[kind] += word == expected
            print(f"{number:3d} {kind:12s} {word:9s} of {len(words)} rows {words.count(expected)} are"
                  f" {expected}, {seconds:5.0f} s, at most {max(len(t.values[0]) for t in tracks)} rounds,"
                  f" load {os.getloadavg()[0]:.1f}", flush=True)
            figures.append({"kind": kind, "verdict": word, "right": word == expected,
                            "seconds": seconds, "rows": [compare.as_json(t) for t in tracks]})
            if options.json:  # each time: the trials take hours
                options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    for kind, expected, _ in kinds:
        print(f"{kind}: {right[kind]} of {options.trials} found {expected}")
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] == [SLOWED]:
        worker.main(SlowedDraw(float(sys.argv[2])))
    else:
        sys.exit(main())
