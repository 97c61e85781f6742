# SPDX-License-Identifier: MIT
"""Search for the centres of radial functions that best represent clamped cosines (docs/bases.md,
'Searched centres').

    python3 -m clpv_lab.search 8 -o mine.json && clpv render scenes/cornell.json --centres mine.json -o
    image.png

Minimises the root mean square of the relative L2 error of clamped cosines: SciPy's SLSQP descends
from random starts, with the condition number of the Gram matrix bounded. The same seed gives the
same set. Needs SciPy (Debian: python3-scipy). """
import argparse
import collections
import json
import pathlib
import sys
import warnings

import numpy as np

from clpv import output
from clpv.draw import documents

NORM = 2 * np.pi / 3  # integral of max(0, w . d)^2
AXES = np.concatenate([np.eye(3), -np.eye(3)])
LAMBDAS = 0.02, 0.9  # beyond these, functions are nearly constant or needles
MAX_CENTRES, MAX_CONDITION, MAX_WEIGHTS = 64, 1e7, 10000
SLACK = 1e-6  # tolerance of the bound on ln(condition)
# Value of sets that are singular: worse than any other, so that line searches turn back.
SINGULAR = 10.0

Found = collections.namedtuple("Found", "centres lambdas error condition valid")


def cosine_bands(count):
    """Returns A_l: Int Y_lm(w) max(0, w . d) dw = A_l Y_lm(d)."""
    bands = np.zeros(count)
    bands[:3] = np.pi, NORM, np.pi / 4
    for band in range(4, count, 2):
        bands[band] = -bands[band - 2] * (band - 3) / (band + 2)
    return bands


BANDS = cosine_bands(400)
# P'_l = sum of (2k + 1) P_k over k = l - 1, l - 3, ...
_L, _K = np.indices((len(BANDS), len(BANDS)))
SLOPES = np.where((_K < _L) & ((_L - _K) % 2 == 1), 2 * _K + 1, 0)


def zonal(t, mu, power):
    """Returns f = sum_l (2l + 1) A_l^power mu^l P_l(t) and its derivatives by t and mu."""
    from scipy.special import eval_legendre
    count = min(len(BANDS), 2 + int(-37 / np.log(mu.max())))  # mu^count < 1e-16
    band = np.arange(count).reshape((-1,) + (1,) * t.ndim)
    p = eval_legendre(band, t)
    series = (2 * band + 1) * BANDS[:count].reshape(band.shape) ** power * mu ** band
    return ((series * p).sum(axis=0),
            (series * np.tensordot(SLOPES[:count, :count], p, 1)).sum(axis=0),
            (series * band * p).sum(axis=0) / mu)


class Objective:
    """Square error of a set and its bound of ln(condition), with gradients by centres (unit) and
    lambdas.

    With alpha_i(d) = Int b_i(w) max(0, w . d) dw, M = <alpha alpha^T> over the directions and Gram
    matrix A, the square error is 1 - tr(A^-1 M) / (2 pi/3), and the bound ln(tr A tr A^-1). """

    def __init__(self, directions, weights):
        self.directions, self.weights = directions, weights  # None: all directions alike

    @staticmethod
    def gram(x, l):
        """Returns 4 pi G(t; mu) of all pairs, its derivatives by t and mu, t and mu."""
        t, mu = np.clip(x @ x.T, -1, 1), np.outer(l, l)
        d = 1 - 2 * mu * t + mu * mu
        c = 4 * np.pi / (d * np.sqrt(d))
        a = (1 - mu * mu) * c
        return (a, 3 * mu * a / d, -2 * mu * c + 3 * a * (t - mu) / d), t, mu

    @staticmethod
    def pairs(weights, x, l, parts):
        """Returns the gradient of sum_ij weights_ij f_ij by centres and lambdas."""
        by_t = 2 * weights * parts[1]
        np.fill_diagonal(by_t, 0)
        return by_t @ x, (2 * weights * parts[2]) @ l

    def square_error(self, x, l):
        gram, t, mu = self.gram(x, l)
        s = np.linalg.inv(gram[0])
        if self.directions is None:
            parts = zonal(t, mu, 2)
            moment = parts[0]
            by_moment = self.pairs(-s / NORM, x, l, parts)
        else:
            alpha = zonal(x @ self.directions.T,
                          np.broadcast_to(l[:, None], (len(l), len(self.weights))), 1)
            moment = (alpha[0] * self.weights) @ alpha[0].T
            factor = -2 / NORM * self.weights * (s @ alpha[0])
            by_moment = (factor * alpha[1]) @ self.directions, (factor * alpha[2]).sum(axis=1)
        product = s @ moment
        by_gram = self.pairs(product @ s / NORM, x, l, gram)
        return 1 - np.trace(product) / NORM, by_gram[0] + by_moment[0], by_gram[1] + by_moment[1]

    def log_condition(self, x, l):
        gram, _, _ = self.gram(x, l)
        s = np.linalg.inv(gram[0])
        size, inverse_size = np.trace(gram[0]), np.trace(s)
        weights = np.eye(len(l)) / size - s @ s / inverse_size
        return np.log(size * inverse_size), *self.pairs(weights, x, l, gram)


def require(name, value, low, high):
    if not low <= value <= high:
        raise ValueError(f"{name}: found {value}, allowed: {low:g} to {high:g}")


class Unknowns:
    """The optimiser's vector: three numbers per centre, of which only the direction counts; then 0,
    1 or N lambdas."""

    def __init__(self, count, lambdas, start):
        self.count, self.start = count, start
        self.lambdas = {"none": 0, "one": 1, "each": count}[lambdas]
        self.bounds = [(None, None)] * (3 * count) + [LAMBDAS] * self.lambdas

    def random(self, generator):
        return np.concatenate([
            generator.normal(size=3 * self.count),
            np.full(self.lambdas, np.clip(self.start, *LAMBDAS))
        ])

    def set_of(self, v):
        """Returns centres and lambdas."""
        centres = v[:3 * self.count].reshape(-1, 3)
        lambdas = np.broadcast_to(
            np.clip(v[3 * self.count:], *LAMBDAS) if self.lambdas else self.start, self.count)
        return centres / np.linalg.norm(centres, axis=1, keepdims=True), lambdas

    def of(self, function):
        """Returns `function` of a set as one of a vector, with its gradient."""
        def value_and_gradient(v):
            x, lambdas = self.set_of(v)
            try:
                value, by_centre, by_lambda = function(x, lambdas)
            except np.linalg.LinAlgError:
                return SINGULAR, np.zeros(len(v))
            by_centre -= (by_centre * x).sum(axis=1, keepdims=True) * x
            by_centre /= np.linalg.norm(v[:3 * self.count].reshape(-1, 3), axis=1, keepdims=True)
            by_lambda = by_lambda if self.lambdas == self.count else by_lambda.sum(
                keepdims=True)[:self.lambdas]
            return value, np.concatenate([by_centre.ravel(), by_lambda])
        return value_and_gradient


def search(count, over="all", lambdas="one", start_lambda=0.25, max_condition=2e4, starts=64,
           seed=1):
    """Returns the best set of all starts: unit centres, their lambdas, error, condition number, and
    the number of starts that ended within the bounds.

    over: "all" (directions alike), "axes", or weights() of a file; lambdas: how many are optimised:
    "none", "one", "each". max_condition: rounding errors grow with its root; half precision
    tolerates srbf14's 1.8e4. Raises ValueError for values out of range, and if no start ends within
    the bounds.
    """
    from scipy.optimize import minimize
    require("count", count, 1, MAX_CENTRES)
    require("lambda", start_lambda, *LAMBDAS)
    require("max_condition", max_condition, 1, MAX_CONDITION)
    require("starts", starts, 1, 100000)
    if isinstance(over, str):
        over = (None, None) if over == "all" else (AXES, np.full(6, 1 / 6))
    objective, unknowns = Objective(*over), Unknowns(count, lambdas, start_lambda)
    error, condition = unknowns.of(objective.square_error), unknowns.of(objective.log_condition)
    bound = {
        "type": "ineq", "fun": lambda v: np.log(max_condition) - condition(v)[0],
        "jac": lambda v: -condition(v)[1]
    }
    generator, ends = np.random.default_rng(seed), []
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        # Steps beyond the bounds, which SciPy clips.
        warnings.simplefilter("ignore", RuntimeWarning)
        for _ in range(starts):
            v = minimize(error, unknowns.random(generator), jac=True, method="SLSQP",
                         bounds=unknowns.bounds, constraints=bound,
                         options={"ftol": 1e-10, "maxiter": 500}).x
            ends.append((condition(v)[0] - np.log(max_condition), error(v)[0], v))
    valid = [end for end in ends if end[0] <= 2 * SLACK and end[1] < 1]
    if not valid:
        smallest = max_condition * np.exp(min(end[0] for end in ends))
        raise ValueError(
            f"{count} centres: none of {starts} starts found a set with a condition "
            f"number of at most {max_condition:g}; smallest bound found: {smallest:.3g}; use a larger "
            "lambda, fewer centres or a larger bound")
    _, square, v = min(valid, key=lambda end: end[1])
    centres, bandwidths = unknowns.set_of(v)
    condition = float(np.linalg.cond(objective.gram(centres, bandwidths)[0][0]))
    return Found(centres, bandwidths, float(np.sqrt(max(square, 0))), condition, len(valid))


def minimum_error(count):
    """Returns the minimum over all bases of `count` functions, for all directions alike.

    Clamped cosines of all directions form a zonal operator whose eigenfunctions are spherical
    harmonics: the optimal basis spans those of the largest eigenvalues.
    """
    each = np.repeat(BANDS ** 2, 2 * np.arange(len(BANDS)) + 1) / (4 * np.pi)
    each = np.sort(each[each > 0])[::-1]
    return float(np.sqrt(max(0, 1 - each[:count].sum() / NORM)))


def weights(path):
    """Reads {"weights": [[x, y, z, weight], ...]}. Returns unit directions and weights, whose sum
    is 1. Raises BadDocument."""
    document = documents.read(pathlib.Path(path))
    rows = document.get("weights") if isinstance(document, dict) else None
    if not isinstance(rows, list) or not 1 <= len(rows) <= MAX_WEIGHTS:
        raise documents.BadDocument(
            f"{path}: /weights: allowed: an array of 1 to {MAX_WEIGHTS} entries [x, y, z, weight]")
    for i, row in enumerate(rows):
        numbers = isinstance(row, list) and len(row) == 4 and all(
            type(number) in documents.NUMBER for number in row)
        if not numbers or not np.isfinite(row).all() or not np.any(row[:3]) or row[3] <= 0:
            raise documents.BadDocument(
                f"{path}: /weights/{i}: found {json.dumps(row)[:80]}, allowed: [x, y, z, weight], "
                "a direction and a weight above 0")
    table = np.array(rows, float)
    directions, weights_of = table[:, :3], table[:, 3]
    return (directions / np.linalg.norm(directions, axis=1, keepdims=True),
            weights_of / weights_of.sum())


def document_of(name, found):
    """Returns the JSON of a file for --centres."""
    lambdas = found.lambdas.tolist()
    return {
        "name": name, "lambda": lambdas[0] if len(set(lambdas)) == 1 else lambdas,
        "centres": found.centres.tolist()
    }


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="clpv_lab.search", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", metavar="N", type=int,
                        help=f"number of centres (1 to {MAX_CENTRES})")
    over = parser.add_mutually_exclusive_group()
    over.add_argument("--over", choices=("all", "axes"), default="all",
                      help="directions of the cosines (default: all alike)")
    over.add_argument("--weights", metavar="FILE",
                      help="directions with weights")
    parser.add_argument("--lambdas", choices=("none", "one", "each"), default="one",
                        help="lambdas to optimise (default: one)")
    parser.add_argument("--lambda", dest="start_lambda", type=float, default=0.25, metavar="L",
                        help="lambda of all centres, or of the starts (default: 0.25)")
    parser.add_argument("--max-condition", type=float, default=2e4, metavar="C",
                        help="maximum condition number (default: 2e4)")
    parser.add_argument("--starts", type=int, default=64, metavar="K",
                        help="number of starts (default: 64)")
    parser.add_argument("--seed", type=int, default=1, metavar="S",
                        help="seed of the starts (default: 1)")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE.json",
                        help="output file, for --centres")
    given = vars(parser.parse_args(arguments))
    path, file, count = given.pop("output"), given.pop("weights"), given["count"]
    try:
        given["over"] = weights(file) if file else given["over"]
        if path:
            output.target_of(path, *filter(None, [file]))
        found = search(**given)
        if path:
            output.write(path, json.dumps(document_of(path.stem, found), indent=1) + "\n")
    except (output.Failure, ValueError) as error:
        print(error, file=sys.stderr)
        return getattr(error, "code", output.USAGE)
    print(
        f"error {found.error:.4f}; minimum of any {count} functions over all directions: "
        f"{minimum_error(count):.4f}\ncondition number {found.condition:.4g}; {found.valid} of "
        f"{given['starts']} starts ended within the bounds"
    )
    for (x, y, z), bandwidth in zip(found.centres, found.lambdas):
        print(f"{x:9.6f} {y:9.6f} {z:9.6f}  lambda {bandwidth:.6f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
