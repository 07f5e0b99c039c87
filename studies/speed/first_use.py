"""CPU seconds of a command's first use on a machine, when kernels are compiled, with their goal.

    python -m studies.speed.first_use [COMMAND …]

Each has its own empty cache of kernels. Other processes compile a share of them; what they take is
shown beside it.
"""

import argparse
import os
import subprocess
import sys
import tempfile

GOAL_S = 10.0
COMMANDS = {
    "relax": ("K/P", "--fresh"),
    "sweep": ("K/P", "--direction", "course", "--max-strain", "0.3", "--points", "7", "--fresh"),
    "curl": ("KP", "--size", "12x8"),
    "bend": ("KKP", "--loop-length-mm", "12"),
    "predict": ("KKPP",),
}
TIMED = """
import atexit, resource, runpy, sys

def tell():
    for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN):
        used = resource.getrusage(who)
        print(used.ru_utime + used.ru_stime, file=sys.stderr)

atexit.register(tell)
runpy.run_module("app.cli.main", run_name="__main__")
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commands", nargs="*", default=list(COMMANDS), metavar="COMMAND")
    for name in parser.parse_args().commands:
        words = [name, *COMMANDS[name], "--material", "acrylic"]
        with tempfile.TemporaryDirectory() as folder:
            places = {"NUMBA_CACHE_DIR": f"{folder}/kernels", "KNITCORE_DATA_DIR": f"{folder}/data"}
            for use in ("first", "second"):
                stderr = subprocess.run(
                    [sys.executable, "-c", TIMED, *words], env=os.environ | places, check=True,
                    capture_output=True, text=True,
                ).stderr  # fmt: skip
                own, others = map(float, stderr.split()[-2:])
                print(
                    f"{name:8} {use:6} {own:5.1f} s, goal {GOAL_S:g} s: ratio {own / GOAL_S:.2f}; "
                    f"other processes {others:.1f} s",
                    flush=True,
                )


if __name__ == "__main__":
    main()
