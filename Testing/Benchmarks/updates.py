"""What a step of the robots' animation costs either ray structure, by hrtUpdateBenchmark, which draws
nothing: in a frame of the pass llvmpipe's threads share the cores with the update."""

import json
import pathlib
import subprocess

from measure import robots_file

FRAMES = 100


def run():
    path = robots_file()
    if not path:
        return []
    program = pathlib.Path(__file__).resolve().parents[2] / "build/bin/hrtUpdateBenchmark"
    output = subprocess.run([str(program), path, str(FRAMES)], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    rows = [{"scene": "robots", "case": "structure", "changes": "animation step", **json.loads(line)}
            for line in output.splitlines()]
    print(f"\n{'scene':7s} {'structure':9s} {'changes':14s} {'moved parts':>13s} {'first ms':>9s}"
          f" {'update ms':>24s} {'fastest':>8s} {'worst':>7s} {'built':>5s}")
    for row in rows:
        low, middle, high = row["update_ms"]
        print(f"{row['scene']:7s} {row['structure']:9s} {row['changes']:14s}"
              f" {row['moved_parts']:5d} of {row['parts']:4d} {row['first_ms']:9.1f}"
              f" {middle:8.3f} [{low:5.3f}, {high:5.3f}] {row['fastest_update_ms']:8.3f}"
              f" {row['worst_update_ms']:7.3f} {row['built']:5d}", flush=True)
    return rows
