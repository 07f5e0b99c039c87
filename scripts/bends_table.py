"""Make the table of bending again: ``python -m scripts.bends_table``.

It has the library's materials whose repeats are not in the store.
"""

import csv
from dataclasses import fields
from pathlib import Path

from knitcore.chart.fabric import Fabric
from knitcore.cloth.space.bending_constants import Bend, computed
from knitcore.materials.library import load_library
from knitcore.yarn.library.store import MATERIALS

FILE = Path(__file__).parent.parent / "knitcore" / "cloth" / "space" / "data" / "bends.csv"

if __name__ == "__main__":
    names = [field.name for field in fields(Bend)]
    with FILE.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, ["material", "fabric", *names], lineterminator="\n")
        writer.writeheader()
        for identifier, material in load_library().items():
            if identifier in MATERIALS:
                continue
            for fabric in Fabric:
                bend = computed(fabric, material)
                values = {name: f"{getattr(bend, name):.5g}" for name in names}
                writer.writerow({"material": identifier, "fabric": fabric.value} | values)
