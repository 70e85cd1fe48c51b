"""Prints the mutants that survived scripts/mutants and are not explained here.

A change that alters no result cannot be noticed by a test of results: the table says of
each such line why it alters none.
"""

from __future__ import annotations

import re
import subprocess
import sys

FASTER = "only time: the other branch computes the same"
EQUAL = "only at equality, where both branches give the same"

EQUIVALENT = (
    # clearance
    (r'order=(None|"c")|np\.subtract\(place\[:, 1\], \w.*, \)$', "order in memory"),
    (r"reshape\(-2, ", "NumPy takes any negative length for the one to be found"),
    (r"np\.min\(apart, axis=\+1,", "the last of two axes"),
    (r"in_blocks\(block, len\(poses\),", "threads and the size of blocks: only time"),
    (r"crossing = determinant >= UNTURNED", EQUAL),
    (r"turned = square >= PARALLEL", EQUAL),
    (r"on_axis = length < PARALLEL", EQUAL),
    (r"parallel = .* < PARALLEL", EQUAL),
    (r"lateral = .* < np\.minimum\(gap, 0\.0\)", EQUAL),
    (r"rising = slope\(t\) >= 0", "on a plateau all points are least"),
    (r"rim = \((side|end) >= 0\)|\(end >= 0\)$", EQUAL),
    (r"np\.where\(rim, gap, 2\.0\)", "the entry is not used where there is no rim"),
    (r"return gap, normal, ~rim & \(side > end\)", "on the bisector of two faces"),
    (r"np\.add\.reduce\(first \* second, \)", "the first axis is the default"),
    (r'np\.einsum\("\.\.\.I,', "another letter for the index"),
    # grasp
    (r"if count < BLOCK:", "one block, joined with none, is itself"),
    (r"if branch\.largest_extent < far and", "the checks that follow let it pass"),
    (r"<= far and branch\.least_radius > thin", "the checks that follow let it pass"),
    (r"extent < far, most, remedy", "reached only where the radius is refused"),
    (r"radius > thin, least,", "reached only where the extent is refused"),
    (r"if \(values\.shape == shape\) and False else", FASTER),
    (r"replace\(parts\[1\], branch=branch,", "parts differ in their arrays alone"),
    # kinematics
    (r"if \(values is controls\) or True else", "one more copy"),
)


def main() -> int:
    """Print what survived unexplained; 1 if anything did."""
    survivors = [x.split(":")[0].strip() for x in _mutmut("results") if _left(x)]
    changed = {name: _change(name) for name in survivors}
    unexplained = {n: line for n, line in changed.items() if not _explained(line)}
    known = len(changed) - len(unexplained)
    print(f"{len(changed)} survived, of which {known} are explained")
    for name, line in unexplained.items():
        print(f"{name}\n    {line}")
    return int(bool(unexplained))


def _left(result: str) -> bool:
    """Whether no test noticed a mutant: neither by failing nor by not ending."""
    return result.endswith((": survived", ": no tests", ": suspicious"))


def _explained(line: str) -> bool:
    return any(re.search(pattern, line) for pattern, _ in EQUIVALENT)


def _change(name: str) -> str:
    """The line that a mutant put in another's place."""
    lines = _mutmut("show", name)
    added = [x[1:] for x in lines if x.startswith("+") and not x.startswith("+++")]
    return " ".join(x.strip() for x in added)


def _mutmut(*arguments: str) -> list[str]:
    done = subprocess.run(
        ["mutmut", *arguments], check=True, capture_output=True, text=True
    )
    return done.stdout.splitlines()


if __name__ == "__main__":
    sys.exit(main())
