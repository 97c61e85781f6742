# SPDX-License-Identifier: MIT
"""Errors of an image against a ground truth, as `clpv compare` computes them."""
import numpy

try:
    import flip_evaluator  # of FLIP's authors, on PyPI
except ImportError:
    flip_evaluator = None

PIXELS_PER_DEGREE = 67.0206  # 3840 pixels over 0.7 m, seen from 0.7 m


def root_of_ratio(power, of):
    """None: undefined. No error at all is 0, also against black."""
    return float(numpy.sqrt(max(power, 0) / of)) if of > 0 else 0.0 if power == 0 else None


def gained(a, b):
    """Returns the factor of `a` that minimises the error, and the NRMSE with it; None where black
    has no such factor, and where only the truth is black."""
    power, of = (a * a).sum(), (b * b).sum()
    gain = (a * b).sum() / power if power > 0 else None
    explained = 0 if gain is None else gain * (a * b).sum()
    return gain, root_of_ratio(of - explained if of > 0 else power, of)


def errors(frames, truth, valid, exposure):
    """Errors of frames (n x height x width x 3) of one still view, over valid pixels.

    nrmse: root mean square error of all frames over the truth's root mean square. With several
    frames nrmse^2 = bias^2 + noise^2: bias is that of the mean of infinitely many such frames,
    noise their deviation from it. change: mean |difference| of consecutive frames over the truth's
    mean. exposure: of FLIP; None: values are not light, and have none. What a black truth leaves
    undefined is None. Sums are in double."""
    lit = frames[:, valid].astype(float)
    target = truth[valid].astype(float)
    power = (target * target).sum()
    gain, nrmse_best_gain = gained(lit, numpy.broadcast_to(target, lit.shape))
    total = target.sum()
    result = {"nrmse": root_of_ratio(((lit - target)**2).sum() / len(lit), power),
              "best_gain": gain, "nrmse_best_gain": nrmse_best_gain,
              "energy_ratio": lit.sum() / len(lit) / total if total else None}
    if exposure is not None and flip_evaluator:
        result["flip"] = numpy.mean(
            [flip_map(frame, truth, valid, exposure)[valid].mean() for frame in frames])
    if len(lit) > 1:
        variance = lit.var(axis=0, ddof=1).sum()
        off = ((lit.mean(axis=0) - target) ** 2).sum()
        change = abs(numpy.diff(lit, axis=0)).sum() / (len(lit) - 1)
        result |= {"bias": root_of_ratio(off - variance / len(lit), power),
                   "noise": root_of_ratio(variance, power),
                   "change": change / total if total else None}
    return result


def displayed(linear, exposure):
    """sRGB-encoded values of linear radiance at an exposure [EV], after tone curve ACES."""
    x = numpy.clip(2.0 ** exposure * linear, 0, 1e6)
    y = numpy.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
    return numpy.where(y <= 0.0031308, 12.92 * y, 1.055 * y**(1 / 2.4) - 0.055)


def flip_map(image, truth, valid, exposure):
    """FLIP (Andersson et al. 2020) of each pixel, 0 to 1; invalid ones are black in both. None
    without the package flip-evaluator."""
    if not flip_evaluator:
        return None
    shown = [displayed(numpy.where(valid[..., None], values, 0).astype(float), exposure)
             for values in (truth, image)]
    found = flip_evaluator.evaluate(*(each.astype(numpy.float32) for each in shown), "LDR", True,
                                    False, True, {"ppd": PIXELS_PER_DEGREE})
    return numpy.where(valid, found[0][..., 0], 0)
