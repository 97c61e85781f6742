# SPDX-License-Identifier: MIT
"""Chart of `clpv bench`: times of suite `layouts`. It goes by fields of rows, not by names."""
from clpv.draw import style
from clpv.draw.documents import NUMBER, TEXT_OR_NULL

ROW = {"suite": str, "stage": str, "status": str, "basis": TEXT_OR_NULL, "layout": TEXT_OR_NULL,
       "storage": TEXT_OR_NULL, "occlusion": bool, "median": NUMBER, "min": NUMBER, "p95": NUMBER}


def distinct(values):
    return list(dict.fromkeys(values))


def work_of(row):
    return f"{row['stage']} {row['basis']}" + (", occlusion" if row["occlusion"] else "")


def layouts(rows):
    rows = [row for row in rows if row["suite"] == "layouts" and row["status"] == "ok"]
    groups = distinct(map(work_of, rows))
    if not groups:
        return None
    figure, axes = style.panels(len(groups), 2, (4.5, 2.4))
    for axis, group in zip(axes, groups):
        members = sorted((r for r in rows if work_of(r) == group), key=lambda r: r["median"])
        names = [f"{r['layout']}/{r['storage']}{'' if r.get('filtered', True) else ' texels'}"
                 for r in members]
        colours = [style.colour(1 if r["layout"] == "image" else 0) for r in members]
        whiskers = [[max(0.0, r["median"] - r["min"]) for r in members],
                    [max(0.0, r["p95"] - r["median"]) for r in members]]
        axis.barh(names, [r["median"] for r in members], xerr=whiskers, color=colours,
                  error_kw={"lw": 0.8, "ecolor": style.INK})
        style.logarithmic(axis.xaxis)
        axis.set(title=group, xlabel="ms (median; whiskers: minimum to 95 %)")
        axis.invert_yaxis()
        for i, r in enumerate(members):
            axis.annotate(f"{r['median']:.2f}", (r["median"], i), textcoords="offset points",
                          xytext=(4, 5), size=7)
    return figure
