"""A still scene of ten thousand actors that VTK draws: the pass beside VTK's own renderer, frame by frame in
turn. Nothing changes, or one of the actors moves."""

import statistics as st

import cases
from measure import WARM_UP, timed
from vtkhybrid import statistics

SIDE = 100
# Of either renderer; so many actors are seconds.
MOST_FRAMES = 9


def measure(moves, frames):
    stage = cases.crowd(SIDE, wireframe=True, moves=moves)
    vtk, hybrid = [], []
    for i in range(WARM_UP + frames):
        stage.advance(i)
        stage.renderer.SetPass(None)
        vtk.append(timed(stage.window))
        stage.renderer.SetPass(stage.rt)
        hybrid.append(timed(stage.window))
    counters = statistics(stage.rt)
    stage.close()
    vtk, hybrid = vtk[WARM_UP:], hybrid[WARM_UP:]
    return {
        "actors": SIDE * SIDE,
        "changes": "one of them moves" if moves else "still",
        "vtk_ms": st.quantiles(vtk, n=4),
        "hybrid_ms": st.quantiles(hybrid, n=4),
        "ratio": st.quantiles([h / v for h, v in zip(hybrid, vtk)], n=4),
        "stages_ms": {k: s["ms"] for k, s in counters["stages"].items() if s["ran"]},
    }


def run(frames):
    """Prints the table; returns its rows."""
    print(f"\n{SIDE * SIDE:,} actors that VTK draws, as wireframes:")
    rows = []
    for moves in (False, True):
        row = measure(moves, frames)
        rows.append(row)
        r0, r1, r2 = row["ratio"]
        print(f"{row['changes']:18s} VTK {row['vtk_ms'][1]:8.1f} ms, hybrid {row['hybrid_ms'][1]:8.1f} ms,"
              f" ratio {r1:5.2f} [{r0:4.2f}, {r2:4.2f}]", flush=True)
    return rows
