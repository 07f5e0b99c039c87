"""Draw the gallery of ``docs/every-stitch.md``: ``python -m studies.figures.stitches``."""

import io
from pathlib import Path

from PIL import Image

from app.context import Context
from app.drawing.design_view import ViewRequest, build_scene
from app.viewer.still import still_png
from knitcore import material, predict
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.machine.stitch_program import stitch_program
from knitcore.materials.yarn_per_stitch import mean_yarn
from studies.figures.curl import IMAGES, SIDE, save

ACRYLIC = material("acrylic")
ACROSS, HIGH = 12, 14
"""About as many columns and rows are drawn."""
GALLERY = {
    "feather and fan": r"PPPPPPPPPPP;KKKKKKKKKKK;//OKOKOKO\\",
    "2/2 cable": "PKKKKP;P[2/2R]P;PKKKKP;PKKKKP",
    "mosaic of slips": "KKKK;VKVK;KKKK;KVKV",
    "fisherman's rib": "Kt;TP",
    "eyelet mesh": r"KK;O/;KK;\O",
}


def main() -> None:
    """Write the picture, and print the table."""
    pictures = {}
    for name, text in GALLERY.items():
        repeat = SymbolChart.parse(text)
        cloth = repeat.tile(-(-HIGH // repeat.rows), -(-ACROSS // repeat.columns))
        pictures[name] = _drawn(cloth)
        size = predict(repeat, ACRYLIC)
        sizes = " × ".join(
            f"{along.relaxed_mm:.1f} ({low:.1f} to {high:.1f})"
            for along in (size.course, size.wale)
            for low, high in [along.relaxed_interval_mm]
        )
        yarn, _ = mean_yarn(repeat, ACRYLIC)
        transfers = stitch_program(cloth).transfers / cloth.cells.size
        print(f"| {name} | `{repeat.key}` | {sizes} | {yarn:.1f} | {transfers:.2f} |")
    save(pictures, IMAGES / "stitches.png", across=5)


def _drawn(chart: SymbolChart) -> Image.Image:
    request = ViewRequest(chart=chart.text, material=ACRYLIC.identifier)
    still = still_png(build_scene(request, None, Context(Path())), SIDE, SIDE)
    picture = Image.new("RGB", (SIDE, SIDE), "white")
    cloth = Image.open(io.BytesIO(still))
    picture.paste(cloth, mask=cloth.getchannel("A"))
    return picture


if __name__ == "__main__":
    main()
