"""The judgement of ./run bench --compare: by numbers whose truth is known, never by a clock. Builds are played
by a machine that drifts, is disturbed now and then, and gives every process a luck of its own."""

import json
import math
import pathlib
import random
import subprocess
import sys

import pytest

BENCHMARKS = pathlib.Path(__file__).resolve().parent.parent / "Benchmarks"
sys.path.insert(0, str(BENCHMARKS))

import compare  # noqa: E402
import judgement  # noqa: E402
import rows  # noqa: E402
from judgement import FASTER, SAME, SLOWER, UNDECIDED, Interval  # noqa: E402


class Machine:
    """Milliseconds of a frame on a shared machine: it drifts slowly by `drift`, single frames scatter with
    heavy tails by `noise`, and some are hit by another program. Elapsed time scatters three times as much
    as CPU time, as was measured on two cores with fifteen programs on them."""

    def __init__(self, seed, noise=0.03, drift=0.3, luck=0.01):
        self.random = random.Random(seed)
        self.noise, self.drift, self.luck = noise, drift, luck
        self.frame = 0

    def heavy(self):
        """Student's with three degrees of freedom: one of seventy is beyond four."""
        scale = math.sqrt(sum(self.random.gauss(0, 1) ** 2 for _ in range(3)) / 3)
        return self.random.gauss(0, 1) / scale

    def milliseconds(self):
        self.frame += 1
        load = 1 + self.drift * math.sin(self.frame / 150)
        hit = self.random.choice((1.5, 2.0, 3.0)) if self.random.random() < 0.05 else 1.0
        wall = 50 * load * hit * math.exp(3 * self.noise * self.heavy())
        cpu = 80 * math.sqrt(load) * math.exp(self.noise * abs(self.heavy()))
        return {"wall": wall, "cpu": cpu}


class PlayedBuild:
    """Stands for compare.Build. `slow`: how much longer its frames take."""

    def __init__(self, name, machine, slow=1.0, opens=None, dies_at=None):
        self.name, self.machine, self.slow = name, machine, slow
        self.opens = opens or {}
        self.dies_at = dies_at
        self.luck = None
        self.starts = 0
        self.turns = []

    def start(self):
        self.starts += 1
        self.luck = math.exp(self.machine.luck * self.machine.random.gauss(0, 1))

    def stop(self):
        self.luck = None

    def ask(self, **order):
        assert self.luck is not None, "asked before it was started"
        if "open" in order:
            return {"triangles": 1000, "device": "llvmpipe", "ms": {"wall": 50.0, "cpu": 80.0},
                    **self.opens.get(order["open"], {})}
        if self.dies_at is not None and len(self.turns) >= self.dies_at:
            raise compare.WorkerDied(self, "exit status -11")
        self.turns.append(order["turn"])
        frame = self.machine.milliseconds()
        return {measure: ms * self.slow * self.luck for measure, ms in frame.items()}


class Rounds:
    """A time limit that counts, so that no test knows of a clock: over once a build has started so often."""

    def __init__(self, build, most):
        self.build, self.most = build, most

    def __call__(self):
        return self.build.luck is None and self.build.starts >= self.most


def played(seed, slow=1.0, names=("one", "two", "three", "four"), most=25, old=None, new=None, **machine):
    """The tracks of a comparison on the played machine, with at most so many rounds."""
    machine = Machine(seed, **machine)
    builds = (PlayedBuild("old", machine, **(old or {})),
              PlayedBuild("new", machine, slow, **(new or {})))
    chosen = [rows.Row(name) for name in names]
    return compare.compare(
        chosen, builds, Rounds(builds[0], most), judgement.MARGIN, machine.random)


def words(tracks):
    return [track.verdict for track in tracks]


def summaries(trials, **settings):
    return [judgement.summary(words(played(seed, **settings))) for seed in range(trials)]


# --- The statistics ---------------------------------------------------------------------------------


@pytest.mark.parametrize("error, freedom, t", [
    (0.05, 1, 12.7062), (0.05, 2, 4.3027), (0.05, 7, 2.3646), (0.01, 4, 4.6041), (0.001, 10, 4.5869),
    (0.05, 30, 2.0423), (0.002, 5, 5.8934),
])
def test_t_quantile_is_that_of_the_tables(error, freedom, t):
    assert judgement.t_quantile(error, freedom) == pytest.approx(t, abs=1e-4)


# Without trimming, and with one and two rounds trimmed at either end.
@pytest.mark.parametrize("rounds", [6, 12, 20])
def test_interval_misses_the_truth_as_often_as_it_says(rounds):
    lot = random.Random(1)
    trials, error = 2000, 0.05
    missed = 0
    for _ in range(trials):
        given = judgement.interval([lot.gauss(0.3, 2.0) for _ in range(rounds)], error)
        missed += not given.low <= 0.3 <= given.high
    # Three standard deviations of that binomial.
    assert abs(missed - error * trials) < 3 * math.sqrt(trials * error * (1 - error))


def test_one_disturbed_round_neither_bends_nor_widens_the_interval():
    rounds = [0.01 * (i % 3 - 1) for i in range(12)]
    quiet = judgement.interval(rounds, 0.01)
    disturbed = judgement.interval(rounds[:-1] + [5.0], 0.01)
    assert disturbed.middle == pytest.approx(quiet.middle, abs=0.002)
    assert disturbed.high - disturbed.low < 1.3 * (quiet.high - quiet.low)


def test_one_round_has_no_interval():
    assert judgement.interval([0.1], 0.05) == Interval(-math.inf, 0.1, math.inf)


def test_steady_drift_cancels_in_a_block():
    # The turns of ABBA at 1.1^0, 1.1^1, 1.1^2, 1.1^3, both builds alike.
    turns = [1.1**k for k in range(4)]
    assert judgement.block_ratio(turns[0::3], turns[1:3], one_sided=False) == pytest.approx(0, abs=1e-15)


def test_block_forgives_one_disturbed_turn_where_interference_only_adds():
    assert judgement.block_ratio([10, 10], [30, 10], one_sided=True) == 0
    assert judgement.block_ratio([10, 10], [40, 10], one_sided=False) == pytest.approx(math.log(2))


def test_round_forgives_disturbed_blocks():
    assert judgement.round_ratio([0.01, 0.012, 0.9, 0.011]) == pytest.approx(0.0115)


@pytest.mark.parametrize("low, high, expected", [
    (0.03, 0.20, SLOWER), (-0.20, -0.03, FASTER), (-0.02, 0.02, SAME), (0.005, 0.02, SAME),
    (0.02, 0.03, UNDECIDED), (0.02, 0.30, UNDECIDED), (-0.30, -0.02, UNDECIDED), (-1, 1, UNDECIDED),
])
def test_verdict_of_an_interval(low, high, expected):
    assert judgement.verdict(Interval(low, (low + high) / 2, high), 0.025) == expected


WIDE = 0.2


@pytest.mark.parametrize("elapsed, cpu, expected", [
    # Elapsed time has the last word where it has one.
    (Interval(-0.30, -0.20, -0.10), Interval(0.10, 0.11, 0.12), FASTER),
    (Interval(0.10, 0.20, 0.30), Interval(-0.01, 0.0, 0.01), SLOWER),
    (Interval(-0.01, 0.0, 0.01), Interval(0.04, 0.05, 0.06), SAME),
    # Where it has none, CPU time answers.
    (Interval(0.01 - WIDE, 0.01, 0.01 + WIDE), Interval(-0.01, 0.0, 0.01), SAME),
    (Interval(0.01 - WIDE, 0.01, 0.01 + WIDE), Interval(0.04, 0.05, 0.06), SLOWER),
    (Interval(-0.01 - WIDE, -0.01, WIDE - 0.01), Interval(-0.06, -0.05, -0.04), FASTER),
    # But not against the estimate of the elapsed time.
    (Interval(0.10 - WIDE, 0.10, 0.10 + WIDE), Interval(-0.01, 0.0, 0.01), UNDECIDED),
    (Interval(-0.10 - WIDE, -0.10, WIDE - 0.10), Interval(0.04, 0.05, 0.06), UNDECIDED),
    (Interval(0.10 - WIDE, 0.10, 0.10 + WIDE), Interval(-0.06, -0.05, -0.04), UNDECIDED),
    (Interval(-WIDE, 0.0, WIDE), Interval(-WIDE, 0.0, WIDE), UNDECIDED),
])
def test_verdict_of_elapsed_and_cpu_time(elapsed, cpu, expected):
    assert judgement.joint_verdict(elapsed, cpu, 0.025) == expected


def test_few_rounds_decide_nothing():
    rounds = {"wall": [0.2] * (judgement.LEAST_ROUNDS - 1)}
    assert judgement.judge(rounds, 0.05)[0] == UNDECIDED
    rounds["wall"].append(0.2)
    assert judgement.judge(rounds, 0.05)[0] == SLOWER


@pytest.mark.parametrize("verdicts, expected", [
    ([SAME, SLOWER, UNDECIDED], SLOWER), ([SAME, FASTER, UNDECIDED], UNDECIDED),
    ([SAME, FASTER], FASTER), ([SAME, SAME], SAME),
])
def test_summary(verdicts, expected):
    assert judgement.summary(verdicts) == expected


# --- Whole comparisons on a machine whose truth is known ---------------------------------------------


def test_equal_builds_are_the_same_in_nine_of_ten():
    found = summaries(20, noise=0.015)
    assert found.count(SAME) >= 18
    assert SLOWER not in found


def test_a_slow_down_of_five_percent_is_found_in_nine_of_ten():
    assert summaries(20, slow=1.05, noise=0.015).count(SLOWER) >= 18
    # Also where noise is twice as large.
    assert summaries(20, slow=1.05).count(SLOWER) >= 18


def test_a_speed_up_is_faster():
    assert set(words(played(1, slow=0.9))) == {FASTER}


def test_noise_leaves_open_what_it_hides():
    tracks = played(2, slow=1.05, noise=0.3, luck=0.1, most=8)
    assert set(words(tracks)) == {UNDECIDED}


def test_many_equal_rows_on_a_very_noisy_machine_are_seldom_called_slower():
    """The family-wise error: one false row or more in a comparison, 5 % at most. Noise beside which the
    margin is nothing gives each row its full share of it."""
    names = [str(i) for i in range(12)]
    found = [words(played(seed, names=names, most=15, noise=0.2, luck=0.08)) for seed in range(40)]
    wrong = sum(bool({SLOWER, FASTER} & set(verdicts)) for verdicts in found)
    # Of 40 comparisons 2 are expected at 5 %; more than 6 would be one chance in two hundred.
    assert wrong <= 6


def test_longer_frames_at_equal_cpu_time_are_slower():
    """A frame that lost its parallelism: nothing but the elapsed time shows it."""

    class Serial(PlayedBuild):
        def ask(self, **order):
            answer = super().ask(**order)
            return {**answer, "wall": 1.4 * answer["wall"]} if "turn" in order else answer

    machine = Machine(5, noise=0.01)
    builds = (PlayedBuild("old", machine), Serial("new", machine))
    (track,) = compare.compare([rows.Row("row")], builds, Rounds(builds[0], 25), judgement.MARGIN,
                               machine.random)
    assert track.verdict == SLOWER
    assert judgement.verdict(track.intervals["cpu"]) != SLOWER


# --- How a comparison is run ------------------------------------------------------------------------


def test_builds_draw_equally_often_and_in_balanced_order():
    machine = Machine(3)
    turns = []

    class Noted(PlayedBuild):
        def ask(self, **order):
            if "turn" in order:
                turns.append(self.name)
            return super().ask(**order)

    builds = (Noted("A", machine), Noted("B", machine))
    compare.compare([rows.Row("row")], builds, Rounds(builds[0], 3), 1e-9, machine.random)
    blocks = ["".join(turns[i:i + 4]) for i in range(0, len(turns), 4)]
    assert len(blocks) == 3 * compare.BLOCKS
    assert set(blocks) == {"ABBA", "BAAB"}


def test_decided_rows_are_left_alone():
    tracks = played(4, slow=2.0, names=("one",), most=25, noise=0.001)
    assert len(tracks[0].values[0]) == judgement.LEAST_ROUNDS


def test_a_graphics_card_is_judged_by_elapsed_time_alone():
    opens = {"one": {"device": "NVIDIA"}}
    (track,) = played(4, names=("one",), old={"opens": opens}, new={"opens": opens})
    assert set(track.rounds) == {"wall"}


def test_different_scenes_are_not_compared():
    tracks = played(6, new={"opens": {"two": {"triangles": 900}}}, noise=0.01)
    assert tracks[1].verdict == compare.OTHER
    assert "1,000 triangles in old, 900 here" in tracks[1].note
    assert compare.OTHER not in words(tracks[:1] + tracks[2:])
    assert compare.print_summary(tracks) == 0


def test_what_the_old_build_cannot_draw_is_not_compared():
    tracks = played(6, old={"opens": {"two": {"error": "AttributeError: SetGlass"}}}, noise=0.01)
    assert (tracks[1].verdict, tracks[1].note) == (compare.OTHER, "old: AttributeError: SetGlass")
    assert compare.print_summary(tracks) == 0


def test_what_this_build_cannot_draw_fails():
    tracks = played(6, new={"opens": {"two": {"error": "AttributeError: SetGlass"}}}, noise=0.01)
    assert tracks[1].verdict == compare.BROKEN
    assert compare.print_summary(tracks) == 1


def test_a_worker_that_dies_fails_its_row_alone():
    # A build draws eight turns a row: in the first round's second row.
    tracks = played(6, new={"dies_at": 10}, most=1)
    assert sorted(words(tracks)) == [compare.BROKEN, UNDECIDED, UNDECIDED, UNDECIDED]
    (broken,) = [track for track in tracks if track.verdict == compare.BROKEN]
    assert "exit status -11" in broken.note
    # The rest of the round needs a new process.
    assert sorted(len(track.values[0]) for track in tracks) == [0, 0, 0, 1]


def test_a_slower_row_fails_and_is_named(capsys):
    tracks = played(7, slow=1.2, names=("bunny, still",))
    compare.print_table(tracks)
    assert compare.print_summary(tracks) == 1
    out = capsys.readouterr().out
    assert "slower: bunny, still" in out
    figures = compare.as_json(tracks[0])
    assert json.loads(json.dumps(figures)) == figures
    assert figures["ratio"]["cpu"][1] == pytest.approx(1.2, abs=0.05)


def test_more_memory_is_called_more():
    machine = Machine(8)

    class Measured(PlayedBuild):
        def ask(self, **order):
            assert order == {"memory": "mirrors"}
            return {"triangles": 1, "bytes": 300 * self.slow * self.luck}

    builds = (Measured("old", machine), Measured("new", machine, slow=1.3))
    (track,) = compare.compare([rows.Row("memory", memory="mirrors")], builds, Rounds(builds[0], 25),
                               judgement.MARGIN, machine.random)
    assert (track.verdict, compare.shown(track.verdict, track.row)) == (SLOWER, "more")


# --- The command ------------------------------------------------------------------------------------


def bench(*arguments):
    return subprocess.run([sys.executable, str(BENCHMARKS / "bench.py"), *arguments], check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_command_compares_this_build_with_itself(tmp_path):
    """One round with real workers; it says nothing of time."""
    done = bench("--compare", compare.this_package_folder(), "--rows", "^torus, .*light moves",
                 "--minutes", "0.0001", "--json", str(tmp_path / "figures.json"))
    assert done.returncode == 0, done.stderr
    assert "torus, one shadow map, light moves" in done.stdout
    figures = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))
    (row,) = figures["rows"]
    assert row["verdict"] == UNDECIDED
    assert row["old"][0] > 0 and row["new"][0] > 0
    assert set(row["rounds"]) >= {"wall"}


def test_command_refuses_a_folder_without_a_build(tmp_path):
    done = bench("--compare", str(tmp_path))
    assert done.returncode == 1
    assert "it holds no Python package vtkhybrid" in done.stderr


def test_command_lists_the_rows_when_none_is_meant():
    done = bench("--compare", compare.this_package_folder(), "--rows", "teapot")
    assert done.returncode == 1
    assert "torus, one shadow map, light moves" in done.stderr


def test_stages_are_summed():
    """A worker answers a row of stages with their milliseconds alone, whole frames with both clocks."""
    import worker

    drawn = worker.Worker(worker.draw)
    drawn.rows = {
        "frame": rows.Row("frame", small_stage),
        "stages": rows.Row("stages", small_stage, stages=("visibility", "blit")),
    }
    assert set(drawn.answer({"open": "frame"})["ms"]) == {"wall", "cpu"}
    assert set(drawn.answer({"turn": 2})) == {"wall", "cpu"}
    opened = drawn.answer({"open": "stages"})
    assert opened["triangles"] == 256
    assert drawn.answer({"turn": 1})["stages"] > 0
    drawn.rows["stages"] = drawn.rows["stages"]._replace(stages=("no such",))
    drawn.answer({"open": "stages"})
    assert "KeyError" in drawn.answer({"open": "stages"})["error"]
    drawn.stage.close()


def small_stage():
    import cases
    import scenes

    renderer = scenes.look(scenes.renderer_of(scenes.actor_of(scenes.torus(256))), (0, 0, 5))
    renderer.AddLight(scenes.scene_light((1, 2, 3)))
    return cases.Stage(renderer, {}, lambda i: cases.move_camera(renderer, None, i))
