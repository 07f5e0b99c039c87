"""Write docs/evidence.md: every claim of accuracy, computed from the comparisons.

    python -m studies.evidence FOLDER

FOLDER holds the paper's public data (``uniaxial``, ``dic``, ``bending``, ``compression``), force
bands of graded jersey from another paper (``graded``, see ``studies/graded_jersey.py``), and
swatches knitted by others (``knitdb``, see ``studies/knitdb.py``). Takes some minutes.
"""

import math
import sys
import textwrap
from collections.abc import Iterable, Sequence
from itertools import groupby, product
from pathlib import Path

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel
from knitcore.fit.calibration import FIELD_NOISE_PERCENT, ForceCurve, calibrate
from knitcore.fit.field_comparison import Edges, compare
from knitcore.fit.measured_field import load_field
from knitcore.materials import Interval, Laws, material, paper_figures
from knitcore.materials.law_uncertainty import Z_SCORE, log_interval
from knitcore.measure.bending_modulus import measure_bending
from knitcore.measure.compression import average_compression, fit_compression
from knitcore.measure.compression_files import read_compression
from knitcore.measure.uniaxial_files import read_stretch_test
from knitcore.mechanics.pressure import MMHG_PER_KPA, limb_pressure
from scripts.refit_laws import STRESSES, carried
from studies.against_knitted import errors, rms
from studies.figures import evidence as figures
from studies.graded_jersey import BOTH, LAWS, LENGTHS_MM, POISSON, STRAINS, band, graded
from studies.knitdb import compared, factor, ranks
from studies.true_to_tests import Summary, left_out, of_library, strips

ROOT = Path(__file__).resolve().parent.parent
DENSITY_G_PER_M = 0.5
"""Linear density of the acrylic yarn; the paper does not print it."""
CALIBRATED = "calibrated on the first two pictures"
DRAWN = ("the paper's model and law", "published law", "refitted law", CALIBRATED)
"""Rows of the displacement field that are drawn."""
HEAD = """# Evidence

How far to trust each number. The sections below come from the public data of Singal et al. and of
others, and from the present library, by a script (`python -m studies.evidence FOLDER`).

| what | how well | on which data | verdict |
|---|---|---|---|
| force of a strip of acrylic | within 5 % rms for a pull left out | 8 tests, 31 pulls | rely on it |
| its waist | within 0.024 rms | the same | rely on it, except at the start of a pull |
| force of a fabric without raw tests (cotton) | a factor of 1.4 to 1.6 rms | acrylic's fabrics left out | an order of size |
| initial modulus | reductions differ by a factor of 1.6 | acrylic | the least certain number |
| displacement field | 0.2 to 0.5 % of the width | one garter swatch | rely on it |
| shear | within a factor of 1.4 up to 30 % | one jersey, on which it was chosen | unproven; wide intervals |
| pressure | 24 of 24 overlap, on the tests that made the laws | acrylic's strips | arithmetic checked; no limb measured |
| relaxed size of a mixed chart | a factor of 1.07 rms where its rule was chosen, 1.13 on fresh swatches (all as stockinette: 1.10) | 29 and 29 swatches of one yarn | rough; count a swatch |
| stretch of a mixed chart | a factor of 1.2 in the median | yarn-level simulations only | unproven on cloth |
| size of a stitch at the yarn level | a factor of 1.17 rms | acrylic, cotton | rough |
| strains at the yarn level | a factor of 1.49 rms | acrylic, cotton | rough |
| moduli by reduced symmetry | a factor of 2.06 rms | acrylic, cotton | an order of size |
| bending and compression of a yarn | within 0.1 and 3 % of the paper's means | its photos and tests | rely on it |
"""  # noqa: E501


def table(head: str, rows: Iterable[Sequence[str]]) -> str:
    """A table, from the line of its heads and the cells of its rows."""
    rule = "|---" * (head.count("|") - 1) + "|"
    return "\n".join([head, rule, *(f"| {' | '.join(cells)} |" for cells in rows)])


def stretch(folder: Path) -> str:
    """Force and waist of the eight raw tests, by both sets of laws."""
    both = {laws: of_library(folder, laws) for laws in (Laws.PUBLISHED, Laws.REFITTED)}
    rows = []
    for fabric, direction in both[Laws.REFITTED]:
        old, new = (both[laws][fabric, direction] for laws in both)
        forces = [" / ".join(f"{v:.2f}" for v in row[0]) for row in (old, new)]
        waists = [f"{row[1][-1]:+.3f}".replace("-", "−") for row in (old, new)]
        rows.append([f"{fabric} {direction}-wise", *forces, *waists])
    in_sample = "\n".join(
        f"- {laws} laws, in sample: {Summary.of(list(tests.values()))}."
        for laws, tests in both.items()
    )
    pulls = left_out(folder)
    scatter = Summary.of([pull.same_sample for pull in pulls])
    figures.left_out_pulls(pulls)
    figures.waists(both[Laws.PUBLISHED], both[Laws.REFITTED])
    return f"""\
## Stretch tests: force and waist

Eight tests of acrylic, three or four pulls each, and a simulated swatch of the measured size. The
table gives simulated over measured force where the test carried {", ".join(map(str, STRESSES))}
N/mm, and the error of the waist strain at the last. The measured waist includes the widening of
cloth that flattens at the start of a pull, which the refitted laws leave out
([how](fit-a-law.md#how-constants-come-about)).

{table("| test | published | refitted | waist published | waist refitted |", rows)}

{in_sample}
- every pull predicted from the others: {Summary.of([p.other_sample for p in pulls])};
  using only pull-to-pull scatter, {scatter.inside} of {scatter.forces}.
- every fabric without its own raw tests, from its published law and the correction
  found on the other fabrics, as cotton's four are predicted: {carried(folder)}.

![Waists of the eight tests by both sets of laws](figures/evidence-waists.svg)

![Pulls predicted from the others](figures/left-out-pulls.svg)

Simulated over measured force of each pull left out; grey bars are the 90 % intervals at 0.1 N/mm.
*Not shown*: other samples of the same fabric, other widths than those tested, unloading, and time.
"""


def moduli() -> str:
    """Initial moduli of acrylic by both reductions."""
    figures.moduli()
    old, new = material("acrylic:published"), material("acrylic")
    ratios, rows = [], []
    for fabric in Fabric:
        cells = [str(fabric)]
        for direction in Direction:
            record = new.record(fabric)
            value = record.law.modulus(direction)
            ends = log_interval(value, record.uncertainty.log_modulus(direction))
            ratios.append(np.log(old.law(fabric).modulus(direction) / value))
            cells += [f"{old.law(fabric).modulus(direction):.3f}"]
            cells += [f"{value:.3f} ({ends.low:.3f} to {ends.high:.3f})"]
        rows.append(cells)
    head = "| | course-wise: published | refitted | wale-wise: published | refitted |"
    return f"""\
## Initial moduli

Acrylic, N/mm: the paper's reduction (strain from the middle to the lower clamp, straining evenly),
and the law refitted to the simulated test with its 90 % interval.

{table(head, rows)}

![Refitted against published moduli](figures/evidence-moduli.svg)

The reductions differ by a factor of {np.exp(rms(np.array(ratios))):.2f} rms: an initial modulus is
the least certain number of a stretch test. *Not shown*: other yarns, whose raw tests are not
public.
"""


def pressures(folder: Path) -> str:
    """Measured force of a strip as the pressure of a tube, and the library's interval."""
    rest = 200.0
    inside = total = 0
    ranges, rows = [], []
    for fabric in Fabric:
        for strip in strips(folder, fabric):
            record = material("acrylic").record(fabric)
            for share in (0.25, 0.5, 0.75):
                strain = share * float(strip.strain[-1])
                stress, waist = (float(np.interp(strain, strip.strain, v)) for v in strip.means)
                worn = rest * (1 + strain)
                held = 2 * math.pi * stress / worn * 1000 * MMHG_PER_KPA
                free = held / (1 + waist)
                interval = limb_pressure(record.law, strip.direction, rest, worn).mmhg
                sd = float(record.uncertainty.log_stress(strip.direction, stress))
                factor = math.exp(Z_SCORE * sd)
                low, high = interval.low / factor, interval.high * factor
                inside += int(low <= free and held <= high)
                ranges.append((fabric, Interval(held, free), Interval(low, high)))
                total += 1
                if share == 0.5:
                    between = [(held, free), (interval.low, interval.high), (low, high)]
                    spans = [f"{first:.0f} to {last:.0f}" for first, last in between]
                    name = f"{fabric} {strip.direction}-wise"
                    rows.append([name, f"{worn:.0f}", f"{stress:.3f}", *spans])
    figures.pressures(ranges)
    head = "| test | worn, mm | σ measured, N/mm | P from it, mmHg | predicted | with interval |"
    return f"""\
## Pressure: from a strip to a cylinder

A tube {rest:.0f} mm around is worn on a cylinder that stretches it as far as acrylic's test was at
half of its largest strain. In Laplace's law P = 2πT/C, T is the test's force over width σ where the
tube keeps its length and σ/(1 + waist) where it narrows as the strip did. Predicted: the refitted
law, from axially free to fixed, and with its 90 % interval.

{table(head, rows)}

![Pressure by the measured force against the predicted](figures/evidence-pressure.svg)

At a quarter, half and three quarters of the strain, {inside} of {total} measured ranges overlap the
interval. The refitted laws rest on these tests, so this shows the arithmetic and the narrowing, not
a new sample. *Not shown*: a pressure measured on a limb, friction, and relaxation with time.
"""


def bending(folder: Path) -> str:
    """Bending modulus of acrylic from the authors' photos."""
    photos = sorted(folder.glob("*.jpg"))
    lengths = [10.0 * float(photo.stem.split("_")[0]) for photo in photos]
    bent = measure_bending(photos, linear_density_g_per_m=DENSITY_G_PER_M, length_mm=lengths)
    paper = paper_figures().get("acrylic", "B")
    figures.bending(bent, paper.corrected / 1000)
    return f"""\
## Bending of the yarn

![Bending modulus of every photo](figures/evidence-bending.svg)

{len(photos)} photos of acrylic yarn hanging over an edge, 10 to 25 cm long: B is
{1000 * bent.bending_modulus_n_mm2:.1f} ± {1000 * (bent.standard_deviation or 0):.1f} mN·mm² (one
photo), the paper has {paper.corrected:g}. B is proportional to the linear density, taken as
{DENSITY_G_PER_M} g/m. *Not shown*: the other yarns, and any set of the yarn.
"""


def yarn_models() -> str:
    """Models of the yarn against knitted fabric."""
    by_model = errors()
    figures.yarn_models(by_model)
    rows = [(name, f"{np.exp(rms(logs)):.2f}", str(logs.size)) for name, logs in by_model.items()]
    return f"""\
## Models of the yarn against knitted fabric

The four pure fabrics of acrylic and cotton (`python -m studies.against_knitted`). `relax`, `sweep`
and `rs` state these as their intervals.

{table("| | rms factor | values |", rows)}

![Models of the yarn against knitted fabric](figures/evidence-yarn-models.svg)

*Not shown*: mixed charts, of which there are no stretch tests; friction and set, which the yarn
level leaves out.
"""


def relaxed_sizes(folder: Path) -> str:
    """Relaxed sizes of swatches knitted by others."""
    names, _, first, true, logs, spread = compared(folder, material("lace-acrylic"))
    others = np.arange(len(names)) != first
    inside = (np.abs(logs - true) <= Z_SCORE * spread)[others]
    figures.relaxed_sizes(true[others], logs[others], spread[others])
    return f"""\
## Relaxed sizes

![Predicted against knitted sizes](figures/evidence-relaxed-sizes.svg)

{len(names)} knit and purl swatches of one acrylic yarn, knitted and measured by others (KnitDB;
Hofmann et al., KnitPick, UIST 2019). Widths and heights relative to stockinette are compared, with
the pure fabrics of `lace-acrylic` in place of that yarn's. Rms factors: predicted
{factor(logs - true)}; all like stockinette {factor(true)}. Rank correlation: {ranks(logs, true)}.
Of {inside.size} sizes {inside.mean():.0%} lie in the 90 % intervals. One number of the model was
fitted to these swatches ([mixed charts](mixed-charts.md)). *Not shown*: other yarns, and the
absolute size of a stitch, which is the gauge.
"""


def gradings(folder: Path) -> str:
    """Force of single jersey at two loop lengths."""
    at_10 = np.array([0.1])
    stiff, soft = (float(band(folder, f"const{mm}_ww", at_10)[0]) for mm in (4.5, 6.5))
    simulated = [
        np.array(
            [
                graded(folder, poisson, coupled=coupled, ends=(end,)).side_by_side_force(STRAINS)
                for poisson in POISSON
                for end in BOTH
            ]
        )
        for coupled in (False, True)
    ]
    measured = np.array([band(folder, "discont4.5to6.5_ww", STRAINS, (end,)) for end in BOTH])
    rows = []
    for place, strain in enumerate(STRAINS):
        columns = [values[:, place] for values in (measured, *simulated)]
        rows.append([f"{strain:.0%}", *(f"{v.min():.1f} to {v.max():.1f}" for v in columns)])
    names = ("measured", "simulated, κ = 0", "simulated, with κ")
    bands = (np.array([v.min(axis=0), v.max(axis=0)]) for v in (measured, *simulated))
    figures.side_by_side(dict(zip(names, bands, strict=True)), STRAINS)
    return f"""\
## Loop length

Single jersey with loops of 4.5 and 6.5 mm (Do, Tan, Ramos, Kiendl, Weeger, Composites Part B 2020,
CC BY 4.0), pulled wale-wise to 10 %: the force falls by a factor of {stiff / soft:.1f} (middles of
the measured bands); the yarn level's scale of stress, B/L³, gives {(6.5 / 4.5) ** 3:.1f}. A strip
with one half of each, side by side, was pulled too. The table gives its force in N, measured and
simulated with laws fitted to the uniform cloths, at either end of their bands and with all
Poisson's ratios as above:

{table(f"| strain | {' | '.join(names)} |", rows)}

![Force of the strip with two loop lengths](figures/evidence-loop-length.svg)

*Not shown*: the number and the width of the samples; loops of other lengths.
"""


def field(folder: Path) -> str:
    """Displacements of the acrylic garter swatch, pulled wale-wise."""
    pictures = load_field(folder / "dic" / "garter_acrylic_y.npz")
    published = material("acrylic:published").law(Fabric.GARTER)
    refitted = material("acrylic").law(Fabric.GARTER)
    test = read_stretch_test(folder / "uniaxial" / "outputData_Acrylic Yarn Garter Y.h5")
    forces = ForceCurve.of_test(test, float(test.length_mm or 0.0) / test.width_mm[0])
    first, every = (
        calibrate(pictures.only(used), refitted, Direction.WALE, forces=forces)
        for used in ({9, 17}, {9, 17, 25})
    )
    as_published = SheetModel(EnergyModel.PUBLISHED)
    models = [
        ("the paper's model and law, rigid edges", published, as_published, Edges.RIGID),
        ("the paper's model and law", published, as_published, Edges.MEASURED),
        ("published law", published, SheetModel(), Edges.MEASURED),
        ("refitted law, rigid edges", refitted, SheetModel(), Edges.RIGID),
        ("refitted law", refitted, SheetModel(), Edges.MEASURED),
        (CALIBRATED, first.law, SheetModel(), Edges.MEASURED),
        ("calibrated on all three", every.law, SheetModel(), Edges.MEASURED),
    ]
    head = [f"stretch {pictures.stretch(frame):.2f}" for frame in pictures.frames]
    across, rows = {}, []
    for name, law, model, edges in models:
        frames = compare(pictures, law, Direction.WALE, edges=edges, model=model).frames
        cells = (f"{f.ux_rms_percent_width:.2f} / {f.uy_rms_percent_width:.2f}" for f in frames)
        rows.append([name, *cells])
        across[name] = [f.ux_rms_percent_width for f in frames]
    drawn = {name: across[name] for name in DRAWN}
    figures.field(drawn, list(map(pictures.stretch, pictures.frames)), FIELD_NOISE_PERCENT)
    loaded = first.force_ratio[1:]
    return f"""\
## Displacement field

Acrylic garter pulled wale-wise. Differences of displacements, u_x / u_y, root mean square in
percent of the width, with the measured motion of the edges imposed or, in rows marked *rigid
edges*, its mean.

{table(f"| | {' | '.join(head)} |", rows)}

![Differences of displacements across the pull](figures/evidence-field.svg)

The refitted law rests on the stretch tests only, so its row is a true test. The calibrated laws
also keep the force of the stretch test ({loaded.min():.2f} to {loaded.max():.2f} from a strain of
{first.force_strain[1]:.2f} on, {first.force_ratio[0]:.2f} at {first.force_strain[0]:.2f}). Half the
difference of the swatch's left and right side is {FIELD_NOISE_PERCENT} % of the width, which no
simulation of even cloth can follow. *Not shown*: other fabrics and directions; larger stretches.
"""


def compression(folder: Path) -> str:
    """Compression constants compared with the paper's."""
    tests = read_compression(folder / "compressionTests.xls")
    samples = [fit_compression(test) for test in tests]
    means = {m.yarn: m for m in average_compression(samples)}
    paper, rows = {}, []
    for yarn in ("acrylic", "cotton"):
        k, p = (paper_figures().get(yarn, name).corrected for name in ("k", "p"))
        paper[yarn], mean = (k, p), means[yarn]
        rows.append([yarn, f"{1000 * mean.k_n_per_mm3:.3g} ({k:g})", f"{mean.p:.3f} ({p:g})"])
    figures.compression(samples, paper)
    return f"""\
## Compression of the yarn

{table("| yarn | k, mN/mm³ (paper) | p (paper) |", rows)}

![Constants of every sample](figures/evidence-compression.svg)

*Not shown*: the other six yarns, which have no compression tests.
"""


def shear(folder: Path) -> str:
    """A bias strip of graded jersey with one shear modulus, without and with couplings."""
    matched: dict[str, list[float]] = {}
    missed: dict[str, list[Array]] = {}
    worst: dict[str, float] = {}
    rows = []
    for (name, (coupled, growth)), poisson in product(LAWS.items(), POISSON):
        test = graded(folder, poisson, coupled=coupled, shear_stiffening=growth)
        for length in LENGTHS_MM:
            ratio = test.matching_ratio(length)
            forces = test.bias_force(ratio, length, STRAINS) / test.force_n
            matched.setdefault(name, []).append(ratio)
            missed.setdefault(name, []).append(forces)
            worst[name] = max(worst.get(name, 1.0), *np.exp(np.abs(np.log(forces))))
            if (poisson, length) == (0.3, 100):
                assumed = f"{poisson}, {length:.0f} mm"
                rows.append([name, assumed, f"{ratio:.2f}", *(f"{force:.2f}" for force in forces)])
    shares = []
    for fabric in Fabric:
        law = material("acrylic").law(fabric)
        share = law.shear_modulus / np.sqrt(law.modulus_course * law.modulus_wale)
        shares.append(f"{fabric} {share:.2f}")
    figures.shear({name: np.array(ratios) for name, ratios in missed.items()}, STRAINS)
    largest = ", ".join(f"{factor:.2f} ({name})" for name, factor in worst.items())
    strains = " ".join(f"{strain:.0%} |" for strain in STRAINS)
    return f"""\
## Shear

Graded single jersey cut at 45° (Do, Tan, Ramos, Kiendl, Weeger, Composites Part B 2020, CC BY 4.0).
The laws are fitted to the same cloth pulled straight, with the κ of acrylic stockinette; the shear
modulus, a share of the geometric mean of Young's moduli, is matched to the force at 10 %. Simulated
over measured force:

{table(f"| | Poisson's ratio, length assumed | shear modulus | {strains}", rows)}

Other ratios and lengths are in the figure.

![Force of the bias strip by three laws](figures/evidence-shear.svg)

The largest factor by which a force is missed is {largest}. So part of the stiffening comes from the
coupling, and the rest from shear itself. Its one number was chosen on this strip, so the table does
not prove it, and the yarn level does not confirm it ([decisions](decisions.md#shear)). The interval
of the number includes both. This jersey has a share of {min(matched[name]):.2f} to
{max(matched[name]):.2f}; the library's acrylic has, from its tests and a broad prior,
{", ".join(shares)}. The intervals allow for a factor of three to five either way. *Not shown*:
width (50 mm is assumed), length and Poisson's ratios of the specimens; other yarns and fabrics;
unloading.
"""


def wrapped(text: str) -> str:
    """A text with the lines of each paragraph joined and broken anew."""
    lines = []
    for kept, group in groupby(text.split("\n"), lambda line: not line or line[0] in "|#!- "):
        part = list(group)
        lines += part if kept else textwrap.wrap(" ".join(part), 100, break_on_hyphens=False)
    return "\n".join(lines)


def main() -> None:
    folder = Path(sys.argv[1])
    sections = [
        stretch(folder / "uniaxial"),
        pressures(folder / "uniaxial"),
        moduli(),
        field(folder),
        shear(folder / "graded"),
        gradings(folder / "graded"),
        relaxed_sizes(folder / "knitdb"),
        yarn_models(),
        bending(folder / "bending"),
        compression(folder / "compression"),
    ]
    text = "\n".join([HEAD, wrapped("\n".join(sections))]).rstrip() + "\n"
    (ROOT / "docs" / "evidence.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
