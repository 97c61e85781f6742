# SPDX-License-Identifier: MIT
"""python3 -m clpv_lab.searches: the searches of docs/bases.md, as JSON on stdout."""
import concurrent.futures
import itertools
import json

from clpv_lab import search

SEARCHES = [*itertools.product((4, 6, 8, 9, 12, 14), ("all", "axes"), ("none", "one", "each"))]


def searched_for(count, over, lambdas):
    found = search.search(count, over, lambdas)
    return {"n": count, "over": over, "lambdas": lambdas, "error": found.error,
            "bound": search.minimum_error(count) if over == "all" else None,
            "condition": found.condition, "lambda": 0 if lambdas == "each" else found.lambdas[0]}


if __name__ == "__main__":
    with concurrent.futures.ProcessPoolExecutor() as processes:
        print(json.dumps(list(processes.map(searched_for, *zip(*SEARCHES)))))
