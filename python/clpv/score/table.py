# SPDX-License-Identifier: MIT
"""Tables of scores, as text and as HTML."""
import html

# Title, key, factor and digits.
COLUMNS = [("NRMSE [%]", "nrmse", 100, 1), ("at best gain", "nrmse_best_gain", 100, 1),
           ("energy", "energy_ratio", 1, 3), ("FLIP", "flip", 1, 3), ("bias [%]", "bias", 100, 1),
           ("noise [%]", "noise", 100, 1), ("change [%]", "change", 100, 1)]


def cells(rows, names):
    """Titles, then a line for each row: its `names` and errors. `-`: undefined."""
    columns = [column for column in COLUMNS if any(column[1] in row for row in rows)]
    return [[*names, *(title for title, *_ in columns)]] + [[
        *(row[name] for name in names),
        *("-" if row.get(key) is None else f"{factor * row[key]:.{digits}f}"
          for _, key, factor, digits in columns)
    ] for row in rows]


def text(score):
    """Lines of text: a view each, then the mean."""
    lines = cells([*score["views"], {"view": "mean", **score["mean"]}], ["view"])
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(
        cell.ljust(width) if i == 0 else cell.rjust(width)
        for i, (cell, width) in enumerate(zip(line, widths))) for line in lines)


def markup(rows):
    """HTML: a line for each view and image, then what is suspected."""
    title, *lines = cells(rows, ["view", "image"])

    def line(tag, values):
        return f"<tr>{''.join(f'<{tag}>{html.escape(value)}</{tag}>' for value in values)}</tr>"

    said = [f"{row['view']}, {row['image']}: {words}" for row in rows for words in row["suspected"]]
    return "\n".join([
        '<div class="scroll" id="scores"><table>', line("th", title), *(line("td", cells) for cells in lines),
        "</table></div>", *(f'<p class="soft">{html.escape(words)}</p>' for words in said)
    ])
