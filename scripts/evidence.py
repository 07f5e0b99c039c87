"""Write docs/evidence.md: every claim of accuracy, computed from the comparisons.

    python scripts/evidence.py FOLDER

FOLDER is the paper's public data (``uniaxial``, ``dic``, ``compression``) and the bands of graded
jersey of another (``graded``, see ``benchmarks/bias_strip.py``). Takes some minutes.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.bias_strip import LENGTHS_MM, POISSON, STRAINS, graded  # noqa: E402
from benchmarks.true_to_tests import STRESSES, Summary, left_out, of_library  # noqa: E402
from knitcore.fabric import Direction, Fabric  # noqa: E402
from knitcore.materials import Laws, material, paper_figures  # noqa: E402
from knitcore.measure.compression import average_compression, fit_compression  # noqa: E402
from knitcore.measure.compression_files import read_compression  # noqa: E402
from knitcore.swatch.calibration import calibrate  # noqa: E402
from knitcore.swatch.comparison import Edges, compare  # noqa: E402
from knitcore.swatch.measured import load_field  # noqa: E402

HEAD = """# Evidence

How far to trust each number. `python scripts/evidence.py FOLDER` makes this page from the public
data of Singal et al. (raw stretch tests, displacement pictures, compression tests) and from the
library as it is. No figure here is typed in by hand.
"""


def stretch(folder: Path) -> list[str]:
    """Force and waist of the eight raw tests, by both sets of laws."""
    lines = ["## Stretch tests: force and waist", ""]
    lines += [
        "Eight tests of acrylic, three or four pulls each. A swatch of the measured size is",
        "simulated at the clamp-to-clamp strain at which the test carried",
        f"{', '.join(map(str, STRESSES))} N/mm. Simulated over measured force at each; waist",
        "strain, simulated minus measured, at the last.",
        "",
        "| test | published | refitted | waist published | waist refitted |",
        "|---|---|---|---|---|",
    ]
    both = {laws: of_library(folder, laws) for laws in (Laws.PUBLISHED, Laws.REFITTED)}
    for fabric, direction in both[Laws.REFITTED]:
        old, new = (both[laws][fabric, direction] for laws in both)
        forces = [" / ".join(f"{v:.2f}" for v in row[0]) for row in (old, new)]
        waists = [f"{row[1][-1]:+.3f}" for row in (old, new)]
        lines.append(f"| {fabric} {direction}-wise | {' | '.join([*forces, *waists])} |")
    lines.append("")
    for laws, rows in both.items():
        lines.append(f"- {laws} laws, in sample: {Summary.of(list(rows.values()))}.")
    lines += [
        f"- every pull predicted from the others: {Summary.of(left_out(folder))}.",
        "- a fabric whose published law is carried over by the other fabrics' correction, its own",
        "  tests unseen: `python scripts/refit_laws.py --tests FOLDER --check` prints it.",
        "",
        "*Not shown*: other samples of the same fabric, other widths than those tested, unloading,",
        "and time. The intervals hold reading errors of width (3 %) and length (1.5 %) that all",
        "pulls of one sample share, so they cover more than 90 % of the pulls of that sample.",
        "",
    ]
    return lines


def field(folder: Path) -> list[str]:
    """Displacements of the acrylic garter swatch, pulled wale-wise."""
    pictures = load_field(folder / "garter_acrylic_y.npz")
    published = material("acrylic:published").law(Fabric.GARTER)
    calibrated = calibrate(pictures.only({9, 17}), published, Direction.WALE).law
    rows = {
        "published law": published,
        "refitted law": material("acrylic").law(Fabric.GARTER),
        "calibrated on the first two pictures": calibrated,
    }
    lines = ["## Displacement field", ""]
    lines += [
        "Acrylic garter pulled wale-wise; u_x, root mean square in percent of the width, with the",
        "measured motion of the edges imposed.",
        "",
    ]
    head = [f"stretch {pictures.stretch(frame):.2f}" for frame in pictures.frames]
    lines += [f"| | {' | '.join(head)} |", "|---" * (len(head) + 1) + "|"]
    for name, law in rows.items():
        found = compare(pictures, law, Direction.WALE, edges=Edges.MEASURED).frames
        lines.append(f"| {name} | {' | '.join(f'{f.ux_rms_percent_width:.2f}' for f in found)} |")
    lines += [
        "",
        "The last picture of the last row is an extrapolation. *Not shown*: other fabrics and",
        "directions. The shear modulus of the refitted laws is mostly a prior.",
        "",
    ]
    return lines


def compression(folder: Path) -> list[str]:
    """Compression constants compared with the paper's."""
    tests = read_compression(folder / "compressionTests.xls")
    means = {m.yarn: m for m in average_compression([fit_compression(t) for t in tests])}
    lines = [
        "## Compression of the yarn",
        "",
        "| yarn | k, mN/mm³ (paper) | p (paper) |",
        "|---|---|---|",
    ]
    for yarn in ("acrylic", "cotton"):
        k, p = (paper_figures().get(yarn, name).corrected for name in ("k", "p"))
        found = means[yarn]
        lines.append(f"| {yarn} | {1000 * found.k_n_per_mm3:.3g} ({k:g}) | {found.p:.3f} ({p:g}) |")
    lines += ["", "*Not shown*: the other six yarns, which have no compression tests.", ""]
    return lines


def shear(folder: Path) -> list[str]:
    """A bias strip of graded jersey with one shear modulus."""
    lines = [
        "## Shear",
        "",
        "Graded single jersey cut at 45° (Do, Tan, Ramos, Kiendl, Weeger, Composites Part B 2020,",
        "CC BY 4.0). Laws from the same cloth pulled straight; the shear modulus, as a share of",
        "the geometric mean of Young's moduli, is the one that has the measured force at 10 %.",
        "Simulated over measured force:",
        "",
        "| Poisson's ratio, length assumed | shear modulus | " + strains(),
        "|---|---|" + "---|" * len(STRAINS),
    ]
    for poisson in POISSON:
        test = graded(folder, poisson)
        for length in LENGTHS_MM:
            ratio = test.matching_ratio(length)
            forces = test.bias_force(ratio, length, STRAINS) / test.force_n
            told = " | ".join(f"{force:.2f}" for force in forces)
            lines.append(f"| {poisson}, {length:.0f} mm | {ratio:.2f} | {told} |")
    lines += [
        "",
        "A constant shear modulus does not reproduce the stiffening. *Not shown*: width (50 mm is",
        "assumed), length and Poisson's ratios of the specimens, which the files do not tell;",
        "other yarns and fabrics; unloading.",
        "",
    ]
    return lines


def strains() -> str:
    """The heads of columns."""
    return " ".join(f"{strain:.0%} |" for strain in STRAINS)


def main() -> None:
    folder = Path(sys.argv[1])
    sections = [
        *stretch(folder / "uniaxial"),
        *field(folder / "dic"),
        *shear(folder / "graded"),
        *compression(folder / "compression"),
    ]
    text = "\n".join([HEAD, *sections]).rstrip() + "\n"
    (ROOT / "docs" / "evidence.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
