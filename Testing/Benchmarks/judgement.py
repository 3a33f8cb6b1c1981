"""Whether one build is slower than another, from timings of a machine that is never quiet: the statistics of
compare.py, without a clock, so that they can be tested with numbers that are known.

A *round* is a pair of fresh processes, one a build, that draw the same frames in turn. Its value is the
logarithm of new time / old time. Rounds are what is counted, not frames: the frames of a process share its
luck (where its memory lies, what else the machine did meanwhile), so a thousand frames of two processes still
say little about two builds.

Two distances keep the error rates small both ways. `MARGIN` divides them: a row is *slower* when its whole
interval lies beyond the margin, *the same* when it lies wholly inside. Equal builds, and a slow-down of twice
the margin, are both a margin away from a false answer. What lies between, or scatters too much, is *undecided*.
"""

import functools
import math
import statistics
from typing import NamedTuple


def margin_of(percent):
    """Half of a slow-down that is to be found, as a log ratio: as far from equal builds as from it."""
    return math.log1p(percent / 100) / 2


MARGIN = margin_of(5)
# The chance of one false answer or more in a whole comparison, shared out among its rows and measures.
ERROR = 0.05
# Who looks after each round and stops at the first answer errs more often than who looks once: up to three
# times as often over thirty rounds, by simulation (Testing/Python/test_comparison.py repeats it).
LOOKS = 3
# Fewer rounds do not tell their own scatter: with four, t at 99.8 % is 10.
LEAST_ROUNDS = 5

SLOWER, FASTER, SAME, UNDECIDED = "slower", "faster", "same", "undecided"


class Interval(NamedTuple):
    """Logarithms of ratios: the estimate and what is around it."""

    low: float
    middle: float
    high: float


def block_ratio(old, new, one_sided):
    """The log ratio of a block, two turns of either build in the order ABBA or BAAB, so that a drift
    within it cancels.

    `one_sided`: interference only ever adds, and seldom, as to the CPU time of a process, through cold
    caches, or to a short stage; then the lesser of two turns is nearer to the truth. The elapsed time of a
    frame is mostly waiting on a busy machine, and the lesser of two is then luck; all of it counts."""
    value = min if one_sided else statistics.geometric_mean
    return math.log(value(new) / value(old))


def round_ratio(blocks):
    """The log ratio of a round: the middle one of its blocks, whatever burst hit some of them."""
    return statistics.median(blocks)


def t_inside(t, freedom):
    """The probability that a variable of Student's distribution lies within [-t, t]; exact, by the finite
    series for whole degrees of freedom (Abramowitz and Stegun 26.7.3 and 26.7.4)."""
    angle = math.atan(t / math.sqrt(freedom))
    cosine2 = math.cos(angle) ** 2
    odd = freedom % 2 == 1
    term, total = math.cos(angle) if odd else 1.0, 0.0
    for k in range(1 if odd else 0, freedom, 2):
        total += term
        term *= cosine2 * (k + 1) / (k + 2)
    return (2 / math.pi) * (angle + math.sin(angle) * total) if odd else math.sin(angle) * total


@functools.lru_cache(maxsize=None)
def t_quantile(error, freedom):
    """The t outside whose [-t, t] Student's distribution has the probability `error`."""
    low, high = 0.0, 1.0
    while t_inside(high, freedom) < 1 - error:
        low, high = high, 2 * high
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if t_inside(middle, freedom) < 1 - error else (low, middle)
    return high


def interval(rounds, error):
    """The interval that holds the true log ratio but for the probability `error`: Student's over the
    rounds. Of eight rounds and more an eighth at either end is trimmed, and counted as the next ones in
    (Yuen, 1974): a round that another program hit would else widen the interval for the rest of the time.
    """
    count, cut = len(rounds), len(rounds) // 8
    ordered = sorted(rounds)
    kept = ordered[cut:count - cut]
    middle = statistics.fmean(kept)
    if count < 2:
        return Interval(-math.inf, middle, math.inf)
    winsorized = [kept[0]] * cut + kept + [kept[-1]] * cut
    width = t_quantile(error, len(kept) - 1) * math.sqrt(
        (count - 1) * statistics.variance(winsorized) / (len(kept) * (len(kept) - 1)))
    return Interval(middle - width, middle, middle + width)


def verdict(given, margin=MARGIN):
    """What an interval says by itself."""
    if given.low > margin:
        return SLOWER
    if given.high < -margin:
        return FASTER
    if given.low > -margin and given.high < margin:
        return SAME
    return UNDECIDED


def joint_verdict(elapsed, cpu, margin=MARGIN):
    """Of elapsed time, which a user feels, and CPU time, which other programs hardly touch.

    Elapsed time has the last word where it has one: work that was spread over more cores costs more CPU
    time and is done sooner. Where waiting hides it, CPU time answers, unless the estimate of the elapsed
    time points elsewhere: a frame that lost its parallelism has the same CPU time."""
    answer = verdict(elapsed, margin)
    if answer != UNDECIDED:
        return answer
    answer = verdict(cpu, margin)
    agrees = {
        SLOWER: elapsed.middle > 0,
        FASTER: elapsed.middle < 0,
        SAME: abs(elapsed.middle) < margin,
        UNDECIDED: True,
    }
    return answer if agrees[answer] else UNDECIDED


def judge(rounds, error, margin=MARGIN):
    """The verdict on a row and the intervals behind it. `rounds`: a list of log ratios a measure, either
    "wall" and "cpu" or one alone; `error`: this row's share."""
    share = error / len(rounds) / LOOKS
    intervals = {name: interval(values, share) for name, values in rounds.items()}
    if min(map(len, rounds.values())) < LEAST_ROUNDS:
        return UNDECIDED, intervals
    if "cpu" in intervals:
        return joint_verdict(intervals["wall"], intervals["cpu"], margin), intervals
    (only,) = intervals.values()
    return verdict(only, margin), intervals


def summary(verdicts):
    """One word for a whole comparison: slower if any row is; the same if nothing is left open."""
    for word in (SLOWER, UNDECIDED, FASTER):
        if word in verdicts:
            return word
    return SAME
