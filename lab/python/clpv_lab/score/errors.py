# SPDX-License-Identifier: MIT
"""Errors of an image against a ground truth, as `clpv compare` computes them."""
import numpy

from clpv_lab.score import flip


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
    result = {
        "nrmse": root_of_ratio(((lit - target)**2).sum() / len(lit),
                               power), "best_gain": gain, "nrmse_best_gain": nrmse_best_gain,
        "energy_ratio": lit.sum() / len(lit) / total if total else None
    }
    if exposure is not None:
        result["flip"] = numpy.mean(
            [flip_map(frame, truth, valid, exposure)[valid].mean() for frame in frames])
    if len(lit) > 1:
        variance = lit.var(axis=0, ddof=1).sum()
        off = ((lit.mean(axis=0) - target) ** 2).sum()
        result |= {
            "bias": root_of_ratio(off - variance / len(lit),
                                  power), "noise": root_of_ratio(variance, power),
            "change": abs(numpy.diff(lit, axis=0)).sum() / (len(lit) - 1) / total if total else None
        }
    return result


def flip_map(image, truth, valid, exposure):
    """FLIP of each pixel; invalid ones are black in both."""
    shown = [
        flip.displayed(numpy.where(valid[..., None], values, 0).astype(float), exposure)
        for values in (image, truth)
    ]
    return flip.flip(*shown)
